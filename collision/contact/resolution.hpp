#pragma once

#include <deque>

#include "collision/contact/path_pairs.hpp"
#include "collision/contact/resolve_options.hpp"
#include "collision/contact/response.hpp"
#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/stopwatch.hpp"

namespace selvedge {

// The work of one resolve call: what is known of the motion and of its impacts.
struct Resolution {
  PairSearch& search;
  const ContactWorld& world;
  Eigen::VectorXd inverse_mass;  // obstacles that yield get one of their own
  const ResolveOptions& options;
  const Points& x0;
  Points& x1;
  PathPairs& path;
  ResolveReport report;
  Stopwatch watch;
  std::vector<char> moved;     // nodes whose path changed since their pairs were tested
  std::deque<Impact> impacts;  // all that zones hold
  DisjointSets zones;
  double violation = 0;  // left by the last round of zones, at most [m]

  bool is_free(int node) const { return inverse_mass[node] > 0; }
  bool spent() { return report.out_of_work = report.out_of_work || report.work.reaches(options.most); }
  bool stopped() { return report.stopped = report.stopped || selvedge::stopped(options.stop); }
};

// Impacts of the pairs with a node whose path has changed since the last call.
std::vector<Impact> new_impacts(Resolution&);

// Adds the impacts to the zones, joining those that share a free node, and projects every zone that got a new one.
void zone_round(Resolution&, const std::vector<Impact>& fresh);

// Zones in which obstacles leave no room: the obstacle nodes of every zone that still has an impact get a mass, lighter
// from round to round, and give way as cloth does. Returns the impacts that are left.
std::vector<Impact> yield_rounds(Resolution&, std::vector<Impact>);

// Halves the motion of every node of a zone that still has an impact, and holds it still after some rounds. Each round
// holds more, so it ends: when nothing moves any more there is nothing left to meet. False if something met even so.
// Where there is no work left zones are held still at once, and after some rounds everything is.
bool shorten_rounds(Resolution&, std::vector<Impact>);

}  // namespace selvedge
