#include "pipeline/scene/config_scene.hpp"

// What a body of the scene wears, and how cloths start.
namespace selvedge {

using namespace table;

const Options<GarmentOptions>& garment_options() {
  static const Options<GarmentOptions> table(
      "garment",
      "A garment on a body of the scene: it is resized by the body's shape, starts where the body's first pose takes "
      "it, and goes with the body's placement and motion, in place of a placement of its own. Exactly one of file, cut "
      "and outfit says what it is; those by code are for the mannequin. An outfit is one cloth for each of its "
      "garments, named after them.",
      {path("file", "made by `selvedge dress` (.h5)"),
       with_words(text("cut", "a garment by code, see docs/garments.md"), garment_names()),
       texts("over", "of a `cut`: garments by code that are worn under it, from the body outward"),
       number("edge", &GarmentOptions::edge, Unit::length, positive, "of a `cut`: length of its edges"),
       text("outfit", "of `outfits.yaml` beside the scene or in the folder above it, else of configs/outfits.yaml"),
       word("form", {"small", "full"}, "small", "of the outfit: for quick runs, or with all its vertices"),
       word("layers", {"over", "alone"}, "over",
            "of an outfit: each garment made over those under it, or as if it were worn alone, so that they start in "
            "each other"),
       text("on", "name of the obstacle that wears it; left out: the only body"),
       flag("pins", true, "whether the garment's own pins stay with the body, skinned and giving way")},
      "file", {"file", "cut", "outfit"});
  return table;
}

const Options<Draping>& start_options() {
  static const Options<Draping> table(
      "start",
      "How the start differs from the cloth as made and placed; the rest shape does not follow. A cloth that starts in "
      "one point, where no force acts, is opened by small random displacements, and a warning says so.",
      {vector("stretch", Unit::none, "[1, 1, 1]", "factors along x, y and z about the middle of its box; 0 flattens"),
       number("crumple", Unit::length, not_negative, "0",
              "random displacement of every vertex, at most, along each axis"),
       integer("seed", not_negative, "1", "of what is random"),
       word(
           "from", {"skinned", "draped", "cut"}, "skinned",
           "of a garment: where the body's first pose takes it, maybe tangled; or grown clean before time 0, while the "
           "body comes from the pose that it was made in; or skinned, and what is tangled is cut out until it is free "
           "(all garments of a scene alike)"),
       number("seconds", &Draping::seconds, Unit::time, positive, "of a draped start: how long the body takes"),
       number("hold", &Draping::hold, Unit::time, not_negative, "and holds its first pose, until time 0"),
       flag("moving", true, "a garment starts as fast as the body takes it along; false: at rest")});
  return table;
}

}  // namespace selvedge
