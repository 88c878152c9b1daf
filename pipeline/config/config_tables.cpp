#include "pipeline/config/config_tables.hpp"

namespace selvedge::table {

Key unit_key() {
  return with_words(number("unit", Unit::length, positive, "m", "length of one unit of the file"),
                    {"m", "dm", "cm", "mm"});
}

std::vector<Key> placement_keys() {
  return {number("scale", Unit::none, positive, "1", "factor on all lengths, applied first; the rest shape scales too"),
          vector("rotate", Unit::angle, "[0, 0, 0]", "then turned about the origin: axis times angle"),
          vector("translate", Unit::length, "[0, 0, 0]", "then moved")};
}

Key edge_key(const std::string& otherwise) {
  return number("edge", Unit::length, positive, otherwise, "longest edge of the triangles, about");
}

Key interpolation_key() {
  return word("interpolation", {"linear", "smooth"}, "linear",
              "from key to key; `smooth` is C1, does not overshoot and rests at the first and last key");
}

const Section& mesh_section() {
  static const Section table{
      "mesh",
      "An OBJ or PLY file. The names of its `o` and `g` lines are groups.",
      "file",
      {},
      {needed(path("file", "")), unit_key(),
       flag("weld", false,
            "joins vertices that lie at one place, within a millionth of the mesh's size; they are numbered anew in "
            "their order")}};
  return table;
}

namespace {

const Section& keyframe_section() {
  static const Section table{"keyframe",
                             "A pose at a time. The turn may exceed 360 degrees.",
                             "",
                             {},
                             {needed(number("time", Unit::time, any, "", "when")),
                              vector("translate", Unit::length, "[0, 0, 0]", "displacement from where it was placed"),
                              vector("rotate", Unit::angle, "[0, 0, 0]", "turn about `center`: axis times angle")}};
  return table;
}

}  // namespace

const Section& motion_section() {
  static const Section table{
      "motion",
      "Rigid motion by keyframes; held before the first and after the last.",
      "",
      {},
      {needed(sections("keyframes", keyframe_section(), "", "at ascending times")), interpolation_key(),
       vector("center", Unit::length, "", "of rotation; left out: the middle of the bounding box of what moves")}};
  return table;
}

}  // namespace selvedge::table
