#include "pipeline/host/bounds.hpp"
#include "pipeline/scene/config_scene.hpp"

// What a body of the scene wears, and how cloths start.
namespace selvedge {

using namespace table;

namespace table {

const Section& garment_section() {
  static const Section table{
      "garment",
      "A garment that a body of the scene wears. It is resized to the body's shape and starts where skinning puts it "
      "in the body's first pose. It has the placement and motion of the body and no placement of its own. Exactly one "
      "of file, cut and outfit defines it; a cut or an outfit needs the mannequin as body. An outfit gives one cloth "
      "for each of its garments, named after them.",
      {path("file",
            "Garment file (.h5) made by `selvedge dress` or `selvedge pattern`, or a mesh (.obj, .ply) where the body "
            "wears it in its zero pose, in the `shape` that the body is given, else in the mean one."),
       unit_key(), word("up", {"y", "z"}, "y", "Axis of a mesh that points up."), weld_key(), weld_within_key(),
       word("fit", {"loose", "tight"}, "loose", "How a mesh follows the body, as `--fit` of `selvedge dress`."),
       with_words(text("cut", "Name of a garment that the program makes (docs/garments.md)."), garment_names()),
       texts("over", "Cuts that are worn under the `cut`, from the body outward."),
       number("edge", Unit::length, positive, "",
              "Edge length of the `cut`, 2 cm by default, or of the garments of the `outfit`, those of its `form` by "
              "default."),
       text("outfit",
            "Name of an outfit. It is searched in `outfits.yaml` beside the scene, in the folder above, and in "
            "configs/outfits.yaml."),
       word("form", {"small", "full"}, "small",
            "Resolution of the outfit: `small` is for quick runs, `full` has all vertices."),
       word("layers", {"over", "alone"}, "over",
            "How garments of the outfit are made: `over` those under them, or as if worn `alone`. With `alone` they "
            "start intersecting."),
       text("on", "Name of the obstacle that wears the garment. Default: the only body."),
       flag("pins", true,
            "True: the garment's own pins move with the skin of the body, soft tissue included. False: the garment has "
            "no such pins.")},
      "file",
      {"file", "cut", "outfit"}};
  return table;
}

}  // namespace table

const Options<Draping>& start_options() {
  static const Options<Draping> table(
      "start",
      "How the initial state differs from the cloth as made and placed. The rest shape does not change. A cloth that "
      "starts collapsed to one point, where no force acts, is opened by small random displacements, with a warning.",
      {vector("stretch", Unit::none, "[1, 1, 1]",
              "Scale factors along x, y and z about the middle of the bounding box. 0 flattens the cloth."),
       number("crumple", Unit::length, not_negative, "0", "Largest random displacement of a vertex along each axis."),
       integer("seed", not_negative, "1", "Random seed of the displacements."),
       word("from", {"skinned", "draped", "cut"}, "skinned",
            "How garments start, the same for all of a scene. `skinned`: where the body's first pose puts them, "
            "possibly tangled. `draped`: free of intersections, after a simulation in which the body moves from the "
            "pose that they were made in. `cut`: skinned, but tangled triangles take no part until they are free."),
       number("seconds", &Draping::seconds, Unit::time, {.low = 0, .high = longest_lead, .low_in = false},
              "Time in which the body moves to its first pose, for `draped`."),
       number("hold", &Draping::hold, Unit::time, {.low = 0, .high = longest_lead},
              "Time for which the body then holds its first pose, until time 0, for `draped`."),
       flag("moving", true,
            "True: a garment starts with the velocity of the skinned body. False: it starts with the cloth's "
            "`velocity`.")});
  return table;
}

}  // namespace selvedge
