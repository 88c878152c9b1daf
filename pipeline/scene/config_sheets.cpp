#include "pipeline/config/config_tables.hpp"
#include "pipeline/shapes/generate.hpp"

// The cloths that the program makes itself.
namespace selvedge::table {
namespace {

std::vector<Key> triangulation_keys() {
  return {word("triangulation", {"one_diagonal", "alternating", "unstructured"}, "alternating", "how it is cut"),
          integer("seed", not_negative, "1", "of the unstructured triangulation")};
}

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
          triangulation_keys()};
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
          triangulation_keys()};
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
          triangulation_keys()};
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
          triangulation_keys()};
  return table;
}

const Section& tshirt_section() {
  const TshirtShape shape;
  static const Section table{
      "tshirt",
      "A front and a back joined at the sides, the shoulders and along the sleeves; upright, front to +z, centred at "
      "the origin. Groups: hem, neck, cuffs, seams, front, back.",
      "",
      {},
      {number("width", Unit::length, positive, show(shape.width), "of the body"),
       number("length", Unit::length, positive, show(shape.length), "of the body"),
       number("sleeve_length", Unit::length, positive, show(shape.sleeve_length), "beyond the body"),
       number("sleeve_width", Unit::length, positive, show(shape.sleeve_width), ""),
       number("neck", Unit::length, positive, show(shape.neck), "width of the opening"),
       number("depth", Unit::length, positive, show(shape.depth), "from front to back, away from the seams"),
       edge_key(show(shape.edge))}};
  return table;
}

}  // namespace

std::vector<Key> sheet_keys() {
  return {section(rectangle_section(), "", "a sheet"), section(disc_section(), "", "a round sheet"),
          section(tube_section(), "", "a sleeve"), section(ribbon_section(), "", "a strip along a line"),
          section(tshirt_section(), "", "a garment")};
}

}  // namespace selvedge::table
