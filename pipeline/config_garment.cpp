#include "pipeline/config_tables.hpp"

// What a body of the scene wears, and how cloths start.
namespace selvedge::table {

const Section& garment_section() {
  static const Section table{"garment",
                             "A garment on a body of the scene: it is resized by the body's shape, starts where the "
                             "body's first pose takes it, "
                             "and goes with the body's placement and motion, in place of a placement of its own.",
                             "file",
                             {"file"},
                             {path("file", "made by `selvedge dress` (.h5)"),
                              text("on", "name of the obstacle that wears it; left out: the only body"),
                              flag("pins", true, "whether the garment's own pins stay with the body, as skinned")}};
  return table;
}

const Section& start_section() {
  static const Section table{
      "start",
      "How the start differs from the cloth as made and placed; the rest shape does not follow. A cloth that starts in "
      "one point, where no force acts, is opened by small random displacements, and a warning says so.",
      "",
      {},
      {vector("stretch", Unit::none, "[1, 1, 1]", "factors along x, y and z about the middle of its box; 0 flattens"),
       number("crumple", Unit::length, not_negative, "0",
              "random displacement of every vertex, at most, along each axis"),
       integer("seed", not_negative, "1", "of what is random"),
       flag("moving", true, "a garment starts as fast as the body takes it along; false: at rest")}};
  return table;
}

}  // namespace selvedge::table
