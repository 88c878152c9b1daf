#include "collision/untangle/input_shape.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

using Edges32 = Eigen::Matrix<double, 3, 2>;

Edges32 edges_of(const Surface& surface, const Points& x, int triangle) {
  const Vec3 a = row(x, surface.triangles(triangle, 0));
  Edges32 edges;
  edges.col(0) = row(x, surface.triangles(triangle, 1)) - a;
  edges.col(1) = row(x, surface.triangles(triangle, 2)) - a;
  return edges;
}

// A triangle's edges in 2D coordinates of its plane; the determinant is twice the area.
Eigen::Matrix2d flattened(const Edges32& edges) {
  const double base = edges.col(0).norm();
  const double along = base > 0 ? edges.col(0).dot(edges.col(1)) / base : 0;
  const double height = base > 0 ? edges.col(0).cross(edges.col(1)).norm() / base : 0;
  return (Eigen::Matrix2d() << base, along, 0, height).finished();
}

// Where c = F'F stands among the symmetric 2 x 2 matrices: its eigenvalues are mean -+ the length of (half, off).
struct Symmetric {
  double mean, half, off;
  explicit Symmetric(const Edges32& f) {
    const Eigen::Matrix2d c = f.transpose() * f;
    mean = 0.5 * (c(0, 0) + c(1, 1));
    half = 0.5 * (c(0, 0) - c(1, 1));
    off = c(0, 1);
  }
};

// Singular values of F, ascending.
Eigen::Vector2d principal_values(const Symmetric& c) {
  const double radius = std::hypot(c.half, c.off);
  return {std::sqrt(std::max(0.0, c.mean - radius)), std::sqrt(std::max(0.0, c.mean + radius))};
}

// Right singular vectors of F, columns, in the plane of the input triangle.
Eigen::Matrix2d principal_axes(const Symmetric& c) {
  const double angle = 0.5 * std::atan2(c.off, c.half);
  return (Eigen::Matrix2d() << -std::sin(angle), std::cos(angle), std::cos(angle), std::sin(angle)).finished();
}

// True only if the singular values are in the range: a quick test that decides most triangles.
bool surely_within(const Symmetric& c, const StretchRange& range) {
  constexpr double slack = 1e-12;  // thousands of times the rounding of these few operations
  const double radius = std::sqrt(c.half * c.half + c.off * c.off);
  return c.mean - radius - slack * c.mean > (1 + slack) * range.least * range.least &&
         c.mean + radius < (1 - slack) * range.largest * range.largest;
}

Edges32 deformation(const InputShape& shape, const Points& x, int triangle) {
  return edges_of(*shape.surface, x, triangle) * shape.rest_inverse[triangle];
}

void make_neighbours(InputShape& shape) {
  const Surface& s = *shape.surface;
  shape.neighbours = adjacency_of(s.vertex_count, s.edges);
  shape.edge_length.assign(s.vertex_count, 0);
  for (int e = 0; e < s.edges.rows(); ++e) {
    const int a = s.edges(e, 0), b = s.edges(e, 1);
    const double length = (row(shape.x0, a) - row(shape.x0, b)).norm();
    shape.edge_length[a] += length;
    shape.edge_length[b] += length;
  }
  shape.mean_edge = mean_edge(s, shape.x0);
  for (int v = 0; v < s.vertex_count; ++v) {
    const auto count = static_cast<double>(shape.neighbours.of(v).size());
    if (count > 0) shape.edge_length[v] /= count;
  }
}

}  // namespace

InputShape input_shape(const Surface& surface, const Points& x0) {
  InputShape shape;
  shape.surface = &surface;
  shape.x0 = x0;
  make_neighbours(shape);
  for (int t = 0; t < surface.triangles.rows(); ++t) {
    const Eigen::Matrix2d rest = flattened(edges_of(surface, x0, t));
    const bool measured = std::abs(rest.determinant()) > 1e-10 * rest.squaredNorm();
    shape.measured.push_back(measured);
    shape.rest_inverse.push_back(measured ? Eigen::Matrix2d(rest.inverse()) : Eigen::Matrix2d::Zero());
  }
  return shape;
}

std::vector<char> within_rings(const InputShape& shape, const std::vector<char>& marked, int rings) {
  std::vector<char> reached = marked;
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<char> before = reached;
    for (int e = 0; e < shape.surface->edges.rows(); ++e) {
      const int a = shape.surface->edges(e, 0), b = shape.surface->edges(e, 1);
      if (before[a]) reached[b] = 1;
      if (before[b]) reached[a] = 1;
    }
  }
  return reached;
}

StretchRange stretch_of(const InputShape& shape, const Points& x, int triangle) {
  if (!shape.measured[triangle]) return {};
  const Eigen::Vector2d value = principal_values(Symmetric(deformation(shape, x, triangle)));
  return {value[0], value[1]};
}

StretchRange extreme_stretch(const InputShape& shape, const Points& x) {
  StretchRange extreme;
  for (int t = 0; t < shape.surface->triangles.rows(); ++t) {
    const StretchRange stretch = stretch_of(shape, x, t);
    extreme.least = std::min(extreme.least, stretch.least);
    extreme.largest = std::max(extreme.largest, stretch.largest);
  }
  return extreme;
}

void smooth_displacement(const InputShape& shape, const Points& from, std::span<const int> vertices, double share,
                         Points& x) {
  std::vector<Vec3> moved;
  moved.reserve(vertices.size());
  for (int v : vertices) {
    const std::span<const int> round = shape.neighbours.of(v);
    const Vec3 own = row(x, v) - row(from, v);
    Vec3 mean = Vec3::Zero();
    for (const int w : round) mean += row(x, w) - row(from, w);
    moved.push_back(round.empty() ? own : Vec3(own + share * (mean / static_cast<double>(round.size()) - own)));
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) x.row(vertices[i]) = from.row(vertices[i]) + moved[i].transpose();
}

void limit_stretch(const InputShape& shape, std::span<const int> triangles, const std::vector<double>& reach,
                   const StretchRange& range, Points& x) {
  for (int t : triangles) {
    if (!shape.measured[t]) continue;
    const Edges32 f = deformation(shape, x, t);
    const Symmetric c(f);
    if (surely_within(c, range)) continue;
    const Eigen::Vector2d value = principal_values(c);
    if (value[0] >= range.least && value[1] <= range.largest) continue;
    Eigen::Vector2d factor;
    for (int k = 0; k < 2; ++k)
      factor[k] = std::min(10.0, std::clamp(value[k], range.least, range.largest) / std::max(value[k], 1e-12));
    const Edges32 change = edges_of(*shape.surface, x, t);
    const Eigen::Matrix2d axes = principal_axes(c), scale = axes * factor.asDiagonal() * axes.transpose();
    const Edges32 wanted = f * scale * shape.rest_inverse[t].inverse() - change;
    std::array<Vec3, 3> move{Vec3::Zero(), wanted.col(0), wanted.col(1)};
    Vec3 fixed = Vec3::Zero(), mean = Vec3::Zero();
    int fixed_count = 0;
    for (int k = 0; k < 3; ++k) {
      mean += move[k] / 3;
      if (reach[shape.surface->triangles(t, k)] > 0) continue;
      fixed += move[k];
      ++fixed_count;
    }
    if (fixed_count == 3) continue;
    const Vec3 shift = fixed_count > 0 ? Vec3(fixed / fixed_count) : mean;
    for (int k = 0; k < 3; ++k) {
      const int v = shape.surface->triangles(t, k);
      if (reach[v] > 0) x.row(v) += (move[k] - shift).transpose();
    }
  }
}

void limit_displacement(const InputShape& shape, std::span<const int> vertices, const std::vector<double>& reach,
                        Points& x) {
  for (int v : vertices) {
    const Vec3 moved = row(x, v) - row(shape.x0, v);
    const double length = moved.norm();
    if (length > reach[v]) x.row(v) = shape.x0.row(v) + reach[v] / length * moved.transpose();
  }
}

void hold_back(const InputShape& shape, std::span<const int> triangles, const StretchRange& range, const Points& before,
               Points& x) {
  std::vector<char> offends(shape.surface->vertex_count, 0);
  for (int round = 0;; ++round) {
    bool clean = true;
    for (int t : triangles) {
      if (shape.measured[t] && surely_within(Symmetric(deformation(shape, x, t)), range)) continue;
      const StretchRange stretch = stretch_of(shape, x, t);
      if (stretch.least >= range.least && stretch.largest <= range.largest) continue;
      for (int v : shape.surface->triangles.row(t)) {
        clean = clean && x.row(v) == before.row(v);
        offends[v] = 1;
      }
    }
    if (clean) return;
    take_back(offends, round, before, x);
  }
}

void take_back(std::vector<char>& offends, int round, const Points& before, Points& x) {
  const double share = round < 6 ? 0.6 : 0;
  for (std::size_t v = 0; v < offends.size(); ++v) {
    if (!offends[v]) continue;
    const auto at = static_cast<Eigen::Index>(v);
    if (share > 0)
      x.row(at) = before.row(at) + share * (x.row(at) - before.row(at));
    else
      x.row(at) = before.row(at);
    offends[v] = 0;
  }
}

}  // namespace selvedge
