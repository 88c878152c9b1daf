#include "pipeline/measures/fit.hpp"

#include <algorithm>
#include <cmath>

#include "physics/energies/measures.hpp"
#include "physics/solve/assembly.hpp"
#include "pipeline/measures/fit_girth.hpp"
#include "pipeline/measures/motion_measures.hpp"

namespace selvedge {
namespace {

constexpr int girths_a_region = 7;
constexpr double high_part = 0.99;  // percentile of the high values

// Measures of each vertex and triangle of the cloth.
struct FitField {
  std::vector<int> region;  // of the nearest point of the body, by vertex
  std::vector<char> touches;
  Eigen::VectorXd areas;    // as worn [m2]
  Eigen::VectorXd push;     // force on the skin along its normal, if touched [N]
  Eigen::VectorXd strains;  // largest principal strain, by triangle
};

// The part of one cloth in one region.
struct FitPart {
  std::vector<int> vertices, triangles;
};

// The region of most corners of a triangle; of three different ones that of the first corner.
int region_of_triangle(const Triangles& triangles, int t, const std::vector<int>& of_vertex) {
  const int a = of_vertex[triangles(t, 0)], b = of_vertex[triangles(t, 1)], c = of_vertex[triangles(t, 2)];
  return b == c ? b : a;
}

Eigen::VectorXd vertex_areas(const Triangles& triangles, const Points& x) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(x.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = row(x, triangles(t, 0));
    const double third = (row(x, triangles(t, 1)) - a).cross(row(x, triangles(t, 2)) - a).norm() / 6;
    for (int k = 0; k < 3; ++k) areas[triangles(t, k)] += third;
  }
  return areas;
}

// The contact force on each vertex in equilibrium [N].
Points forces_of_contact(const Scene& scene, const Points& x, const Vec3& gravity) {
  AssemblyScratch scratch;
  Points gradient;
  elastic_derivatives(make_elastic(scene), x, scratch, &gradient, nullptr);
  return gradient - lumped_masses(scene) * gravity.transpose();
}

// Area-weighted means over a vertex and its neighbours, since forces of single vertices vary with the mesh.
Eigen::VectorXd ring_means(const Surface& surface, const Eigen::VectorXd& forces, const Eigen::VectorXd& areas) {
  Eigen::VectorXd sum = forces, area = areas;
  for (Eigen::Index e = 0; e < surface.edges.rows(); ++e)
    for (int k = 0; k < 2; ++k) {
      sum[surface.edges(e, k)] += forces[surface.edges(e, 1 - k)];
      area[surface.edges(e, k)] += areas[surface.edges(e, 1 - k)];
    }
  return (area.array() > 0).select(sum.array() / area.array(), 0.0).max(0.0);
}

// Mean and least difference of girths over planes across a region.
void add_ease(const Scene& scene, const Cloth& cloth, const Points& x, const Surface& body, const Points& body_x,
              const std::vector<int>& body_part, const Vec3& axis, FitRow& found) {
  double low = INFINITY, high = -INFINITY;
  for (const int t : body_part)
    for (int k = 0; k < 3; ++k) {
      const double height = axis.dot(row(body_x, body.triangles(t, k)));
      low = std::min(low, height);
      high = std::max(high, height);
    }
  double sum = 0, least = INFINITY;
  int count = 0;
  for (int k = 0; k < girths_a_region && low < high; ++k) {
    const CutPlane plane{axis, low + (high - low) * (k + 0.5) / girths_a_region};
    const auto middle = section_middle(body, body_part, body_x, plane);
    if (!middle) continue;
    const auto skin = body_girth(body, body_x, plane, *middle), worn = girth_at_rest(scene, cloth, x, plane, *middle);
    if (!skin || !worn) continue;
    sum += *worn - *skin;
    least = std::min(least, *worn - *skin);
    ++count;
  }
  if (count == 0) return;
  found.ease = sum / count;
  found.least_ease = least;
}

FitPart part_of(const Scene& scene, const Cloth& cloth, const std::vector<int>& region, int which) {
  FitPart part;
  for (int v = cloth.first_vertex; v < cloth.first_vertex + cloth.vertex_count; ++v)
    if (region[v] == which) part.vertices.push_back(v);
  for (int t = cloth.first_triangle; t < cloth.first_triangle + cloth.triangle_count; ++t)
    if (region_of_triangle(scene.surface.triangles, t, region) == which) part.triangles.push_back(t);
  return part;
}

// Measures all vertices and triangles; also sets the gap of each vertex.
FitField field_of(const Scene& scene, const Points& x, const Vec3& gravity, const DistanceField& body,
                  const std::vector<int>& region_of_body, double reach, Eigen::VectorXd& gap) {
  const std::vector<SignedDistance> distances = body.ask(x);
  const Points forces = forces_of_contact(scene, x, gravity);
  FitField field;
  field.areas = vertex_areas(scene.surface.triangles, x);
  field.push = Eigen::VectorXd::Zero(x.rows());
  gap.resize(x.rows());
  for (int v = 0; v < x.rows(); ++v) {
    const SignedDistance& distance = distances[v];
    field.region.push_back(region_of_triangle(body.surface().triangles, distance.triangle, region_of_body));
    field.touches.push_back(distance.value < reach && !std::ranges::binary_search(scene.pins, v));
    if (field.touches.back()) field.push[v] = row(forces, v).dot(distance.gradient);
    gap[v] = distance.value;
  }
  field.strains = principal_stretches(scene, x).col(1).array() - 1;
  return field;
}

// Adds values by vertex: the largest strain of its triangles, and the averaged pressure.
void add_maps(const Scene& scene, const FitField& field, FitMeasures& found) {
  const Triangles& triangles = scene.surface.triangles;
  found.strain = Eigen::VectorXd::Zero(field.areas.size());
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      found.strain[triangles(t, k)] = std::max(found.strain[triangles(t, k)], field.strains[t]);
  Eigen::VectorXd touched = field.areas;
  for (int v = 0; v < touched.size(); ++v)
    if (!field.touches[v]) touched[v] = 0;
  found.pressure = (touched.array() > 0).select(ring_means(scene.surface, field.push, touched), 0.0);
}

FitRow row_of(const Scene& scene, const FitField& field, const FitPart& part, const FitMeasures& found) {
  FitRow line;
  line.vertices = static_cast<int>(part.vertices.size());
  double rest_area = 0, contact_area = 0, force = 0;
  std::vector<double> strains, pressures;
  for (const int t : part.triangles) {
    const double own = area(scene.rest_triangle[t]);
    rest_area += own;
    line.strain += own * field.strains[t];
    strains.push_back(field.strains[t]);
  }
  if (rest_area > 0) line.strain /= rest_area;
  line.strain_99 = percentile(strains, high_part);
  for (const int v : part.vertices) {
    line.area += field.areas[v];
    line.gap += found.gap[v] / line.vertices;
    if (!field.touches[v]) continue;
    contact_area += field.areas[v];
    force += field.push[v];
    pressures.push_back(found.pressure[v]);
  }
  line.contact = static_cast<double>(pressures.size()) / line.vertices;
  if (contact_area > 0) {
    line.pressure = std::max(0.0, force / contact_area);
    line.pressure_99 = percentile(pressures, high_part);
  }
  return line;
}

}  // namespace

FitMeasures measure_fit(const Scene& scene, const Points& x, const Vec3& gravity, const Surface& body,
                        const Points& body_x, const FitRegions& regions, double reach) {
  DistanceField distance(body);
  distance.move_to(body_x);
  FitMeasures found;
  const FitField field = field_of(scene, x, gravity, distance, regions.of_vertex, reach, found.gap);
  add_maps(scene, field, found);
  std::vector<std::vector<int>> body_parts(regions.regions.size());
  for (int t = 0; t < body.triangles.rows(); ++t)
    if (const int r = region_of_triangle(body.triangles, t, regions.of_vertex); r >= 0) body_parts[r].push_back(t);
  found.row.assign(field.region.size(), -1);
  for (std::size_t r = 0; r < body_parts.size(); ++r)
    for (const Cloth& cloth : scene.cloths) {
      const FitPart part = part_of(scene, cloth, field.region, static_cast<int>(r));
      if (part.vertices.empty() || part.triangles.empty()) continue;
      for (const int v : part.vertices) found.row[v] = static_cast<int>(found.rows.size());
      FitRow line = row_of(scene, field, part, found);
      line.region = regions.regions[r].name;
      line.cloth = cloth.name;
      add_ease(scene, cloth, x, body, body_x, body_parts[r], regions.regions[r].axis, line);
      found.rows.push_back(line);
    }
  return found;
}

}  // namespace selvedge
