#include "pipeline/scene/config_scene.hpp"

// What joins vertices of cloths: seams within one, springs between any.
namespace selvedge {
namespace table {
namespace {

Key pair_key() {
  return word("pair", {"listed", "nearest"}, "listed",
              "`listed`: the first with the first and so on, as many on both sides; `nearest`: each of `from` with the "
              "nearest of `to` at the start");
}

const Section& seam_side_section() {
  static const Section table{
      "seam_side",
      "Vertices of the cloth, in the order in which they are listed; those of a box or a group by "
      "ascending index.",
      "",
      {"vertices", "box", "group"},
      selection_keys()};
  return table;
}

}  // namespace

const Section& seam_section() {
  static const Section table{
      "seam",
      "Vertices of the cloth that are sewn together in pairs: each pair becomes one vertex, where several meet all of "
      "them become one. Triangles keep the rest shape that they have on their panels.",
      "",
      {"from", "file"},
      {renamed(section(seam_side_section(), "", "one side of the seam"), "from"),
       renamed(section(seam_side_section(), "", "the other side"), "to"), pair_key(),
       path("file", "a text file with a pair of indices, from 0, a line; in place of `from` and `to`")}};
  return table;
}

}  // namespace table

const Options<Spring>& spring_options() {
  using namespace table;
  static const Options<Spring> table(
      "spring",
      "Buttons and stitches: vertices of cloths, in pairs, that springs join. The order of vertices is that in which "
      "they are listed; those of a box, a group or a whole cloth by ascending index.",
      {needed(renamed(section(selection_section(), "", ""), "from")),
       needed(renamed(section(selection_section(), "", ""), "to")), pair_key(),
       number("rest_length", Unit::length, not_negative, "",
              "left out: `contact.thickness` for listed pairs, their distance at the start for nearest ones"),
       number("stiffness", &Spring::stiffness, Unit::stiffness, positive,
              "of each; by default the 2 N of a shirt on one button stretch it by 0.2 mm, and cotton is ten times as "
              "soft")});
  return table;
}

}  // namespace selvedge
