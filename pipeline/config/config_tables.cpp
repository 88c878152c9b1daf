#include "pipeline/config/config_tables.hpp"

namespace selvedge::table {

Key unit_key() {
  return with_words(number("unit", Unit::length, positive, "m", "Length of one unit of the file."),
                    {"m", "dm", "cm", "mm", "in"});
}

std::vector<Key> placement_keys() {
  return {
      number(
          "scale", Unit::none, positive, "1",
          "Factor on all lengths, applied before rotation and translation. The rest shape of a cloth scales with it."),
      vector("rotate", Unit::angle, "[0, 0, 0]",
             "Rotation about the origin, applied after the scale: the direction is the axis, the length is the angle."),
      vector("translate", Unit::length, "[0, 0, 0]", "Displacement, applied last.")};
}

Key edge_key(const std::string& otherwise) {
  return number("edge", Unit::length, positive, otherwise, "Longest edge of the triangles, approximately.");
}

Key interpolation_key() {
  return word("interpolation", {"linear", "smooth"}, "linear",
              "Interpolation between keyframes. `smooth` is C1, does not overshoot, and has zero slope at the first "
              "and last keyframe.");
}

Key weld_key() {
  return flag(
      "weld", false,
      "Joins pieces of a mesh where their borders meet along an edge, vertex by vertex. Vertices that remain are "
      "renumbered in their order for results; what a scene lists by `vertices` keeps the numbers of the file. Where "
      "more than two triangles would meet in an edge, or pieces meet in a point, vertices stay apart, with a warning.");
}

Key weld_within_key() {
  return number("weld_within", Unit::length, positive, "",
                "Distance within which `weld` takes vertices for one. Default: a thousandth of the mean edge, or a "
                "millionth of the mesh's size where that is more.");
}

const Section& mesh_section() {
  static const Section table{"mesh",
                             "An OBJ or PLY file. The names of its `o` and `g` lines become vertex groups. The rest "
                             "of an `o` line is one name, and each word of a `g` line is one.",
                             {needed(path("file", "The OBJ or PLY file.")), unit_key(), weld_key(), weld_within_key()},
                             "file"};
  return table;
}

namespace {

const Section& keyframe_section() {
  static const Section table{
      "keyframe",
      "The pose at one time. A rotation may exceed 360 degrees.",
      {needed(number("time", Unit::time, any, "", "Time of the keyframe.")),
       vector("translate", Unit::length, "[0, 0, 0]", "Displacement from the initial placement."),
       vector("rotate", Unit::angle, "[0, 0, 0]",
              "Rotation about `center`: the direction is the axis, the length is the angle.")}};
  return table;
}

}  // namespace

const Section& motion_section() {
  static const Section table{
      "motion",
      "Rigid motion given by keyframes. The pose is held before the first and after the last keyframe.",
      {needed(sections("keyframes", keyframe_section(), "", "Poses at ascending times.")), interpolation_key(),
       vector("center", Unit::length, "",
              "Centre of rotation. Default: the middle of the bounding box of what moves.")}};
  return table;
}

}  // namespace selvedge::table
