#include "learned/gradients/adam.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/geometry/error.hpp"
#include "learned/gradients/adam_rule.hpp"

namespace selvedge {
namespace {

constexpr float steps_base = 1 << 20;  // "adam/steps" is high * base + low, both exact in float

std::vector<WeightArray> trained_arrays(const Architecture& a, NetworkWeights& weights) {
  std::vector<WeightArray> arrays = weight_arrays(a, weights);
  std::erase_if(arrays, [](const WeightArray& array) { return !array.trained; });
  return arrays;
}

// The pointers of these arrays are only read.
std::vector<WeightArray> trained_arrays(const Architecture& a, const NetworkWeights& weights) {
  return trained_arrays(a, const_cast<NetworkWeights&>(weights));
}

std::ptrdiff_t size_of(const WeightArray& array) { return static_cast<std::ptrdiff_t>(array.rows) * array.columns; }

void check_same_shapes(const std::vector<WeightArray>& arrays, const std::vector<WeightArray>& others) {
  bool same = arrays.size() == others.size();
  for (std::size_t i = 0; same && i < arrays.size(); ++i)
    same =
        arrays[i].name == others[i].name && arrays[i].rows == others[i].rows && arrays[i].columns == others[i].columns;
  if (!same)
    throw Error("gradients, moments and weights have different shapes", "a step of Adam",
                "make all of them for one architecture");
}

// In double precision, with an order of summation that does not depend on threads.
double norm_of(const std::vector<WeightArray>& arrays) {
  std::vector<double> squares(arrays.size());
  const int count = static_cast<int>(arrays.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < count; ++i) {
    const WeightArray& array = arrays[static_cast<std::size_t>(i)];
    double sum[4] = {};
    const std::ptrdiff_t size = size_of(array);
    for (std::ptrdiff_t k = 0; k < size; ++k) {
      const auto value = static_cast<double>(array.data[k]);
      sum[k % 4] += value * value;
    }
    squares[static_cast<std::size_t>(i)] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
  double total = 0;
  for (const double square : squares) total += square;
  return std::sqrt(total);
}

double median_of(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

// The factor by which the gradient is clipped.
double clip_scale(const AdamOptions& options, double norm, const std::vector<float>& norms) {
  double most = options.clip_norm > 0 ? options.clip_norm : norm;
  if (options.clip_median > 0 && !norms.empty()) most = std::min(most, options.clip_median * median_of(norms));
  return norm > most ? most / norm : 1;
}

}  // namespace

AdamState start_adam(const Architecture& a) { return {0, zero_gradients(a), zero_gradients(a), {}}; }

AdamReport adam_step(const Architecture& a, const AdamOptions& options, const WeightGradients& gradients,
                     AdamState& state, NetworkWeights& weights) {
  const std::vector<WeightArray> g = trained_arrays(a, gradients), m = trained_arrays(a, state.first),
                                 v = trained_arrays(a, state.second), w = trained_arrays(a, weights);
  for (const std::vector<WeightArray>* others : {&g, &m, &v}) check_same_shapes(w, *others);
  AdamReport report;
  report.learning_rate = options.learning_rate;
  report.norm = norm_of(g);
  if (!std::isfinite(report.norm)) {
    report.taken = false;
    return report;
  }
  report.scale = clip_scale(options, report.norm, state.norms);
  state.norms.push_back(static_cast<float>(report.norm));
  if (state.norms.size() > median_window) state.norms.erase(state.norms.begin());
  const AdamNumbers numbers =
      adam_numbers(report.learning_rate, options.beta1, options.beta2, options.epsilon, ++state.steps, report.scale);
  const int count = static_cast<int>(w.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    take_adam_step(numbers, size_of(w[k]), g[k].data, m[k].data, v[k].data, w[k].data);
  }
  return report;
}

std::vector<NamedFloats> adam_arrays(const Architecture& a, const AdamState& state) {
  std::vector<NamedFloats> arrays;
  for (const auto& [prefix, moments] : {std::pair{"adam/first/", &state.first}, {"adam/second/", &state.second}})
    for (const WeightArray& array : trained_arrays(a, *moments))
      arrays.push_back({prefix + array.name, {array.data, array.data + size_of(array)}});
  const auto base = static_cast<long long>(steps_base);
  arrays.push_back({"adam/steps", {static_cast<float>(state.steps / base), static_cast<float>(state.steps % base)}});
  arrays.push_back({"adam/norms", state.norms});
  return arrays;
}

AdamState adam_from_arrays(const Architecture& a, const std::vector<NamedFloats>& arrays, const std::string& where) {
  const std::string cure = "does the checkpoint belong to this architecture?";
  std::map<std::string, const std::vector<float>*> left;
  for (const NamedFloats& array : arrays)
    if (!left.emplace(array.name, &array.values).second)
      throw Error("the array is stored twice", where + ": " + array.name, cure);
  const auto take = [&](const std::string& name) -> const std::vector<float>& {
    const auto found = left.find(name);
    if (found == left.end()) throw Error("the array is missing", where + ": " + name, cure);
    const std::vector<float>& values = *found->second;
    left.erase(found);
    return values;
  };
  AdamState state = start_adam(a);
  for (const auto& [prefix, moments] : {std::pair{"adam/first/", &state.first}, {"adam/second/", &state.second}})
    for (const WeightArray& array : trained_arrays(a, *moments)) {
      const std::vector<float>& values = take(prefix + array.name);
      if (static_cast<std::ptrdiff_t>(values.size()) != size_of(array))
        throw Error("the array has " + std::to_string(values.size()) + " numbers, the architecture asks for " +
                        std::to_string(size_of(array)),
                    where + ": " + prefix + array.name, cure);
      std::copy(values.begin(), values.end(), array.data);
    }
  const std::vector<float>& steps = take("adam/steps");
  const auto is_count = [](float x) { return x >= 0 && x < steps_base && x == std::floor(x); };
  if (steps.size() != 2 || !is_count(steps[0]) || !is_count(steps[1]))
    throw Error("the array holds no number of steps", where + ": adam/steps", cure);
  state.steps =
      static_cast<long long>(steps[0]) * static_cast<long long>(steps_base) + static_cast<long long>(steps[1]);
  state.norms = take("adam/norms");
  if (state.norms.size() > median_window ||
      !std::all_of(state.norms.begin(), state.norms.end(), [](float x) { return std::isfinite(x) && x >= 0; }))
    throw Error("the norms are negative, not finite or too many", where + ": adam/norms", cure);
  if (!left.empty()) throw Error("the architecture has no such array", where + ": " + left.begin()->first, cure);
  return state;
}

}  // namespace selvedge
