#include <algorithm>
#include <cmath>

#include "physics/energies/bending.hpp"
#include "physics/energies/nearest.hpp"
#include "physics/energies/quadric_stencil.hpp"

// Flat rest shapes take the plate's whole energy by quadrics (physics/energies/quadric_stencil.hpp). Curved ones take
// the part of the mean curvature: L is the cotangent Laplacian of the rest metric, so that (L x)_i is the mean
// curvature vector integrated over vertex i's Voronoi cell A_i. A_i is signed (obtuse triangles reach out of
// themselves): then (L x)_i / A_i is exact for every paraboloid of revolution on every ring, and a rolled sheet's
// energy is off only by the ring's anisotropy. The energy density found so counts on the area W_i that the vertex
// stands for: its own cell and those of the boundary vertices next to it, without which a sheet would be soft along its
// edges and at a clamp.
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
  for (const int t : surface.triangles_of(vertex)) {
    const int k = surface.corner_of(t, vertex);
    links.push_back({surface.triangles(t, (k + 1) % 3), surface.triangles(t, (k + 2) % 3)});
  }
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

// One interior vertex of a bending cloth.
struct Stencil {
  std::vector<int> nodes;
  std::vector<double> laplacian;
  double cell = 0;     // A [m2]
  double weight = 0;   // W [m2]
  double bending = 0;  // B [N m]
};

Stencil make_stencil(const Scene& scene, const std::vector<Corners>& corners, int vertex, double bending) {
  Stencil stencil;
  stencil.bending = bending;
  stencil.nodes = ordered_ring(scene.surface, vertex);
  if (stencil.nodes.empty()) return stencil;
  stencil.nodes.insert(stencil.nodes.begin(), vertex);
  stencil.laplacian.assign(stencil.nodes.size(), 0);
  const auto slot = [&stencil](int node) { return std::ranges::find(stencil.nodes, node) - stencil.nodes.begin(); };
  double thirds = 0;
  for (const int t : scene.surface.triangles_of(vertex))
    for (int k = 0; k < 3; ++k) {
      const int corner = scene.surface.triangles(t, k);
      if (corner == vertex) {
        stencil.cell += corners[t].voronoi[k];
        thirds += corners[t].third;
        continue;
      }
      // The edge from `vertex` to `corner` lies opposite the third corner.
      const int other = scene.surface.triangles(t, (k + 1) % 3) == vertex ? (k + 2) % 3 : (k + 1) % 3;
      const double weight = 0.5 * corners[t].cotangent[other];
      stencil.laplacian[slot(corner)] += weight;
      stencil.laplacian[0] -= weight;
    }
  // Where very obtuse triangles leave next to no cell, or a negative one.
  stencil.cell = stencil.weight = std::max(stencil.cell, smallest_cell * thirds);
  return stencil;
}

std::vector<Stencil> make_stencils(const Scene& scene) {
  std::vector<Corners> corners(scene.rest_triangle.size());
  std::transform(scene.rest_triangle.begin(), scene.rest_triangle.end(), corners.begin(), corners_of);
  std::vector<Stencil> stencils;
  std::vector<char> interior(scene.surface.vertex_count, 0);
  for (const Cloth& cloth : scene.cloths) {
    if (cloth.material.bending_model != BendingModel::curvature || !(cloth.material.bending > 0)) continue;
    for (int v = cloth.first_vertex; v < cloth.first_vertex + cloth.vertex_count; ++v) {
      Stencil stencil = make_stencil(scene, corners, v, cloth.material.bending);
      if (stencil.nodes.empty() || !(stencil.cell > 0)) continue;
      interior[v] = 1;
      stencils.push_back(std::move(stencil));
    }
  }
  if (stencils.empty()) return stencils;
  std::vector<int> centres;
  for (const Stencil& stencil : stencils) centres.push_back(stencil.nodes[0]);
  const std::vector<int> nearest = nearest_along_edges(scene, centres);
  for (int t = 0; t < scene.surface.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = scene.surface.triangles(t, k);
      if (!interior[v] && nearest[v] >= 0) stencils[nearest[v]].weight += corners[t].voronoi[k];
    }
  return stencils;
}

Vec3 laplacian_of(const CurvedVertex& vertex, const Points& x) {
  const Vec3 centre = row(x, vertex.nodes[0]);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i < vertex.nodes.size(); ++i) sum += vertex.laplacian[i] * (row(x, vertex.nodes[i]) - centre);
  return sum;
}

// Twice the vector area of the ring.
Vec3 ring_normal(const CurvedVertex& vertex, const Points& x) {
  const Vec3 centre = row(x, vertex.nodes[0]);
  Vec3 sum = Vec3::Zero(), previous = row(x, vertex.nodes.back()) - centre;
  for (std::size_t i = 1; i < vertex.nodes.size(); ++i) {
    const Vec3 next = row(x, vertex.nodes[i]) - centre;
    sum += previous.cross(next);
    previous = next;
  }
  return sum;
}

// Adds stiffness |weights . x|^2 / 2.
void add_square(const std::vector<int>& nodes, const std::vector<double>& weights, double stiffness,
                std::vector<Eigen::Triplet<double>>& entries) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j)
      entries.emplace_back(nodes[i], nodes[j], stiffness * (weights[i] * weights[j]));
}

// Of the misfit, over the plate's. Too small leaves unstructured sheets soft, by 1.4 % at 10 with 60 elements along a
// clamped strip; too large makes coarse ones stiff where curvature changes fast, by 5 % at 200 with 30.
constexpr double misfit_stiffness = 60;

void add_flat(const Scene& scene, std::vector<Eigen::Triplet<double>>& entries) {
  for (const QuadricStencil& stencil : quadric_stencils(scene)) {
    const Material& material = scene.cloths[stencil.cloth].material;
    const double nu = bending_poisson(material);
    const Eigen::MatrixXd local =
        material.bending * stencil.area *
        (0.5 * (1 + nu) * stencil.trace.transpose() * stencil.trace + 2 * (1 - nu) * stencil.a.transpose() * stencil.a +
         2 * (1 - nu) * stencil.b.transpose() * stencil.b +
         misfit_stiffness * stencil.misfit.transpose() * stencil.misfit);
    for (Eigen::Index i = 0; i < local.rows(); ++i)  // rounding leaves the two triangles different
      for (Eigen::Index j = 0; j < local.rows(); ++j)
        entries.emplace_back(stencil.nodes[static_cast<std::size_t>(i)], stencil.nodes[static_cast<std::size_t>(j)],
                             local(std::max(i, j), std::min(i, j)));
  }
}

// Adds the elements of a scene with curved rest shapes. Flat vertices keep the constant form.
void add_curved(const Scene& scene, CurvatureBending& bending, std::vector<Eigen::Triplet<double>>& entries) {
  // A rest curvature below this angle per vertex is rounding in the input and counts as flat.
  constexpr double flat_angle = 1e-5;
  for (Stencil& stencil : make_stencils(scene)) {
    const double weight = std::max(stencil.weight, stencil.cell);  // a boundary cell can be negative
    const double stiffness = stencil.bending * weight / (stencil.cell * stencil.cell);
    CurvedVertex vertex{stencil.nodes, stencil.laplacian, stiffness, 0};
    const Vec3 curvature = laplacian_of(vertex, scene.rest);
    if (curvature.norm() > flat_angle * std::sqrt(stencil.cell)) {
      vertex.rest = curvature.dot(ring_normal(vertex, scene.rest).normalized());
      bending.curved.push_back(std::move(vertex));
    } else {
      add_square(stencil.nodes, stencil.laplacian, stiffness, entries);
    }
  }
}

}  // namespace

double bending_poisson(const Material& material) {
  const double sum = material.lame_lambda + 2 * material.lame_mu;
  return material.membrane == MembraneModel::baraff_witkin || !(sum > 0) ? 0 : material.lame_lambda / sum;
}

CurvatureBending curvature_bending(const Scene& scene) {
  CurvatureBending bending;
  std::vector<Eigen::Triplet<double>> entries;
  if (scene.rest_is_flat)
    add_flat(scene, entries);
  else
    add_curved(scene, bending, entries);
  bending.flat.resize(scene.surface.vertex_count, scene.surface.vertex_count);
  bending.flat.setFromTriplets(entries.begin(), entries.end());
  return bending;
}

double curved_energy(const CurvedVertex& vertex, const Points& x) {
  const double difference = laplacian_of(vertex, x).dot(ring_normal(vertex, x).normalized()) - vertex.rest;
  return 0.5 * vertex.stiffness * difference * difference;
}

double curved_derivatives(const CurvedVertex& vertex, const Points& x, Eigen::VectorXd& gradient,
                          Eigen::MatrixXd* hessian) {
  const int count = static_cast<int>(vertex.nodes.size()), ring = count - 1;
  const Vec3 curvature = laplacian_of(vertex, x), area_vector = ring_normal(vertex, x);
  const double length = area_vector.norm(), inverse = length > 0 ? 1 / length : 0;
  const Vec3 normal = inverse * area_vector;
  const double difference = curvature.dot(normal) - vertex.rest;
  const Vec3 tangential = inverse * (curvature - curvature.dot(normal) * normal);
  // d((L x) . n) = n . L dx + tangential . dN. A ring vertex moves N by dx x (next - previous); the centre does not.
  gradient.resize(3 * count);
  gradient.head<3>() = vertex.laplacian[0] * normal;
  for (int i = 0; i < ring; ++i) {
    const Vec3 across = row(x, vertex.nodes[1 + (i + 1) % ring]) - row(x, vertex.nodes[1 + (i + ring - 1) % ring]);
    gradient.segment<3>(3 * i + 3) = vertex.laplacian[i + 1] * normal + across.cross(tangential);
  }
  if (hessian) *hessian = vertex.stiffness * gradient * gradient.transpose();
  gradient *= vertex.stiffness * difference;
  return 0.5 * vertex.stiffness * difference * difference;
}

}  // namespace selvedge
