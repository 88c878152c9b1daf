#include "pipeline/scene/config_scene.hpp"

// What a scene must come to.
namespace selvedge::table {

const Section& selection_section() {
  static const Section table{
      "selection",
      "Vertices of a cloth, or of all; at most one of vertices, box and group, and all of the cloth without them.",
      "cloth",
      {},
      std::vector<Key>{
          text("cloth", "its name; left out: the only cloth or, with `vertices` and the like left out, all")} +
          selection_keys()};
  return table;
}

namespace {

Key selected(std::string name, std::string about) {
  return renamed(section(selection_section(), "", std::move(about)), std::move(name));
}

const Section& outside_section() {
  static const Section table{
      "outside",
      "The farthest that a vertex lies outside a box of space [m].",
      "",
      {},
      {selected("of", "left out: everything"), vector("min", Unit::length, "[-1e6, -1e6, -1e6]", "lowest corner"),
       vector("max", Unit::length, "[1e6, 1e6, 1e6]", "highest corner")}};
  return table;
}

const Section& turns_section() {
  static const Section table{
      "turns",
      "Turns since the start of vertices about their middle, followed from frame to frame.",
      "",
      {},
      {selected("of", "left out: everything"), selected("against", "whose turns are subtracted; left out: nothing"),
       vector("axis", Unit::none, "[0, 1, 0]", "of the turns that count as positive")}};
  return table;
}

const Section& distance_section() {
  static const Section table{
      "distance",
      "From the middle of some vertices to the middle of others [m].",
      "",
      {},
      {needed(renamed(section(selection_section(), "", ""), "from")),
       needed(renamed(section(selection_section(), "", ""), "to")),
       vector("along", Unit::none, "", "direction in which it is measured, with its sign; left out: the distance")}};
  return table;
}

const Section& disorder_section() {
  static const Section table{
      "disorder",
      "How many vertices lie below the cloth that comes before theirs in the scene: with the side that most of their "
      "cloth has above they look, along `up`, at the side that most of that one has below. What is folded round the "
      "other's edge does not count.",
      "",
      {},
      {vector("up", Unit::none, "[0, 1, 0]", "from the first cloth to the last")}};
  return table;
}

const Section& ahead_section() {
  static const Section table{
      "ahead",
      "How far the foremost vertex near the axis through an obstacle's middle is ahead of the obstacle's foremost "
      "point [m]; minus infinity where no vertex is near. Cloth that the obstacle has passed through is no longer "
      "ahead of it.",
      "",
      {},
      {needed(text("obstacle", "its name")), needed(vector("direction", Unit::none, "", "in which it is foremost")),
       number("radius", Unit::length, positive, "0.02", "from the axis, of what is near"),
       selected("of", "left out: everything")}};
  return table;
}

const Section& drift_section() {
  static const Section table{"drift",
                             "The farthest that a vertex is from where it was in the first frame that counts [m].",
                             "",
                             {},
                             {selected("of", "left out: everything")}};
  return table;
}

const Section& stretch_section() {
  static const Section table{"stretch", "The largest principal stretch of the cloth.", "", {}, {}};
  return table;
}

const Section& lag_section() {
  static const Section table{"lag",
                             "The largest distance of an obstacle's vertex from where it was wanted [m].",
                             "obstacle",
                             {},
                             {text("obstacle", "its name; left out: any")}};
  return table;
}

const Section& wanted_pairs_section() {
  static const Section table{"wanted_pairs",
                             "Pairs of triangles of cloth and obstacle that would intersect, and vertices that would "
                             "be inside, if the obstacles were where they are wanted.",
                             "",
                             {},
                             {}};
  return table;
}

}  // namespace

const Section& outcome_section() {
  static const Section table{
      "outcome",
      "One thing that must come true: a measure, one number a frame, and the range where it must lie. Of `least` and "
      "`most` one at least is given, or the number must be at most 0.",
      "",
      {"outside", "turns", "distance", "disorder", "ahead", "drift", "stretch", "lag", "wanted_pairs"},
      {needed(text("name", "what comes true, for people")),
       number("from", Unit::time, not_negative, "", "first time that counts; left out with `until`: the end alone"),
       number("until", Unit::time, not_negative, "", "last time that counts; left out: the end"),
       word("hold", {"always", "once"}, "always", "in all frames that count, or in one"),
       number("least", Unit::none, any, "", "in SI units"), number("most", Unit::none, any, "", "in SI units"),
       section(outside_section(), "", ""), section(turns_section(), "", ""), section(distance_section(), "", ""),
       section(disorder_section(), "", ""), section(ahead_section(), "", ""), section(drift_section(), "", ""),
       section(stretch_section(), "", ""), section(lag_section(), "", ""), section(wanted_pairs_section(), "", "")}};
  return table;
}

}  // namespace selvedge::table
