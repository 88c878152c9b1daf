#include "physics/curvature_stencil.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>

#include <Eigen/SVD>

namespace selvedge {
namespace {

// Cotangents and signed Voronoi areas at a rest triangle's corners; zero for a degenerate triangle.
struct Corners {
  std::array<double, 3> cotangent{}, voronoi{};
  double third = 0;  // of the area
};

Corners corners_of(const RestTriangle& rest) {
  Corners corners;
  const double rest_area = std::abs(area(rest));
  std::array<double, 3> opposite_squared;
  for (int k = 0; k < 3; ++k) opposite_squared[k] = (rest.col((k + 1) % 3) - rest.col((k + 2) % 3)).squaredNorm();
  if (!(rest_area > 1e-12 * *std::max_element(opposite_squared.begin(), opposite_squared.end()))) return corners;
  corners.third = rest_area / 3;
  for (int k = 0; k < 3; ++k) {
    const Vec2 a = rest.col((k + 1) % 3) - rest.col(k), b = rest.col((k + 2) % 3) - rest.col(k);
    corners.cotangent[k] = a.dot(b) / (2 * rest_area);
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    corners.voronoi[k] = (opposite_squared[i] * corners.cotangent[i] + opposite_squared[j] * corners.cotangent[j]) / 8;
  }
  return corners;
}

// The neighbours of an interior vertex in order, in the direction of its first triangle. Empty where the triangles
// round it are not one closed fan: at a boundary, a non-manifold edge, a pinched or isolated vertex.
std::vector<int> ordered_ring(const Surface& surface, int vertex) {
  std::vector<std::array<int, 2>> links;
  for (const int t : surface.triangles_of(vertex))
    for (int k = 0; k < 3; ++k)
      if (surface.triangles(t, k) == vertex)
        links.push_back({surface.triangles(t, (k + 1) % 3), surface.triangles(t, (k + 2) % 3)});
  if (links.size() < 3) return {};
  std::vector<int> ring{links[0][0]};
  int end = links[0][1];
  links.erase(links.begin());
  while (end != ring[0]) {
    const auto touches = [end](const auto& link) { return link[0] == end || link[1] == end; };
    if (std::count_if(links.begin(), links.end(), touches) != 1) return {};
    const auto link = std::find_if(links.begin(), links.end(), touches);
    ring.push_back(end);
    end = (*link)[0] == end ? (*link)[1] : (*link)[0];
    links.erase(link);
  }
  return links.empty() ? ring : std::vector<int>{};
}

// Least cell of a vertex, as a fraction of its barycentric area: bounds the stiffness that slivers can cause.
constexpr double smallest_cell = 0.25;
// Least singular value of the fit of a quadric over the largest: below, the ring is close to a conic.
constexpr double least_determined = 0.05;

// A scene's rest shape as the stencils see it.
struct RestShape {
  const Scene& scene;
  std::vector<Corners> corners;  // of the triangles
  std::vector<char> rigid;       // triangles whose corners are all pinned
};

RestShape rest_shape(const Scene& scene) {
  RestShape shape{scene, std::vector<Corners>(scene.rest_triangle.size()), {}};
  std::transform(scene.rest_triangle.begin(), scene.rest_triangle.end(), shape.corners.begin(), corners_of);
  std::vector<char> pinned(scene.surface.vertex_count, 0);
  for (const int pin : scene.pins) pinned[pin] = 1;
  for (int t = 0; t < scene.surface.triangles.rows(); ++t) {
    const auto corner = scene.surface.triangles.row(t);
    shape.rigid.push_back(pinned[corner(0)] && pinned[corner(1)] && pinned[corner(2)]);
  }
  return shape;
}

// The ring laid flat: each neighbour where its rest distance and the angles between, stretched to a full turn, put it.
std::vector<Vec2> flat_ring(const Scene& scene, const std::vector<int>& nodes) {
  const std::size_t ring = nodes.size() - 1;
  std::vector<double> length(ring), angle(ring, 0.0);  // angle: to the next neighbour
  for (const int t : scene.surface.triangles_of(nodes[0])) {
    const auto corner = scene.surface.triangles.row(t);
    int k = 0;
    while (corner(k) != nodes[0]) ++k;
    const RestTriangle& rest = scene.rest_triangle[t];
    const Vec2 first = rest.col((k + 1) % 3) - rest.col(k), second = rest.col((k + 2) % 3) - rest.col(k);
    const auto place = [&](int node) {
      return static_cast<std::size_t>(std::find(nodes.begin() + 1, nodes.end(), node) - nodes.begin()) - 1;
    };
    const std::size_t i = place(corner((k + 1) % 3)), j = place(corner((k + 2) % 3));
    length[i] = first.norm();
    length[j] = second.norm();
    const double between =
        std::atan2(std::abs(first.x() * second.y() - first.y() * second.x()), first.dot(second));
    angle[(i + 1) % ring == j ? i : j] = between;
  }
  double turn = 0;
  for (const double part : angle) turn += part;
  std::vector<Vec2> flat(ring);
  double at = 0;
  for (std::size_t i = 0; i < ring; ++i) {
    flat[i] = length[i] * Vec2(std::cos(at), std::sin(at));
    at += turn > 0 ? 2 * std::numbers::pi * angle[i] / turn : 0;
  }
  return flat;
}

// Fits u(p) - u(0) = g . p + (K_uu p_u^2 + 2 K_uv p_u p_v + K_vv p_v^2) / 2 to the ring, near neighbours first.
void fit_deviator(const Scene& scene, CurvatureStencil& stencil) {
  const std::vector<Vec2> ring = flat_ring(scene, stencil.nodes);
  const auto count = static_cast<Eigen::Index>(ring.size());
  double size = 0;
  for (const Vec2& p : ring) size += p.norm() / static_cast<double>(count);
  if (count < 5 || !(size > 0)) return;
  Eigen::MatrixXd quadric(count, 5);
  Eigen::VectorXd weight(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec2 p = ring[static_cast<std::size_t>(i)] / size;
    if (!(p.norm() > 0)) return;
    weight[i] = 1 / p.norm();
    quadric.row(i) << p.x(), p.y(), 0.5 * p.x() * p.x(), p.x() * p.y(), 0.5 * p.y() * p.y();
    quadric.row(i) *= weight[i];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(quadric, Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (!(svd.singularValues()[4] > least_determined * svd.singularValues()[0])) return;
  const Eigen::MatrixXd fit = svd.solve(Eigen::MatrixXd(weight.asDiagonal())) / (size * size);
  const Eigen::VectorXd a = 0.5 * (fit.row(2) - fit.row(4)), b = fit.row(3);
  stencil.a = {-a.sum()};
  stencil.b = {-b.sum()};
  stencil.a.insert(stencil.a.end(), a.begin(), a.end());
  stencil.b.insert(stencil.b.end(), b.begin(), b.end());
}

// Weights of the Laplacian, cell and fit of one vertex. The whole cell over the part that bends is how much denser
// curvature is there than the ring shows.
CurvatureStencil make_stencil(const RestShape& shape, int vertex) {
  const Surface& surface = shape.scene.surface;
  CurvatureStencil stencil;
  stencil.nodes = ordered_ring(surface, vertex);
  if (stencil.nodes.empty()) return stencil;
  stencil.nodes.insert(stencil.nodes.begin(), vertex);
  stencil.laplacian.assign(stencil.nodes.size(), 0);
  const auto slot = [&stencil](int node) {
    return std::find(stencil.nodes.begin(), stencil.nodes.end(), node) - stencil.nodes.begin();
  };
  double thirds = 0, whole = 0, whole_thirds = 0;
  for (const int t : surface.triangles_of(vertex))
    for (int k = 0; k < 3; ++k) {
      const Corners& corners = shape.corners[t];
      const int corner = surface.triangles(t, k);
      if (corner == vertex) {
        whole += corners.voronoi[k];
        whole_thirds += corners.third;
        stencil.cell += shape.rigid[t] ? 0 : corners.voronoi[k];
        thirds += shape.rigid[t] ? 0 : corners.third;
        continue;
      }
      // The edge from `vertex` to `corner` lies opposite the third corner.
      const int other = surface.triangles(t, (k + 1) % 3) == vertex ? (k + 2) % 3 : (k + 1) % 3;
      const double weight = 0.5 * corners.cotangent[other];
      stencil.laplacian[slot(corner)] += weight;
      stencil.laplacian[0] -= weight;
    }
  // Where very obtuse triangles leave next to no cell, or a negative one.
  stencil.cell = std::max(stencil.cell, smallest_cell * thirds);
  if (!(stencil.cell > 0)) return stencil;
  fit_deviator(shape.scene, stencil);
  const double denser = std::max(whole, smallest_cell * whole_thirds) / stencil.cell;
  for (std::vector<double>* weights : {&stencil.a, &stencil.b})
    for (double& weight : *weights) weight *= denser;
  return stencil;
}

double rest_length(const Scene& scene, int edge) {
  const int t = scene.surface.edge_owner[edge];
  for (int k = 0; k < 3; ++k)
    if (scene.surface.triangle_edges(t, k) == edge)
      return (scene.rest_triangle[t].col(k) - scene.rest_triangle[t].col((k + 1) % 3)).norm();
  return 0;
}

// For every vertex which of the sources is nearest along edges, -1 where none can be reached; the lower one on a tie.
std::vector<int> nearest_source(const Scene& scene, const std::vector<int>& sources) {
  const Surface& surface = scene.surface;
  std::vector<std::vector<std::pair<int, double>>> neighbours(surface.vertex_count);
  for (int e = 0; e < surface.edges.rows(); ++e) {
    const double length = rest_length(scene, e);
    neighbours[surface.edges(e, 0)].emplace_back(surface.edges(e, 1), length);
    neighbours[surface.edges(e, 1)].emplace_back(surface.edges(e, 0), length);
  }
  using Entry = std::tuple<double, int, int>;  // distance, source, vertex
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::size_t s = 0; s < sources.size(); ++s) queue.emplace(0, static_cast<int>(s), sources[s]);
  std::vector<int> nearest(surface.vertex_count, -1);
  while (!queue.empty()) {
    const auto [distance, source, vertex] = queue.top();
    queue.pop();
    if (nearest[vertex] >= 0) continue;
    nearest[vertex] = source;
    for (const auto& [next, length] : neighbours[vertex])
      if (nearest[next] < 0) queue.emplace(distance + length, source, next);
  }
  return nearest;
}

// The area that bends round each vertex of the cloths that have stencils.
std::vector<double> bending_areas(const RestShape& shape, const std::vector<CurvatureStencil>& stencils) {
  std::vector<double> areas(shape.scene.surface.vertex_count, 0.0);
  for (int t = 0; t < shape.scene.surface.triangles.rows(); ++t)
    for (int k = 0; k < 3 && !shape.rigid[t]; ++k)
      areas[shape.scene.surface.triangles(t, k)] += shape.corners[t].voronoi[k];
  for (const CurvatureStencil& stencil : stencils) areas[stencil.nodes[0]] = stencil.cell;
  return areas;
}

// Gives every vertex's area to the nearest vertex that measures the trace, and to the nearest that measures the
// deviator.
void share_areas(const RestShape& shape, std::vector<CurvatureStencil>& stencils) {
  std::vector<int> all, fitted, fitted_index;
  for (std::size_t s = 0; s < stencils.size(); ++s) {
    all.push_back(stencils[s].nodes[0]);
    if (stencils[s].a.empty()) continue;
    fitted.push_back(stencils[s].nodes[0]);
    fitted_index.push_back(static_cast<int>(s));
  }
  const std::vector<double> areas = bending_areas(shape, stencils);
  const std::vector<int> trace = nearest_source(shape.scene, all), deviator = nearest_source(shape.scene, fitted);
  for (std::size_t v = 0; v < areas.size(); ++v) {
    if (trace[v] >= 0) stencils[trace[v]].trace_area += areas[v];
    if (deviator[v] >= 0) stencils[fitted_index[deviator[v]]].deviator_area += areas[v];
  }
  for (CurvatureStencil& stencil : stencils) {  // a boundary cell can be negative
    stencil.trace_area = std::max(stencil.trace_area, stencil.cell);
    if (!stencil.a.empty()) stencil.deviator_area = std::max(stencil.deviator_area, stencil.cell);
    stencil.deviator_elsewhere = deviator[stencil.nodes[0]] >= 0;
  }
}

}  // namespace

std::vector<CurvatureStencil> curvature_stencils(const Scene& scene) {
  const RestShape shape = rest_shape(scene);
  std::vector<CurvatureStencil> stencils;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    if (cloth.material.bending_model != BendingModel::curvature || !(cloth.material.bending > 0)) continue;
    for (int v = cloth.first_vertex; v < cloth.first_vertex + cloth.vertex_count; ++v) {
      CurvatureStencil stencil = make_stencil(shape, v);
      if (stencil.nodes.empty() || !(stencil.cell > 0)) continue;
      stencil.cloth = static_cast<int>(c);
      stencils.push_back(std::move(stencil));
    }
  }
  if (!stencils.empty()) share_areas(shape, stencils);
  return stencils;
}

}  // namespace selvedge
