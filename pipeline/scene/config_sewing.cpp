#include "pipeline/scene/config_scene.hpp"

// What joins vertices of cloths: seams within one, springs between any.
namespace selvedge {
namespace table {
namespace {

Key pair_key() {
  return word("pair", {"listed", "nearest"}, "listed",
              "`listed` pairs vertices in order, with the same number on both sides. `nearest` pairs each vertex of "
              "`from` with the nearest of `to` at the start.");
}

const Section& seam_side_section() {
  static const Section table{
      "seam_side",
      "Vertices of the cloth in the order in which they are listed. Those of a box or a group are ordered by index.",
      selection_keys(),
      "",
      {"vertices", "box", "group"}};
  return table;
}

}  // namespace

const Section& seam_section() {
  static const Section table{
      "seam",
      "Vertices of the cloth that are sewn together in pairs. Each pair becomes one vertex, and pairs with a common "
      "vertex become one vertex together. Triangles keep the rest shape that they have on their panels.",
      {renamed(section(seam_side_section(), "", "One side of the seam."), "from"),
       renamed(section(seam_side_section(), "", "The other side of the seam."), "to"), pair_key(),
       path("file", "Text file with one pair of vertex indices, from 0, on each line. It replaces `from` and `to`.")},
      "",
      {"from", "file"}};
  return table;
}

}  // namespace table

const Options<Spring>& spring_options() {
  using namespace table;
  static const Options<Spring> table(
      "spring",
      "Buttons and stitches: springs that join vertices of cloths in pairs. Vertices are taken in the order in which "
      "they are listed. Those of a box, a group or a whole cloth are ordered by index.",
      {needed(renamed(section(selection_section(), "", "Vertices at one end of the springs."), "from")),
       needed(renamed(section(selection_section(), "", "Vertices at the other end."), "to")), pair_key(),
       number("rest_length", Unit::length, range_of(&Spring::rest_length), "",
              "Rest length. Default: `contact.thickness` for listed pairs, the initial distance for nearest ones."),
       number("stiffness", &Spring::stiffness, Unit::stiffness, range_of(&Spring::stiffness),
              "Stiffness of each spring, by default ten times that of cotton. A load of 2 N, as of a shirt on one "
              "button, then stretches it by 0.2 mm.")});
  return table;
}

}  // namespace selvedge
