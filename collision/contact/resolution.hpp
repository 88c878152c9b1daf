#pragma once

#include <deque>

#include "collision/contact/path_pairs.hpp"
#include "collision/contact/resolve_options.hpp"
#include "collision/contact/response.hpp"
#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/stopwatch.hpp"

namespace selvedge {

// The state of one resolve call.
struct Resolution {
  PairSearch& search;
  const ContactWorld& world;
  Eigen::VectorXd inverse_mass;  // obstacle nodes that give way get one too
  const ResolveOptions& options;
  const Points& x0;
  Points& x1;
  PathPairs& path;
  ResolveReport report;
  Stopwatch watch;
  std::vector<char> moved;     // nodes whose path changed since their pairs were tested
  std::deque<Impact> impacts;  // all impacts of zones
  DisjointSets zones;
  double violation = 0;  // largest that the last round of zones left [m]

  bool is_free(int node) const { return inverse_mass[node] > 0; }
  bool spent() { return report.out_of_work = report.out_of_work || report.work.reaches(options.budget); }
  bool stopped() { return report.stopped = report.stopped || selvedge::stopped(options.stop); }
};

// Impacts of the pairs with a node whose path has changed since the last call.
std::vector<Impact> new_impacts(Resolution&);

// Joins the nodes of an impact for which belongs(node) is true.
template <class Belongs>
void join_nodes(DisjointSets& sets, const Impact& impact, const Belongs& belongs) {
  int first = -1;
  for (const int node : impact.pair.nodes)
    if (belongs(node)) sets.join(first < 0 ? first = node : first, node);
}

// Adds the impacts to the zones, joining those that share a free node, and projects every zone that got a new one.
void zone_round(Resolution&, const std::vector<Impact>& fresh);

// For zones in which obstacles leave no room: obstacle nodes of every zone that still has an impact get a mass, smaller
// from round to round, so that they give way as cloth does. Returns the impacts that are left.
std::vector<Impact> yield_rounds(Resolution&, std::vector<Impact>);

// Halves the motion of every node of a zone that still has an impact, and holds the zone still after some rounds. Each
// round holds more nodes, so it ends: without motion there is no impact. Returns false if impacts are left even so.
// Where the budget of work is spent, zones are held still at once, and after some rounds all nodes are.
bool shorten_rounds(Resolution&, std::vector<Impact>);

}  // namespace selvedge
