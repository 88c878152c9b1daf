#include "collision/ccd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/distance.hpp"

namespace selvedge {
namespace {

// Nodes relative to node 0 at the start: differences of doubles round with the size of the pair, not of the world.
struct Motion {
  std::array<Vec3, 4> start, move;
  int split;  // the first primitive is nodes [0, split), the second [split, 4)

  Vec3 at(int node, double time) const { return start[node] + time * move[node]; }
};

Motion relative_motion(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1) {
  Motion m;
  m.split = kind == PairKind::vertex_face ? 1 : 2;
  const Vec3 common = x1[0] - x0[0];
  for (int i = 0; i < 4; ++i) {
    m.start[i] = x0[i] - x0[0];
    m.move[i] = (x1[i] - x0[i]) - common;
  }
  return m;
}

// 4 ulp of the largest coordinate for the positions as given, and what the arithmetic on a Motion can lose.
double rounding(const Motion& m, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1) {
  double world = 0, local = 0;
  for (int i = 0; i < 4; ++i) {
    world = std::max({world, x0[i].cwiseAbs().maxCoeff(), x1[i].cwiseAbs().maxCoeff()});
    local = std::max({local, m.start[i].cwiseAbs().maxCoeff(), (x1[i] - x0[i]).cwiseAbs().maxCoeff()});
  }
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  return 4 * (std::nextafter(world, std::numeric_limits<double>::infinity()) - world) + 32 * epsilon * local;
}

// Directions in which the primitives may be told apart.
struct Separation {
  Vec3 closest;  // from the second primitive's closest point to the first's
  Vec3 normal;   // of the face or of both edges, to the same side
};

Separation separation(PairKind kind, const Motion& m, double time) {
  const std::array<Vec3, 4> x{m.at(0, time), m.at(1, time), m.at(2, time), m.at(3, time)};
  const bool face = kind == PairKind::vertex_face;
  const Closest c = face ? point_triangle(x[0], x[1], x[2], x[3]) : edge_edge(x[0], x[1], x[2], x[3]);
  const Vec3 closest = c.weights[0] * x[0] + c.weights[1] * x[1] + c.weights[2] * x[2] + c.weights[3] * x[3];
  const Vec3 normal = face ? (x[2] - x[1]).cross(x[3] - x[1]) : (x[1] - x[0]).cross(x[3] - x[2]);
  return {closest, normal.dot(closest) < 0 ? Vec3(-normal) : normal};
}

// The time from which on the slab of thickness `limit` across `direction` may no longer keep the primitives apart;
// `time` itself if it does not even then. Along a fixed direction every pair of nodes closes linearly, and the distance
// of the primitives is at least the smallest of those gaps: tangential motion costs nothing.
double separated_until(const Motion& m, const Vec3& direction, double time, double limit) {
  double until = std::numeric_limits<double>::infinity();
  for (int i = 0; i < m.split; ++i)
    for (int j = m.split; j < 4; ++j) {
      const double gap = direction.dot(m.start[i] - m.start[j]), rate = direction.dot(m.move[i] - m.move[j]);
      if (!(gap + time * rate > limit)) return time;
      if (rate < 0) until = std::min(until, (limit - gap) / rate);
    }
  return until;
}

}  // namespace

std::optional<double> time_of_contact(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                      double min_separation, int max_iterations) {
  const Motion motion = relative_motion(kind, x0, x1);
  const double slack = rounding(motion, x0, x1);
  double limit = min_separation + slack;
  double time = 0;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Separation apart = separation(kind, motion, time);
    const double distance = apart.closest.norm();
    if (iteration == 0 && distance <= limit + slack) limit = 0.5 * distance + slack;
    if (!(distance > limit)) return time;
    double until = separated_until(motion, apart.closest / distance, time, limit);
    // A short vector between closest points has lost its direction in rounding long before a normal does.
    if (!(until > time)) until = separated_until(motion, apart.normal.normalized(), time, limit);
    if (until > 1) return std::nullopt;
    if (!(until > time)) return time;
    time = until;
  }
  return time;
}

}  // namespace selvedge
