#include "pipeline/weights/weights_info.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/numbers_json.hpp"

namespace selvedge {
namespace {

using StatisticsColumns = std::vector<std::pair<std::string, int>>;

StatisticsColumns statistics_columns(const Architecture& a) {
  StatisticsColumns present;
  const auto add = [&present](const char* name, int columns) {
    if (columns > 0) present.emplace_back(name, columns);
  };
  visit_statistics(add, a.statistics);
  return present;
}

std::string integration_name(Integration integration) {
  return integration == Integration::relaxation_frame ? "relaxation_frame" : "start_flag";
}

// Successive steps with the same edges count as one line.
std::vector<std::pair<int, MessageStep>> grouped_steps(const Architecture& a) {
  std::vector<std::pair<int, MessageStep>> groups;
  for (const MessageStep& step : a.steps)
    if (!groups.empty() && groups.back().second.edge_keys == step.edge_keys)
      ++groups.back().first;
    else
      groups.emplace_back(1, step);
  return groups;
}

}  // namespace

WeightsInfo weights_info(const WeightFile& file) {
  WeightsInfo info{file, parameter_count(file.architecture), 0, 0};
  NetworkWeights& copy = info.file.weights;  // weight_arrays returns writable pointers
  for (const WeightArray& array : weight_arrays(file.architecture, copy))
    for (std::ptrdiff_t k = 0; k < std::ptrdiff_t{array.rows} * array.columns; ++k) {
      if (!std::isfinite(array.data[k])) ++info.nonfinite;
      if (array.name.ends_with("/deviation") && array.data[k] <= 1e-8f) ++info.constant_columns;
    }
  copy = {};
  return info;
}

std::string weights_info_text(const WeightsInfo& info) {
  const Architecture& a = info.file.architecture;
  LabelLines add{20};
  add("network", a.name);
  add("parameters", fmt::format("{}", info.parameters));
  add("width", fmt::format("{}, {} hidden layers", a.width, a.hidden_layers));
  add("node inputs", fmt::format("{}", a.node_inputs));
  for (const EdgeEncoder& encoder : a.encoders)
    add("edge encoder", fmt::format("{}, {} inputs", encoder.name, encoder.inputs));
  for (const auto& [count, step] : grouped_steps(a))
    add("steps", fmt::format("{} of {}", count, fmt::join(step.edge_keys, ", ")));
  for (const auto& [name, columns] : statistics_columns(a))
    add("statistics", fmt::format("{}, {} columns", name, columns));
  add("integration", fmt::format("{}, {} passes a frame, output added to {}", integration_name(a.integration), a.passes,
                                 a.features.base == OutputBase::carried ? "the carried guess" : "the motion before"));
  add("constant columns", fmt::format("{}", info.constant_columns));
  add("not finite", fmt::format("{}", info.nonfinite));
  for (const auto& [name, value] : info.file.origin) add(name, value);
  if (!info.file.training.empty()) add("training", info.file.training);
  add("written by", "selvedge " + info.file.version);
  return add.text;
}

std::string weights_info_json(const WeightsInfo& info) {
  const Architecture& a = info.file.architecture;
  Json encoders = Json::array(), steps = Json::array(), statistics = Json::object(), origin = Json::object();
  for (const EdgeEncoder& encoder : a.encoders)
    encoders.push_back({{"name", encoder.name}, {"inputs", encoder.inputs}});
  for (const MessageStep& step : a.steps) steps.push_back(step.edge_keys);
  for (const auto& [name, columns] : statistics_columns(a)) statistics[name] = columns;
  for (const auto& [name, value] : info.file.origin) origin[name] = value;
  const Json json = {{"network", a.name},
                     {"parameters", info.parameters},
                     {"width", a.width},
                     {"hidden_layers", a.hidden_layers},
                     {"node_inputs", a.node_inputs},
                     {"edge_encoders", encoders},
                     {"steps", steps},
                     {"statistics", statistics},
                     {"integration", integration_name(a.integration)},
                     {"base", a.features.base == OutputBase::carried ? "carried" : "motion"},
                     {"passes", a.passes},
                     {"constant_columns", info.constant_columns},
                     {"nonfinite", info.nonfinite},
                     {"origin", origin},
                     {"training", info.file.training},
                     {"version", info.file.version}};
  return json_text(json);
}

}  // namespace selvedge
