#include "physics/energies/quadric_stencil.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "collision/geometry/factorisations.hpp"
#include "physics/energies/nearest.hpp"

namespace selvedge {
namespace {

// Least eigenvalue of the fit's normal matrix over the largest, points scaled to a mean distance of 1: below, the
// points are too close to a conic.
constexpr double least_determined = 5e-3;

using Mat5 = Eigen::Matrix<double, 5, 5>;
using Vec5 = Eigen::Vector<double, 5>;

struct RestShape {
  const Scene& scene;
  std::vector<double> area;  // of the triangles
  std::vector<char> rigid;   // all corners pinned
};

RestShape rest_shape(const Scene& scene) {
  RestShape shape{scene, {}, {}};
  std::vector<char> pinned(scene.surface.vertex_count, 0);
  for (const int pin : scene.pins) pinned[pin] = 1;
  for (int t = 0; t < scene.surface.triangles.rows(); ++t) {
    const auto corner = scene.surface.triangles.row(t);
    shape.area.push_back(std::abs(area(scene.rest_triangle[t])));
    shape.rigid.push_back(pinned[corner(0)] && pinned[corner(1)] && pinned[corner(2)]);
  }
  return shape;
}

double rest_distance(const Scene& scene, int triangle, int k, int m) {
  return (scene.rest_triangle[triangle].col(k) - scene.rest_triangle[triangle].col(m)).norm();
}

// Vertices laid flat round the first one, by their rest distances.
struct Chart {
  std::vector<int> nodes;
  std::vector<Vec2> points;
  std::map<int, int> triangles;  // laid, and after how many edges away from the vertex's own
  int find(int node) const {
    const auto place = std::find(nodes.begin(), nodes.end(), node);
    return place == nodes.end() ? -1 : static_cast<int>(place - nodes.begin());
  }
};

// Where corner k of a triangle lies beyond its other two, on the side where `from` is not.
Vec2 laid_beyond(const Scene& scene, const Chart& chart, int t, int k, const Vec2& from) {
  const auto corner = scene.surface.triangles.row(t);
  const int m = (k + 1) % 3, n = (k + 2) % 3;
  const Vec2 first = chart.points[chart.find(corner(m))], second = chart.points[chart.find(corner(n))];
  const double base = rest_distance(scene, t, m, n), near = rest_distance(scene, t, m, k),
               far = rest_distance(scene, t, n, k);
  if (!(base > 0) || !((second - first).norm() > 0)) return first;
  const double along = (near * near + base * base - far * far) / (2 * base);
  const double height = std::sqrt(std::max(near * near - along * along, 0.0));
  const Vec2 axis = (second - first).normalized(), side(-axis.y(), axis.x());
  return first + along * axis + (side.dot(from - first) > 0 ? -height : height) * side;
}

// Lays the triangles at the vertex, then those next to them, `layers` times, edge by edge. Empty where a vertex's own
// triangles are no single fan.
Chart lay_out(const Scene& scene, int vertex, int layers) {
  const Surface& surface = scene.surface;
  Chart chart;
  const auto own = surface.triangles_of(vertex);
  if (own.empty()) return chart;
  const int start = *own.begin();
  const auto corner = surface.triangles.row(start);
  const int k = surface.corner_of(start, vertex);
  const Vec2 origin = scene.rest_triangle[start].col(k);
  chart.nodes = {vertex, corner((k + 1) % 3), corner((k + 2) % 3)};
  for (int m = 0; m < 3; ++m) chart.points.emplace_back(scene.rest_triangle[start].col((k + m) % 3) - origin);
  chart.triangles[start] = 0;
  std::vector<int> wave{start};
  for (int layer = 0; layer <= layers; ++layer) {
    std::vector<int> next;
    for (std::size_t i = 0; i < wave.size(); ++i) {
      const int t = wave[i];
      for (int m = 0; m < 3; ++m) {
        const int other = surface.across(surface.triangle_edges(t, m), t);
        if (other < 0 || chart.triangles.count(other)) continue;
        const auto theirs = surface.triangles.row(other);
        const bool at_vertex = (theirs.array() == vertex).any();
        if (layer == 0 && !at_vertex) {
          next.push_back(t);  // its neighbours belong to the next layer
          continue;
        }
        chart.triangles[other] = layer;
        int tip = 0;
        while (theirs(tip) == surface.triangles(t, m) || theirs(tip) == surface.triangles(t, (m + 1) % 3)) ++tip;
        if (chart.find(theirs(tip)) < 0) {
          chart.points.push_back(
              laid_beyond(scene, chart, other, tip, chart.points[chart.find(surface.triangles(t, (m + 2) % 3))]));
          chart.nodes.push_back(theirs(tip));
        }
        (layer == 0 ? wave : next).push_back(other);
      }
    }
    if (layer == 0)
      for (const int t : own)
        if (!chart.triangles.count(t)) return {};
    wave = std::move(next);
  }
  return chart;
}

// How much denser curvature is at the vertex than its whole neighbourhood shows: all of it counts on what can bend.
double density(const RestShape& shape, int vertex) {
  double whole = 0, bending = 0;
  for (const int t : shape.scene.surface.triangles_of(vertex)) {
    whole += shape.area[t];
    if (!shape.rigid[t]) bending += shape.area[t];
  }
  return whole / bending;
}

// Fits u(p) - u(0) = g . p + (K_uu p_u^2 + 2 K_uv p_u p_v + K_vv p_v^2) / 2. False where the points do not determine
// it.
bool fit_quadric(const RestShape& shape, const Chart& chart, QuadricStencil& stencil) {
  const auto count = static_cast<Eigen::Index>(chart.nodes.size());
  double size = 0;
  for (const Vec2& p : chart.points) size += p.norm() / static_cast<double>(count - 1);
  if (!(size > 0)) return false;
  // The normal equations, weighted by 1 / |p|: `right` has a column a node's u, the centre's is minus the others' sum.
  Mat5 normal = Mat5::Zero();
  Eigen::Matrix<double, 5, Eigen::Dynamic> weighted = decltype(weighted)::Zero(5, count), right = weighted;
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 1; i < count; ++i) {
    const Vec2 p = chart.points[static_cast<std::size_t>(i)] / size;
    if (!(p.norm() > 1e-6)) return false;
    weight[i] = 1 / p.norm();
    const Vec5 terms = Vec5(p.x(), p.y(), 0.5 * p.x() * p.x(), p.x() * p.y(), 0.5 * p.y() * p.y()) * weight[i];
    normal += terms * terms.transpose();
    weighted.col(i) = terms;
    right.col(i) = terms * weight[i];
    right.col(0) -= right.col(i);
  }
  const Eigen::VectorXd spectrum = symmetric_eigenvalues(normal);
  if (!(spectrum[0] > least_determined * spectrum[4])) return false;
  const Eigen::LDLT<Mat5> factor(normal);
  const double denser = density(shape, stencil.vertex), scale = denser / (size * size);
  stencil.nodes = chart.nodes;
  stencil.trace.resize(count);
  stencil.a.resize(count);
  stencil.b.resize(count);
  // A clamp's kink is no quadric and must not be held for a misfit.
  stencil.misfit.resize(denser > 1 ? 0 : count, count);
  const double misfit_scale = 1 / (size * size * weight.norm());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec5 solution = factor.solve(Vec5(right.col(i)));
    stencil.trace[i] = scale * (solution[2] + solution[4]);
    stencil.a[i] = scale * 0.5 * (solution[2] - solution[4]);
    stencil.b[i] = scale * solution[3];
    for (Eigen::Index k = 0; k < stencil.misfit.rows(); ++k) {
      const double u = i == 0 ? -weight[k] : i == k ? weight[k] : 0;
      stencil.misfit(k, i) = misfit_scale * (u - weighted.col(k).dot(solution));
    }
  }
  return true;
}

// The part of a rest triangle that is nearest to each corner; in obtuse triangles half of it for the obtuse corner and
// a quarter for the others (Meyer et al. 2003).
std::array<double, 3> corner_areas(const RestTriangle& rest, double whole) {
  std::array<double, 3> areas{whole / 4, whole / 4, whole / 4};
  std::array<double, 3> dot{};
  for (int k = 0; k < 3; ++k) dot[k] = (rest.col((k + 1) % 3) - rest.col(k)).dot(rest.col((k + 2) % 3) - rest.col(k));
  for (int k = 0; k < 3; ++k)
    if (dot[k] < 0) {
      areas[k] = whole / 2;
      return areas;
    }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    areas[k] =
        ((rest.col(j) - rest.col(k)).squaredNorm() * dot[i] + (rest.col(i) - rest.col(k)).squaredNorm() * dot[j]) /
        (16 * whole);
  }
  return areas;
}

// The area that bends round each vertex.
std::vector<double> vertex_areas(const RestShape& shape) {
  std::vector<double> areas(shape.scene.surface.vertex_count, 0.0);
  for (int t = 0; t < shape.scene.surface.triangles.rows(); ++t) {
    if (shape.rigid[t] || !(shape.area[t] > 0)) continue;
    const std::array<double, 3> parts = corner_areas(shape.scene.rest_triangle[t], shape.area[t]);
    for (int k = 0; k < 3; ++k) areas[shape.scene.surface.triangles(t, k)] += parts[k];
  }
  return areas;
}

}  // namespace

std::vector<QuadricStencil> quadric_stencils(const Scene& scene) {
  const RestShape shape = rest_shape(scene);
  std::vector<double> areas = vertex_areas(shape);
  std::vector<QuadricStencil> stencils;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    if (cloth.material.bending_model != BendingModel::curvature || !(cloth.material.bending > 0)) continue;
    for (int v = cloth.first_vertex; v < cloth.first_vertex + cloth.vertex_count; ++v) {
      if (!(areas[v] > 0)) continue;
      QuadricStencil stencil;
      stencil.vertex = v;
      stencil.cloth = static_cast<int>(c);
      for (int layers = 0; layers <= 2; ++layers) {
        const Chart chart = lay_out(scene, v, layers);
        if (chart.nodes.empty()) break;
        if (!fit_quadric(shape, chart, stencil)) continue;
        stencils.push_back(std::move(stencil));
        break;
      }
    }
  }
  std::vector<int> centres;
  for (const QuadricStencil& stencil : stencils) centres.push_back(stencil.vertex);
  const std::vector<int> nearest = nearest_along_edges(scene, centres);
  for (std::size_t v = 0; v < areas.size(); ++v)
    if (nearest[v] >= 0) stencils[nearest[v]].area += areas[v];
  return stencils;
}

}  // namespace selvedge
