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
             "how it is cut"),
      integer("seed", &SheetOptions::seed, not_negative, "of the unstructured triangulation")};
  return rows;
}

const Options<TshirtShape>& tshirt_options() {
  using O = TshirtShape;
  static const Options<O> table(
      "tshirt",
      "A front and a back joined at the sides, the shoulders and along the sleeves; upright, front to +z, centred at "
      "the origin. Groups: hem, neck, cuffs, seams, front, back.",
      {number("width", &O::width, Unit::length, positive, "of the body"),
       number("length", &O::length, Unit::length, positive, "of the body"),
       number("sleeve_length", &O::sleeve_length, Unit::length, positive, "beyond the body"),
       number("sleeve_width", &O::sleeve_width, Unit::length, positive, ""),
       number("neck", &O::neck, Unit::length, positive, "width of the opening"),
       number("depth", &O::depth, Unit::length, positive, "from front to back, away from the seams"),
       bound(&O::edge, edge_key({}))});
  return table;
}

namespace table {
namespace {

const Section& rectangle_section() {
  static const Section table{
      "rectangle",
      "Horizontal, normal up, centred at the origin. Groups: left, right, top (-z), bottom, boundary, center, "
      "top_left, top_right, bottom_left, bottom_right.",
      "",
      {},
      std::vector<Key>{pair("size", Unit::length, "[1, 1]", "along x and z"),
                       integers("resolution", {.low = 2}, 2, "vertices along x and z; in place of `edge`"),
                       edge_key("0.02"),
                       pair("grading", Unit::none, "[1, 1]",
                            "last over first spacing of the vertices along x and z, in geometric steps")} +
          keys_of(sheet_options())};
  return table;
}

const Section& disc_section() {
  static const Section table{
      "disc",
      "Horizontal, normal up, centred at the origin. Groups: boundary, center.",
      "",
      {},
      std::vector<Key>{number("radius", Unit::length, positive, "0.5", ""),
                       integers("resolution", {.low = 1}, 1, "rings of vertices round the centre; in place of `edge`"),
                       edge_key("0.02")} +
          keys_of(sheet_options())};
  return table;
}

const Section& tube_section() {
  static const Section table{
      "tube",
      "Round the y axis, centred at the origin, normals outward. Groups: top, bottom, boundary.",
      "",
      {},
      std::vector<Key>{
          number("radius", Unit::length, positive, "0.2", ""), number("height", Unit::length, positive, "1", "along y"),
          integers("resolution", {.low = 2}, 2, "vertices round (at least 6) and along; in place of `edge`"),
          edge_key("0.02")} +
          keys_of(sheet_options())};
  return table;
}

const Section& line_point_section() {
  static const Section table{
      "line_point",
      "",
      "at",
      {},
      {needed(vector("at", Unit::length, "", "where the middle of the ribbon is")),
       vector("normal", Unit::none, "", "way the ribbon faces here; left out: the ribbon's `normal`")}};
  return table;
}

const Section& ribbon_section() {
  static const Section table{
      "ribbon",
      "A straight strip of cloth laid along a smooth line through points (centripetal Catmull-Rom). Its pattern is "
      "flat, so a ribbon that is laid round a bend without room starts strained. Groups: start, end, middle, boundary.",
      "",
      {},
      std::vector<Key>{needed(sections("line", line_point_section(), "", "at least two points, [x, y, z] each")),
                       number("width", Unit::length, positive, "0.03", ""),
                       vector("normal", Unit::none, "[0, 1, 0]", "way the ribbon faces"),
                       integers("resolution", {.low = 2}, 2, "vertices along and across; in place of `edge`"),
                       edge_key("0.005")} +
          keys_of(sheet_options())};
  return table;
}

}  // namespace

std::vector<Key> sheet_keys() {
  return {section(rectangle_section(), "", "a sheet"), section(disc_section(), "", "a round sheet"),
          section(tube_section(), "", "a sleeve"), section(ribbon_section(), "", "a strip along a line"),
          section(tshirt_options().section, "", "a garment")};
}

}  // namespace table
}  // namespace selvedge
