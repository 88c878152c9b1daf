#include "pipeline/scene/trained_material_yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "learned/steppers/learned_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

constexpr double far_off = 3;

void compare(const std::string& cloth, const char* quantity, const char* unit, double here, double trained,
             std::vector<std::string>& sentences) {
  if (!(trained > 0) || (here < far_off * trained && here * far_off > trained)) return;
  sentences.push_back(
      fmt::format("cloth `{}`: {} is {:.3g} {}, and the network was trained with {:.3g} {}: expect wrong motion; give "
                  "`material: hood` or another stepper",
                  cloth, quantity, here, unit, trained, unit));
}

}  // namespace

std::optional<VertexMaterial> trained_material(const std::string& training) {
  try {
    const YAML::Node samples = YAML::Load(training)["samples"];
    if (!samples) return {};
    const auto sampled = samples["sample_materials"].as<std::string>("none");
    if (sampled != "none" && sampled != "false") return {};  // `false`: written by earlier versions
    const YAML::Node m = samples["material"];
    if (!m) return {};
    return VertexMaterial{m["density"].as<double>(), m["lame_mu"].as<double>(), m["lame_lambda"].as<double>(),
                          m["hinge_bending"].as<double>()};
  } catch (const YAML::Exception&) {
    return {};
  }
}

std::vector<std::string> unlike_training(const Scene& scene, const VertexMaterial& trained) {
  std::vector<std::string> sentences;
  for (const Cloth& cloth : scene.cloths) {
    const VertexMaterial here = vertex_material(cloth.material);
    compare(cloth.name, "mu", "N/m", here.lame_mu, trained.lame_mu, sentences);
    compare(cloth.name, "density", "kg/m2", here.density, trained.density, sentences);
    compare(cloth.name, "bending (as hinge coefficient)", "N m", here.bending, trained.bending, sentences);
  }
  return sentences;
}

std::vector<std::string> material_warnings(const Setup& setup) {
  if (setup.run.stepper != "learned" && setup.run.stepper != "hybrid") return {};
  const std::optional<VertexMaterial> trained = trained_material(read_learned_weights(setup).training);
  return trained ? unlike_training(setup.scene, *trained) : std::vector<std::string>{};
}

}  // namespace selvedge
