#include "pipeline/scene/network_warnings.hpp"

#include <fmt/format.h>

#include <span>

#include "learned/steppers/learned_scene.hpp"

namespace selvedge {
namespace {

constexpr double far_material = 3, far_edge = 1.5;

bool is_far(double here, double trained, double factor) {
  return trained > 0 && (here >= factor * trained || here * factor <= trained);
}

void compare(const std::string& cloth, const char* quantity, const char* unit, double here, double trained,
             std::vector<std::string>& sentences) {
  if (!is_far(here, trained, far_material)) return;
  sentences.push_back(
      fmt::format("cloth `{}`: {} is {:.3g} {}, and the network was trained with {:.3g} {}: expect wrong motion; give "
                  "`material: hood` or another stepper",
                  cloth, quantity, here, unit, trained, unit));
}

double edge_of(const Scene& scene, const Cloth& cloth) {
  return mean_edge_length(
      std::span(scene.rest_triangle)
          .subspan(static_cast<std::size_t>(cloth.first_triangle), static_cast<std::size_t>(cloth.triangle_count)));
}

void compare_edges(const Scene& scene, double trained, std::vector<std::string>& sentences) {
  for (const Cloth& cloth : scene.cloths)
    if (const double here = edge_of(scene, cloth); is_far(here, trained, far_edge))
      sentences.push_back(
          fmt::format("cloth `{}`: its edges are {:.3g} mm long in the mean, and the network was trained with {:.3g} "
                      "mm: expect wrong motion; give a mesh with such edges or another stepper",
                      cloth.name, 1e3 * here, 1e3 * trained));
}

// Compares gravity for networks that do not take it as input: all were trained with that of the earth.
void compare_gravity(const Vec3& here, std::vector<std::string>& sentences) {
  const Vec3 trained = {0, -9.81, 0};
  if ((here - trained).norm() > 1e-3 * trained.norm())
    sentences.push_back(
        fmt::format("gravity is [{:g}, {:g}, {:g}] m/s2, and the network knows [0, -9.81, 0] alone: expect wrong "
                    "motion; give a network with accelerations among its inputs (senc.h5) or another stepper",
                    here[0], here[1], here[2]));
}

long long nonfinite_numbers(const Architecture& architecture, NetworkWeights weights) {
  long long count = 0;
  for (const WeightArray& array : weight_arrays(architecture, weights))
    count +=
        (!Eigen::Map<const Eigen::ArrayXf>(array.data, Eigen::Index{array.rows} * array.columns).isFinite()).count();
  return count;
}

}  // namespace

std::vector<std::string> unlike_training(const Scene& scene, const TrainedWith& trained) {
  std::vector<std::string> sentences;
  if (trained.material)
    for (const Cloth& cloth : scene.cloths) {
      const VertexMaterial here = vertex_material(cloth.material);
      compare(cloth.name, "mu", "N/m", here.lame_mu, trained.material->lame_mu, sentences);
      compare(cloth.name, "density", "kg/m2", here.density, trained.material->density, sentences);
      compare(cloth.name, "bending (as hinge coefficient)", "N m", here.bending, trained.material->bending, sentences);
    }
  if (trained.edge) compare_edges(scene, *trained.edge, sentences);
  return sentences;
}

std::vector<std::string> network_warnings(const Scene& scene, const Vec3& gravity, const WeightFile& file,
                                          const std::string& name) {
  std::vector<std::string> sentences = unlike_training(scene, trained_with(file.training));
  if (!sees_accelerations(file.architecture.features)) compare_gravity(gravity, sentences);
  if (const long long count = nonfinite_numbers(file.architecture, file.weights); count > 0)
    sentences.push_back(
        fmt::format("{}: {} of the network's numbers are not finite, so that it can make no frame; "
                    "train or import it again",
                    name, count));
  return sentences;
}

}  // namespace selvedge
