#include "pipeline/scene/outcome_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/audit/audit.hpp"
#include "physics/energies/measures.hpp"

namespace selvedge {
namespace {

Vec3 middle(const Points& x, const std::vector<int>& vertices) {
  return x(vertices, Eigen::all).colwise().mean().transpose();
}

// Angle about the axis that takes the vertices, each seen from their middle, nearest to where they have gone.
double angle_between(const std::vector<int>& vertices, const Vec3& axis, const Points& before, const Points& now) {
  const Vec3 from = middle(before, vertices), to = middle(now, vertices);
  double sine = 0, cosine = 0;
  for (const int v : vertices) {
    const Vec3 a = row(before, v) - from, b = row(now, v) - to;
    sine += axis.dot(a.cross(b));
    cosine += a.dot(b) - axis.dot(a) * axis.dot(b);
  }
  return std::atan2(sine, cosine);
}

// The triangle seen along `up`: whether the point is over or under it, and then how far over [m].
std::optional<double> height_over(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& up) {
  const auto side = [&](const Vec3& from, const Vec3& to) { return up.dot((to - from).cross(p - from)); };
  const double u = side(b, c), v = side(c, a), w = side(a, b), sum = u + v + w;
  const bool inside = sum != 0 && ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0));
  if (!inside) return {};
  return up.dot(p - (u * a + v * b + w * c) / sum);
}

// Which way the most of a cloth looks: 1 up, -1 down.
double facing(const Scene& scene, const Points& x, const Cloth& cloth, const Vec3& up) {
  double area = 0;
  for (int t = cloth.first_triangle; t < cloth.first_triangle + cloth.triangle_count; ++t) {
    const auto corners = scene.surface.triangles.row(t);
    const Vec3 a = row(x, corners[0]);
    area += up.dot((row(x, corners[1]) - a).cross(row(x, corners[2]) - a));
  }
  return area < 0 ? -1 : 1;
}

// Vertices of the upper cloth that look, with the side that most of it has above, at the side that most of the lower
// cloth has below, at its nearest triangle along `up`. A corner of either that is folded round the other's edge shows
// it the same side as what lies flat.
int below(const Scene& scene, const Points& x, const Cloth& lower, const Cloth& upper, const Vec3& up) {
  const double upside = facing(scene, x, lower, up), own_upside = facing(scene, x, upper, up);
  const Points normals = vertex_normals(scene.surface, x);
  const auto count = static_cast<std::size_t>(upper.vertex_count);
  std::vector<double> nearest(count, std::numeric_limits<double>::infinity());
  std::vector<bool> under(count, false);
  for (int t = lower.first_triangle; t < lower.first_triangle + lower.triangle_count; ++t) {
    const Vec3 a = row(x, scene.surface.triangles(t, 0)), b = row(x, scene.surface.triangles(t, 1)),
               c = row(x, scene.surface.triangles(t, 2));
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const double looks = upside * up.dot((b - a).cross(c - a));
    // Along the axes across `up` a point outside the triangle's box cannot be over it.
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = row(x, upper.first_vertex + static_cast<int>(i));
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis)
        apart = apart || (up[axis] == 0 && (p[axis] < low[axis] || p[axis] > high[axis]));
      if (apart) continue;
      const auto height = height_over(p, a, b, c, up);
      if (!height || std::abs(*height) >= nearest[i]) continue;
      nearest[i] = std::abs(*height);
      const double own_looks = own_upside * up.dot(row(normals, upper.first_vertex + static_cast<int>(i)));
      under[i] = *height * looks < 0 && own_looks * looks > 0;
    }
  }
  return static_cast<int>(std::count(under.begin(), under.end(), true));
}

}  // namespace

double obstacle_lag(const State& state, const Drive& drive, std::size_t k) {
  const auto moved = (state.obstacles[k] - drive.obstacles[k]).rowwise().norm();
  return moved.size() > 0 ? moved.maxCoeff() : 0;
}

double measured(const OutsideBox& m, const Scene&, const State& state, const Drive&) {
  double farthest = 0;
  for (const int v : m.vertices) {
    const Vec3 p = row(state.x, v);
    farthest = std::max(farthest, (m.low - p).cwiseMax(p - m.high).maxCoeff());
  }
  return farthest;
}

double measured(const PartsApart& m, const Scene&, const State& state, const Drive&) {
  const Vec3 apart = middle(state.x, m.to) - middle(state.x, m.from);
  return m.along.isZero(0) ? apart.norm() : apart.dot(m.along);
}

double measured(const Disorder& m, const Scene& scene, const State& state, const Drive&) {
  int count = 0;
  for (std::size_t c = 0; c + 1 < scene.cloths.size(); ++c)
    count += below(scene, state.x, scene.cloths[c], scene.cloths[c + 1], m.up);
  return count;
}

double measured(const Ahead& m, const Scene&, const State& state, const Drive&) {
  const Points& body = state.obstacles[static_cast<std::size_t>(m.obstacle)];
  const Vec3 center = 0.5 * (body.colwise().minCoeff() + body.colwise().maxCoeff()).transpose();
  double foremost = -std::numeric_limits<double>::infinity();
  for (const int v : m.vertices) {
    const Vec3 p = row(state.x, v);
    if ((p - center).cross(m.direction).norm() <= m.radius) foremost = std::max(foremost, p.dot(m.direction));
  }
  return foremost - (body * m.direction).maxCoeff();
}

double measured(const LargestStretch&, const Scene& scene, const State& state, const Drive&) {
  const auto stretches = principal_stretches(scene, state.x);
  return stretches.rows() > 0 ? stretches.col(1).maxCoeff() : 1;
}

double measured(const Lag& m, const Scene&, const State& state, const Drive& drive) {
  if (m.obstacle) return obstacle_lag(state, drive, static_cast<std::size_t>(*m.obstacle));
  double largest = 0;
  for (std::size_t k = 0; k < state.obstacles.size(); ++k) largest = std::max(largest, obstacle_lag(state, drive, k));
  return largest;
}

double measured(const WantedPairs&, const Scene& scene, const State& state, const Drive& drive) {
  std::vector<AuditBody> bodies;
  for (std::size_t k = 0; k < drive.obstacles.size(); ++k)
    bodies.push_back({&scene.obstacles[k].surface, &drive.obstacles[k]});
  const Audit found = audit(scene.surface, state.x, bodies, false);
  return static_cast<double>(found.obstacle_pairs.size()) + found.inside_vertices;
}

double turned(const Turns& m, const Points& before, const Points& now) {
  const double angle = angle_between(m.vertices, m.axis, before, now);
  const double other = m.against.empty() ? 0 : angle_between(m.against, m.axis, before, now);
  return (angle - other) / (2 * std::numbers::pi);
}

double drift(const Drift& m, const Points& start, const Points& now) {
  double farthest = 0;
  for (const int v : m.vertices) farthest = std::max(farthest, (row(now, v) - row(start, v)).norm());
  return farthest;
}

}  // namespace selvedge
