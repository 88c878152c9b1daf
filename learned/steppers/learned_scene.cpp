#include "learned/steppers/learned_scene.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

constexpr double published_thickness = 4.7e-4;  // [m]
constexpr double hinge_per_curvature = 4;

// A range of materials in training.
struct TrainedRange {
  const char* quantity;
  const char* unit;
  double low, high;
  bool logarithmic;
};
constexpr TrainedRange trained_bending{"bending (as hinge coefficient)", "N m", 6.3708e-8, 1.31397e-3, true};
constexpr TrainedRange trained_mu{"mu", "N/m", 15909 * published_thickness, 63636 * published_thickness, true};
constexpr TrainedRange trained_lambda{"lambda", "N/m", 3535.41 * published_thickness, 93333.74 * published_thickness,
                                      false};
constexpr TrainedRange trained_density{"density", "kg/m2", 0.0434, 0.7, false};

// The place of the value between the ends, 0 to 1. A value outside adds a sentence.
float input_of(const TrainedRange& range, double value, const std::string& cloth, std::vector<std::string>& clamped) {
  const double counted = std::isfinite(value) ? std::clamp(value, range.low, range.high) : range.low;
  if (counted != value) {
    std::ostringstream text;
    text << cloth << ": " << range.quantity << " " << value << " " << range.unit << " counts as " << counted;
    clamped.push_back(text.str());
  }
  const auto scaled = [&](double v) { return range.logarithmic ? std::log(v) : v; };
  return static_cast<float>((scaled(counted) - scaled(range.low)) / (scaled(range.high) - scaled(range.low)));
}

Eigen::RowVector3f material_numbers(const VertexMaterial& m, const std::string& cloth,
                                    std::vector<std::string>& clamped) {
  return {input_of(trained_bending, m.bending, cloth, clamped), input_of(trained_mu, m.lame_mu, cloth, clamped),
          input_of(trained_lambda, m.lame_lambda, cloth, clamped)};
}

Eigen::RowVector3f material_row(const Cloth& cloth, std::vector<std::string>& clamped) {
  const VertexMaterial m = vertex_material(cloth.material);
  const Eigen::RowVector3f numbers = material_numbers(m, cloth.name, clamped);
  if (m.density < trained_density.low || m.density > trained_density.high) {
    std::ostringstream text;
    text << cloth.name << ": density " << m.density << " kg/m2 is outside of " << trained_density.low << " to "
         << trained_density.high << " and stays as it is";
    clamped.push_back(text.str());
  }
  return numbers;
}

Surface joined_surface(const std::vector<Obstacle>& obstacles) {
  int vertices = 0;
  Eigen::Index triangles = 0;
  for (const Obstacle& obstacle : obstacles) triangles += obstacle.surface.triangles.rows();
  Triangles all(triangles, 3);
  triangles = 0;
  for (const Obstacle& obstacle : obstacles) {
    const Triangles& own = obstacle.surface.triangles;
    all.middleRows(triangles, own.rows()) = own.array() + vertices;
    triangles += own.rows();
    vertices += obstacle.surface.vertex_count;
  }
  return make_surface(vertices, all);
}

}  // namespace

LearnedScene learned_scene(const Scene& scene, const std::vector<int>& omitted_body_vertices) {
  LearnedScene result;
  GraphScene& graph = result.graph;
  const int vertices = scene.surface.vertex_count;
  graph.cloth = scene.surface;
  graph.rest = scene.rest;
  const Eigen::VectorXd mass = lumped_masses(scene);
  graph.mass.assign(mass.begin(), mass.end());
  graph.types.assign(static_cast<std::size_t>(vertices), free_vertex);
  for (const int pin : scene.pins) graph.types[static_cast<std::size_t>(pin)] = pinned_vertex;
  graph.materials = FeatureRows::Zero(vertices, 3);
  for (const Cloth& cloth : scene.cloths)
    graph.materials.middleRows(cloth.first_vertex, cloth.vertex_count).rowwise() = material_row(cloth, result.clamped);
  graph.springs = scene.springs;
  graph.body = joined_surface(scene.obstacles);
  graph.body_types.assign(static_cast<std::size_t>(graph.body.vertex_count), body_vertex);
  for (const int vertex : omitted_body_vertices) {
    if (vertex < 0 || vertex >= result.graph.body.vertex_count)
      throw Error("the obstacles have no vertex " + std::to_string(vertex), "omitted vertices of a learned stepper",
                  "");
    result.graph.body_types[static_cast<std::size_t>(vertex)] = omitted_body_vertex;
  }
  return result;
}

FeatureRows material_inputs(std::span<const VertexMaterial> materials) {
  FeatureRows rows(static_cast<Eigen::Index>(materials.size()), 3);
  std::vector<std::string> clamped;
  for (std::size_t v = 0; v < materials.size(); ++v)
    rows.row(static_cast<Eigen::Index>(v)).head<3>() = material_numbers(materials[v], "", clamped);
  return rows;
}

VertexMaterial vertex_material(const Material& m) {
  const bool woven = m.membrane == MembraneModel::baraff_witkin;
  return {m.density, woven ? (m.warp + m.weft) / 4 : m.lame_mu, woven ? 0 : m.lame_lambda,
          (m.bending_model == BendingModel::hinge ? 1 : hinge_per_curvature) * m.bending};
}

Material isotropic_material(const VertexMaterial& values) {
  Material material;
  material.density = values.density;
  material.lame_mu = values.lame_mu;
  material.lame_lambda = values.lame_lambda;
  material.bending_model = BendingModel::hinge;
  material.bending = values.bending;
  return material;
}

LossGarment loss_garment(const Scene& scene) {
  std::vector<char> pinned(static_cast<std::size_t>(scene.surface.vertex_count), 0);
  for (const int pin : scene.pins) pinned[static_cast<std::size_t>(pin)] = 1;
  std::vector<VertexMaterial> materials(pinned.size());
  for (const Cloth& cloth : scene.cloths)
    std::fill_n(materials.begin() + cloth.first_vertex, cloth.vertex_count, vertex_material(cloth.material));
  LossGarment garment = make_loss_garment(scene.surface, scene.rest, pinned, VertexMaterial{});
  set_materials(garment, materials);
  return garment;
}

void check_runnable(const Architecture& architecture) {
  const FeatureOptions& options = architecture.features;
  const auto inputs_of = [&](const std::string& key) {
    if (key == "mesh_edge" || key == "space_edge" || key.starts_with("coarse_edge"))
      return mesh_edge_widths(options).all;
    return key == options.body_key ? body_edge_widths(options).all : cloth_edge_widths(options).all;
  };
  bool fits = node_widths(options).all == architecture.node_inputs && architecture.outputs == 3 &&
              (architecture.passes == 1 || options.pass_inputs);
  for (const std::string& key : edge_set_keys(options)) {
    fits = fits && edge_kind(architecture, key) >= 0 &&
           architecture.encoders[static_cast<std::size_t>(encoder_of(architecture, key))].inputs == inputs_of(key);
  }
  if (!fits)
    throw Error("the network `" + architecture.name + "` has inputs that the learned stepper does not make",
                "weights of a learned stepper",
                "give weights of HOOD or ContourCraft, or of a network trained by this program");
}

}  // namespace selvedge
