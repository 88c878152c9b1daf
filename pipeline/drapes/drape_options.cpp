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
      {text("description", "for people"),
       text("name", &O::name, "of the set; left out: the file's"),
       text("garment", &O::garment, "by code"),
       number("edge", &O::edge, Unit::length, positive, "of the garment's triangles"),
       integer("seed", &O::seed, not_negative, "of poses, shapes and styles"),
       integer("poses", &O::poses, at_least_one, "of a path, each drape from the last one"),
       integer("training", &O::training, at_least_one, "paths to train on, a shape and a style each"),
       integer("test", &O::test, at_least_one, "paths to measure on: other poses, shapes and styles"),
       texts("clips", &O::clips,
             "procedural ones to take poses from in place of drawn ones; `training` is then `shapes` times as many"),
       texts("test_clips", &O::test_clips, "to measure on, of the same bodies"),
       integer("shapes", &O::shapes, at_least_one, "bodies that go through each clip"),
       number("pose_range", &O::pose_range, Unit::none, not_negative, "times the ranges of the joints' angles"),
       number("shape_spread", &O::shape_spread, Unit::none, not_negative, "standard deviation of its coefficients"),
       number("style_spread", &O::style_spread, Unit::none, not_negative,
              "times the ranges of width, length, sleeve and neck"),
       number("fps", &O::fps, Unit::none, positive, "of the simulation"),
       integer("move_frames", &O::move_frames, at_least_one, "from pose to pose"),
       integer("settle_frames", &O::settle_frames, not_negative, "before a drape is looked at"),
       integer("most_settle_frames", &O::most_settle_frames, at_least_one, "before it counts as not at rest"),
       number("rest_speed", &O::rest_speed, Unit::none, positive,
              "of the fastest hundredth of the vertices, below which it is at rest [m/s]"),
       number("friction", &O::friction, Unit::none, not_negative, "with the body"),
       number("damping", &O::damping, Unit::none, not_negative, "of the mass [1/s]"),
       number("thickness", &O::thickness, Unit::length, positive, "that cloth keeps from the body")});
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
    throw Error("has clips to train on or to measure on, and not both", file.string() + ": clips",
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
