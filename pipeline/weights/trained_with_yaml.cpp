#include "pipeline/weights/trained_with_yaml.hpp"

#include <yaml-cpp/yaml.h>

namespace selvedge {
namespace {

std::optional<VertexMaterial> material_of(const YAML::Node& samples) {
  const auto sampled = samples["sample_materials"].as<std::string>("none");
  if (sampled != "none" && sampled != "false") return {};  // `false`: written by earlier versions
  const YAML::Node m = samples["material"];
  if (!m) return {};
  return VertexMaterial{m["density"].as<double>(), m["lame_mu"].as<double>(), m["lame_lambda"].as<double>(),
                        m["hinge_bending"].as<double>()};
}

}  // namespace

TrainedWith trained_with(const std::string& training) {
  try {
    const YAML::Node samples = YAML::Load(training)["samples"];
    if (!samples) return {};
    TrainedWith with{material_of(samples), {}};
    if (samples["edge"]) with.edge = samples["edge"].as<double>();
    return with;
  } catch (const YAML::Exception&) {
    return {};
  }
}

}  // namespace selvedge
