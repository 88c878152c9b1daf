#include "pipeline/drapes/drape_options.hpp"

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/motions/clip_procedural.hpp"

namespace selvedge {

using namespace table;

const Options<DrapeOptions>& drape_options() {
  using O = DrapeOptions;
  static const Options<O> table(
      "drapes", "A set of drapes at rest.",
      {text("description", "a note for people; the program ignores it"),
       text("name", &O::name, "name of the set; left out: that of the file"),
       text("garment", &O::garment, "name of a garment by code"),
       number("edge", &O::edge, Unit::length, positive, "edge length of the garment's triangles"),
       integer("seed", &O::seed, not_negative, "seed of poses, shapes and styles"),
       integer("poses", &O::poses, at_least_one, "poses of a path; each drape starts from the last one"),
       integer("training", &O::training, at_least_one, "number of training paths; each has one shape and one style"),
       integer("test", &O::test, at_least_one, "number of test paths, with other poses, shapes and styles"),
       texts("clips", &O::clips,
             "procedural clips that give the poses, instead of random ones; `training` is then `shapes` times their "
             "number"),
       texts("test_clips", &O::test_clips, "clips of the test paths, for the same bodies"),
       integer("shapes", &O::shapes, at_least_one, "number of bodies that go through each clip"),
       number("pose_range", &O::pose_range, Unit::none, not_negative, "factor on the ranges of the joints' angles"),
       number("shape_spread", &O::shape_spread, Unit::none, not_negative,
              "standard deviation of the shape's coefficients"),
       number("style_spread", &O::style_spread, Unit::none, not_negative,
              "factor on the ranges of width, length, sleeve and neck"),
       number("fps", &O::fps, Unit::none, positive, "frames a second of the simulation"),
       integer("move_frames", &O::move_frames, at_least_one, "frames of the motion from pose to pose"),
       integer("settle_frames", &O::settle_frames, not_negative,
               "least frames after the motion before a drape is taken"),
       integer("most_settle_frames", &O::most_settle_frames, at_least_one,
               "most frames after the motion; a drape that is not at rest then is dropped"),
       number("rest_speed", &O::rest_speed, Unit::none, positive,
              "the cloth rests if its fastest hundredth of the vertices is slower [m/s]"),
       number("friction", &O::friction, Unit::none, not_negative, "friction with the body"),
       number("damping", &O::damping, Unit::none, not_negative, "damping by mass [1/s]"),
       number("thickness", &O::thickness, Unit::length, positive, "distance that cloth keeps from the body")});
  return table;
}

DrapeOptions read_drape_options(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  DrapeOptions options = drape_options().read(read_config(file, drape_options().section, overrides));
  if (options.name.empty()) options.name = file.stem().string();
  const std::vector<std::string> known = garment_names();
  if (std::ranges::find(known, options.garment) == known.end())
    throw Error("`" + options.garment + "` is no garment by code", file.string() + ": garment",
                "one of " + joined(known) + suggestion(options.garment, known));
  const std::vector<std::string> clips = procedural_clip_names();
  for (const auto* list : {&options.clips, &options.test_clips})
    for (const std::string& name : *list)
      if (std::ranges::find(clips, name) == clips.end())
        throw Error("`" + name + "` is no procedural clip", file.string() + ": clips",
                    "one of " + joined(clips) + suggestion(name, clips));
  if (options.clips.empty() != options.test_clips.empty())
    throw Error("names training clips or test clips, but not both", file.string() + ": clips",
                "give `clips` and `test_clips`, or neither");
  if (!options.clips.empty()) {
    options.training = options.shapes * static_cast<int>(options.clips.size());
    options.test = options.shapes * static_cast<int>(options.test_clips.size());
  }
  return options;
}

std::string drape_reference() { return section_chapter(drape_options().section); }

std::string drape_yaml(const DrapeOptions& options) { return to_yaml(drape_options().written(options)); }

}  // namespace selvedge
