#include "pipeline/scene/config_scene.hpp"

// The cloths that the program makes itself.
namespace selvedge {

using namespace table;

const OptionRows<SheetOptions>& sheet_options() {
  static const OptionRows<SheetOptions> rows{
      choice("triangulation", &SheetOptions::triangulation,
             {{"one_diagonal", Triangulation::one_diagonal},
              {"alternating", Triangulation::alternating},
              {"unstructured", Triangulation::unstructured}},
             "How the cloth is divided into triangles. `unstructured` has no preferred directions."),
      integer("seed", &SheetOptions::seed, not_negative, "Random seed of the triangulation `unstructured`.")};
  return rows;
}

const Options<TshirtShape>& tshirt_options() {
  using O = TshirtShape;
  static const Options<O> table(
      "tshirt",
      "A front and a back, joined at the sides, the shoulders and along the sleeves. It stands upright, centred at the "
      "origin, with its front towards +z. Groups: hem, neck, cuffs, seams, front, back.",
      {number("width", &O::width, Unit::length, positive, "Width of the body."),
       number("length", &O::length, Unit::length, positive, "Length of the body."),
       number("sleeve_length", &O::sleeve_length, Unit::length, positive, "Length of a sleeve beyond the body."),
       number("sleeve_width", &O::sleeve_width, Unit::length, positive, "Width of a sleeve."),
       number("neck", &O::neck, Unit::length, positive, "Width of the neck opening."),
       number("depth", &O::depth, Unit::length, positive, "Distance from front to back, away from the seams."),
       bound(&O::edge, edge_key({}))});
  return table;
}

namespace table {
namespace {

const Section& rectangle_section() {
  static const Section table{
      "rectangle",
      "A rectangular sheet: horizontal, normal up, centred at the origin. Groups: left, right, top (-z), bottom, "
      "boundary, center, top_left, top_right, bottom_left, bottom_right.",
      std::vector<Key>{pair("size", Unit::length, "[1, 1]", "Lengths along x and z."),
                       integers("resolution", {.low = 2}, 2, "Number of vertices along x and z, in place of `edge`."),
                       edge_key("0.02"),
                       pair("grading", Unit::none, "[1, 1]",
                            "Ratio of the last to the first vertex spacing along x and z. Spacings grow geometrically; "
                            "not for `unstructured`.")} +
          keys_of(sheet_options())};
  return table;
}

const Section& disc_section() {
  static const Section table{
      "disc", "A round sheet: horizontal, normal up, centred at the origin. Groups: boundary, center.",
      std::vector<Key>{
          number("radius", Unit::length, positive, "0.5", "Radius of the disc."),
          integers("resolution", {.low = 1}, 1, "Number of vertex rings round the centre, in place of `edge`."),
          edge_key("0.02")} +
          keys_of(sheet_options())};
  return table;
}

const Section& tube_section() {
  static const Section table{
      "tube",
      "An open cylinder about the y axis, centred at the origin, normals outward. Groups: top, bottom, boundary.",
      std::vector<Key>{number("radius", Unit::length, positive, "0.2", "Radius of the tube."),
                       number("height", Unit::length, positive, "1", "Length along y."),
                       integers("resolution", {.low = 2}, 2,
                                "Number of vertices round (at least 6) and along the tube, in place of `edge`."),
                       edge_key("0.02")} +
          keys_of(sheet_options())};
  return table;
}

const Section& line_point_section() {
  static const Section table{"line_point",
                             "A point of a ribbon's centre line.",
                             {needed(vector("at", Unit::length, "", "Position of the middle of the ribbon.")),
                              vector("normal", Unit::none, "",
                                     "Direction that the ribbon faces at this point. Default: the ribbon's `normal`.")},
                             "at"};
  return table;
}

const Section& ribbon_section() {
  static const Section table{
      "ribbon",
      "A straight strip of cloth, laid along a smooth curve through points (centripetal Catmull-Rom). Its rest shape "
      "is flat, so it starts strained where it cannot follow the curve without stretching. Groups: start, end, middle, "
      "boundary.",
      std::vector<Key>{
          needed(
              sections("line", line_point_section(), "", "Points of the centre line, at least two, each [x, y, z].")),
          number("width", Unit::length, positive, "0.03", "Width of the ribbon."),
          vector("normal", Unit::none, "[0, 1, 0]", "Direction that the ribbon faces."),
          integers("resolution", {.low = 2}, 2, "Number of vertices along and across the ribbon, in place of `edge`."),
          edge_key("0.005")} +
          keys_of(sheet_options())};
  return table;
}

}  // namespace

std::vector<Key> sheet_keys() {
  return {section(rectangle_section(), "", "A rectangular sheet."), section(disc_section(), "", "A round sheet."),
          section(tube_section(), "", "A cylinder with open ends."),
          section(ribbon_section(), "", "A strip along a curve."), section(tshirt_options().section, "", "A T-shirt.")};
}

}  // namespace table
}  // namespace selvedge
