#include "collision/contact/room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/contact/resolve.hpp"
#include "collision/contact/response.hpp"
#include "collision/geometry/stopwatch.hpp"

namespace selvedge {
namespace {

struct Squeeze {
  PairSearch& search;
  const ContactWorld& world;
  const ResolveOptions& options;
  const Points& x0;
  PathPairs& path;
  Eigen::VectorXd& inverse_mass;
  ResolveReport& report;
  double light = 0;               // inverse mass of a node that gives way
  std::vector<char> moving;       // by obstacle: one that stands still does not give way
  std::vector<char> yields;       // by node
  std::vector<Impact> demands{};  // the first `near` are those of pairs near the start
  std::size_t near = 0;
  Points x{};  // after the last press
  Stopwatch watch{};

  double distance() const { return 2 * options.separation; }
  double start_gap(const NodePair& pair) const { return std::sqrt(closest(pair, x0).squared_distance); }
};

void add_meetings(Squeeze& s, const Points& x1) {
  s.report.response += s.watch.lap();
  std::vector<Impact> impacts = find_impacts(s.search, s.inverse_mass, s.options, s.x0, x1, s.path, s.report);
  s.watch.lap();
  for (Impact& impact : impacts) {
    impact.target = std::min(s.distance(), s.start_gap(impact.pair));
    s.demands.push_back(impact);
  }
}

// Moves s.x from `trial` to meet the demands as far as possible. Returns for each demand the growth of its multiplier
// in the last block of sweeps, 0 where it was small.
std::vector<double> press(Squeeze& s, const Points& trial) {
  s.x = trial;
  std::vector<Impact*> all;
  for (Impact& demand : s.demands) {
    demand.multiplier = 0;
    all.push_back(&demand);
  }
  const RoomOptions& room = s.options.room;
  const double tolerance = 0.1 * s.options.separation, least = room.growing * s.options.separation * room.sweeps;
  std::vector<double> growth(s.demands.size());
  double sum = 0;
  for (int b = 0; b < room.max_blocks && !stopped(s.options.stop); ++b) {
    for (std::size_t k = 0; k < growth.size(); ++k) growth[k] = -s.demands[k].multiplier;
    s.report.work.projected += project_zone(all, s.inverse_mass, s.x0, s.x, room.sweeps, tolerance).moved;
    const double before = sum;
    sum = 0;
    for (std::size_t k = 0; k < growth.size(); ++k) {
      growth[k] += s.demands[k].multiplier;
      const double way = growth[k] * compliance(s.demands[k], s.inverse_mass);
      if (way < least)
        growth[k] = 0;
      else
        sum += way;
    }
    if (sum == 0 || (b >= room.min_blocks && sum > room.steady * before)) break;
  }
  return growth;
}

// Lets the obstacle nodes of growing demands give way. Also shortens their motion in `trial`, so that they approach the
// cloth by at most half of their spare distance. Returns false if no further node gives way.
bool give_way(Squeeze& s, const std::vector<double>& growth, Points& trial) {
  Points away = Points::Zero(trial.rows(), 3);
  Eigen::VectorXd gap = Eigen::VectorXd::Zero(trial.rows()), share = gap;
  bool any = false;
  for (std::size_t k = 0; k < growth.size(); ++k) {
    if (growth[k] <= 0) continue;
    const Impact& demand = s.demands[k];
    const double spare = std::max(0.0, s.start_gap(demand.pair) - s.distance());
    for (int i = 0; i < 4; ++i) {
      const int node = demand.pair.nodes[i];
      if (const int body = s.world.obstacle_of(node); body < 0 || !s.moving[body]) continue;
      any = any || !s.yields[node];
      s.yields[node] = 1;
      s.inverse_mass[node] = s.light;
      away.row(node) += demand.weights[i] * growth[k] * demand.normal.transpose();
      gap[node] += std::abs(demand.weights[i]) * growth[k] * spare;
      share[node] += std::abs(demand.weights[i]) * growth[k];
    }
  }
  for (int node = s.world.cloth->vertex_count; node < trial.rows(); ++node) {
    const double length = away.row(node).norm();
    if (length == 0) continue;
    const Vec3 out = row(away, node) / length;
    const double nearer = out.dot(row(s.x0, node) - row(trial, node)), most = 0.5 * gap[node] / share[node];
    if (nearer > most) trial.row(node) += (nearer - most) * out.transpose();
  }
  return any;
}

// A body that gives way far at a single place would fold into itself. So nodes nearby lag too, such that the lag
// changes by less than the distance between nodes, and no two points of the body can meet. Small lags are not spread.
void spread_lag(const Squeeze& s, const Points& wanted, Points& x1) {
  const int nodes = static_cast<int>(x1.rows());
  std::vector<std::pair<double, int>> lagging;
  for (int node = s.world.cloth->vertex_count; node < nodes; ++node)
    if (const double lag = (x1.row(node) - wanted.row(node)).norm(); lag > 0) lagging.emplace_back(-lag, node);
  std::sort(lagging.begin(), lagging.end());
  const Points lags = x1 - wanted;
#pragma omp parallel for schedule(static)
  for (int node = s.world.cloth->vertex_count; node < nodes; ++node) {
    const int body = s.world.obstacle_of(node);
    Vec3 lag = row(lags, node);
    for (const auto& [minus_size, from] : lagging) {
      const double least = -minus_size - lag.norm();
      if (least <= 0) break;  // this node lags more than all that follow
      const double near = s.options.room.steepest_lag * (row(wanted, from) - row(wanted, node)).norm();
      const Vec3 more = row(lags, from) - lag;
      if (from != node && more.norm() > near && s.world.obstacle_of(from) == body)
        lag += (1 - near / more.norm()) * more;
    }
    x1.row(node) = wanted.row(node) + lag.transpose();
  }
}

}  // namespace

bool make_room(PairSearch& search, const ContactWorld& world, const ResolveOptions& options,
               std::span<const Proximity> near, const Points& x0, Points& x1, PathPairs& path,
               Eigen::VectorXd& inverse_mass, ResolveReport& report) {
  Squeeze s{search,
            world,
            options,
            x0,
            path,
            inverse_mass,
            report,
            mean_inverse_mass(inverse_mass) / options.room.obstacle_mass,
            obstacles_in_motion(world, x0, x1),
            std::vector<char>(world.node_count, 0)};
  if (std::ranges::count(s.moving, 1) == 0) return false;
  for (const Proximity& p : near) s.demands.push_back({p.pair, p.weights, p.normal, 0, std::min(s.distance(), p.gap)});
  s.near = s.demands.size();
  Points trial = x1;
  add_meetings(s, trial);
  bool squeezed = false;
  for (int round = 0; round < options.room.max_rounds && !stopped(options.stop); ++round) {
    if (give_way(s, press(s, trial), trial)) {
      squeezed = true;
      s.demands.resize(s.near);  // demands met on the way to the old `trial` are out of date
      add_meetings(s, trial);
      continue;
    }
    if (!squeezed) break;
    const std::size_t known = s.demands.size();
    add_meetings(s, s.x);
    if (static_cast<double>(s.demands.size()) <= (1 + options.room.few) * static_cast<double>(known)) break;
  }
  const Eigen::Index obstacles = x1.rows() - world.cloth->vertex_count;
  if (squeezed) {
    const Points wanted = x1;
    x1.bottomRows(obstacles) = s.x.bottomRows(obstacles);
    spread_lag(s, wanted, x1);
  }
  report.response += s.watch.lap();
  return squeezed;
}

bool has_arrived(const Points& nodes, const Points& wanted) {
  const double rounding =
      4 * std::numeric_limits<double>::epsilon() * std::max(largest_coordinate(nodes), largest_coordinate(wanted));
  return ((wanted - nodes).array().abs() <= rounding).all();
}

ResolveReport catch_up(PairSearch& search, const ResolveOptions& options, const Eigen::VectorXd& inverse_mass,
                       const Points& wanted, Points& nodes, PathPairs& path) {
  ResolveReport report;
  const Eigen::Index obstacles = nodes.rows() - search.world().cloth->vertex_count;
  Points there = nodes;
  there.bottomRows(obstacles) = wanted.bottomRows(obstacles);
  report.clean =
      has_arrived(nodes, there) || find_impacts(search, inverse_mass, options, nodes, there, path, report).empty();
  if (report.clean) nodes = std::move(there);
  return report;
}

}  // namespace selvedge
