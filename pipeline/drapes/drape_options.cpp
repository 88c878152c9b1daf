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
      "drapes", "Drapes at rest of one garment on the mannequin.",
      {text("description", "Free text for readers."),
       text("name", &O::name, "Name of the set. Default: that of the file."),
       text("garment", &O::garment, "Name of a garment that the program makes (docs/garments.md)."),
       number("edge", &O::edge, Unit::length, positive, "Edge length of the garment's triangles."),
       integer("seed", &O::seed, not_negative, "Random seed of poses, shapes and styles."),
       integer("poses", &O::poses, at_least_one, "Number of poses in a path. Each drape starts from the one before."),
       integer("training", &O::training, at_least_one, "Number of training paths. Each has one shape and one style."),
       integer("test", &O::test, at_least_one, "Number of test paths, with other poses, shapes and styles."),
       texts("clips", &O::clips,
             "Procedural clips that give the poses of training paths, in place of random ones. `training` is then "
             "`shapes` times their number."),
       texts("test_clips", &O::test_clips, "Clips of the test paths, for the same bodies."),
       integer("shapes", &O::shapes, at_least_one,
               "Number of bodies that go through each clip. Each body in each clip is a path."),
       number("pose_range", &O::pose_range, Unit::none, not_negative, "Factor on the ranges of the joints' angles."),
       number("shape_spread", &O::shape_spread, Unit::none, not_negative,
              "Standard deviation of the shape's coefficients."),
       number("style_spread", &O::style_spread, Unit::none, not_negative,
              "Factor on the ranges of width, length, sleeve and neck. 0: all garments are alike."),
       number("fps", &O::fps, Unit::none, positive, "Frames a second of the simulation."),
       integer("move_frames", &O::move_frames, at_least_one,
               "Number of frames in which the body moves from pose to pose."),
       integer("settle_frames", &O::settle_frames, not_negative,
               "Smallest number of frames after the motion before a drape is taken."),
       integer("most_settle_frames", &O::most_settle_frames, at_least_one,
               "Largest number of frames after the motion. A drape that is not at rest then is dropped."),
       number("rest_speed", &O::rest_speed, Unit::none, positive,
              "The cloth rests if all vertices but the fastest hundredth are slower than this [m/s]."),
       number("friction", &O::friction, Unit::none, not_negative,
              "Friction coefficient of cloth on the body. If it is small, a drape depends little on its path."),
       number("damping", &O::damping, Unit::none, not_negative, "Rayleigh coefficient of damping by mass [1/s]."),
       number("thickness", &O::thickness, Unit::length, positive, "Distance that cloth keeps from the body.")});
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
