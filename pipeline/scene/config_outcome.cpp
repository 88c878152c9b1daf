#include "pipeline/scene/config_scene.hpp"

// What a scene must come to.
namespace selvedge::table {

const Section& selection_section() {
  static const Section table{
      "selection",
      "Vertices of one cloth or of all. At most one of vertices, box and group is given; without them all vertices of "
      "the cloth are selected.",
      std::vector<Key>{text(
          "cloth",
          "Name of the cloth. Default: the only cloth, or all cloths if none of vertices, box and group is given.")} +
          selection_keys(),
      "cloth"};
  return table;
}

namespace {

Key selected(std::string name, std::string about) {
  return renamed(section(selection_section(), "", std::move(about)), std::move(name));
}

const Section& outside_section() {
  static const Section table{"outside",
                             "The largest distance of a vertex from a box that should contain it [m].",
                             {selected("of", "Vertices that are measured. Default: all."),
                              vector("min", Unit::length, "[-1e6, -1e6, -1e6]", "Lowest corner."),
                              vector("max", Unit::length, "[1e6, 1e6, 1e6]", "Highest corner.")}};
  return table;
}

const Section& turns_section() {
  static const Section table{
      "turns",
      "Number of turns of vertices about their middle since the start, followed from frame to frame.",
      {selected("of", "Vertices that are measured. Default: all."),
       selected("against", "Vertices whose turns are subtracted. Default: none."),
       vector("axis", Unit::none, "[0, 1, 0]", "Axis about which turns count as positive.")}};
  return table;
}

const Section& distance_section() {
  static const Section table{
      "distance",
      "The distance from the middle of some vertices to the middle of others [m].",
      {needed(renamed(section(selection_section(), "", "The first vertices."), "from")),
       needed(renamed(section(selection_section(), "", "The other vertices."), "to")),
       vector("along", Unit::none, "",
              "Direction along which the distance is measured, with its sign. Default: the full distance.")}};
  return table;
}

const Section& disorder_section() {
  static const Section table{
      "disorder",
      "Number of vertices that lie below the cloth that comes before theirs in the scene, seen along `up`. The upper "
      "side of a vertex's cloth must face the lower side of that cloth, where the upper side is the one that most of a "
      "cloth has above. Cloth that is folded round an edge of the other does not count.",
      {vector("up", Unit::none, "[0, 1, 0]", "Direction from the first cloth to the last.")}};
  return table;
}

const Section& ahead_section() {
  static const Section table{
      "ahead",
      "How far the foremost vertex near an axis through an obstacle's middle is ahead of the obstacle's foremost point "
      "[m]. It is minus infinity where no vertex is near. Cloth that the obstacle has passed through is no longer "
      "ahead of it.",
      {needed(text("obstacle", "Name of the obstacle.")),
       needed(
           vector("direction", Unit::none, "", "Direction of the axis. The foremost point is the farthest along it.")),
       number("radius", Unit::length, positive, "0.02", "Distance from the axis within which a vertex is near."),
       selected("of", "Vertices that are measured. Default: all.")}};
  return table;
}

const Section& drift_section() {
  static const Section table{"drift",
                             "The largest distance of a vertex from its position in the first frame that counts [m].",
                             {selected("of", "Vertices that are measured. Default: all.")}};
  return table;
}

const Section& stretch_section() {
  static const Section table{"stretch", "The largest principal stretch of the cloth."};
  return table;
}

const Section& lag_section() {
  static const Section table{"lag",
                             "The largest distance of an obstacle's vertex from its prescribed position [m]. Obstacles "
                             "lag where they yield to cloth.",
                             {text("obstacle", "Name of the obstacle. Default: all obstacles.")},
                             "obstacle"};
  return table;
}

const Section& wanted_pairs_section() {
  static const Section table{"wanted_pairs",
                             "Number of triangle pairs of cloth and obstacle that would intersect, and of vertices "
                             "that would be inside, if the obstacles were at their prescribed positions."};
  return table;
}

}  // namespace

const Section& outcome_section() {
  static const Section table{
      "outcome",
      "A condition that the run must meet: a measure, which gives one number for each frame, and the range of that "
      "number. Without `least` and `most` the number must be at most 0.",
      {needed(text("name", "Description of the condition, for readers.")),
       number("from", Unit::time, not_negative, "",
              "First time that counts. Without `from` and `until` only the end counts."),
       number("until", Unit::time, not_negative, "", "Last time that counts. Default: the end."),
       word("hold", {"always", "once"}, "always",
            "Whether the number must lie in its range in all frames that count, or in one."),
       number("least", Unit::none, any, "", "Smallest value that is allowed, in SI units."),
       number("most", Unit::none, any, "", "Largest value that is allowed, in SI units."),
       section(outside_section(), "", "Distance from a box."), section(turns_section(), "", "Turns of vertices."),
       section(distance_section(), "", "Distance between vertices."),
       section(disorder_section(), "", "Vertices of layers in the wrong order."),
       section(ahead_section(), "", "Lead of cloth over an obstacle."),
       section(drift_section(), "", "Displacement of vertices."),
       section(stretch_section(), "", "Stretch of the cloth."), section(lag_section(), "", "Lag of obstacles."),
       section(wanted_pairs_section(), "", "Intersections with the obstacles where prescribed.")},
      "",
      {"outside", "turns", "distance", "disorder", "ahead", "drift", "stretch", "lag", "wanted_pairs"}};
  return table;
}

}  // namespace selvedge::table
