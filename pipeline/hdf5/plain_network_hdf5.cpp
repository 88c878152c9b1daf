#include "pipeline/hdf5/plain_network_hdf5.hpp"

namespace selvedge {
namespace {

constexpr int most_width = 1 << 20;
constexpr double most_steps = 1e15;  // most training steps

}  // namespace

void write_floats(const h5::File& file, const std::string& name, const std::vector<float>& values) {
  file.write_constant(name, H5T_NATIVE_FLOAT, {static_cast<hsize_t>(values.size())}, values.data());
}

std::vector<float> read_floats(const h5::Fields& fields, const std::string& name) {
  const std::vector<double> values = fields.numbers(name);
  return {values.begin(), values.end()};
}

void write_plain_network(const h5::File& file, const std::string& group, const PlainNetwork& network) {
  const h5::Handle made = file.make_group(group);
  std::vector<int> sizes{network.inputs()};
  for (const AffineLayer& layer : network.layers) sizes.push_back(static_cast<int>(layer.bias.size()));
  h5::write_integers(file, group + "/sizes", sizes);
  h5::write_integers(file, group + "/form",
                     {network.bend == Bend::softplus ? 1 : 0, network.again_layer, network.again_columns});
  h5::write_numbers(file, group + "/beta", {network.beta});
  write_floats(file, group + "/parameters", parameters_of(network));
}

PlainNetwork read_plain_network(const h5::Fields& fields, const std::string& group) {
  const std::vector<int> sizes = fields.integers(group + "/sizes"), form = fields.integers(group + "/form");
  const std::vector<double> beta = fields.numbers(group + "/beta");
  const std::vector<float> parameters = read_floats(fields, group + "/parameters");
  if (sizes.size() < 2 || form.size() != 3 || beta.size() != 1) fields.fail(group, "is no network");
  for (const int size : sizes)
    if (size < 1 || size > most_width) fields.fail(group + "/sizes", "has a layer without numbers, or of too many");
  PlainShape shape{
      sizes[0], {sizes.begin() + 1, sizes.end()}, form[0] == 1 ? Bend::softplus : Bend::rectified, beta[0], form[1],
      form[2]};
  const auto layers = static_cast<int>(shape.outputs.size());
  if (form[1] >= layers || form[2] < 0 || form[2] > sizes[0] || !(beta[0] > 0))
    fields.fail(group + "/form", "does not fit the sizes");
  double count = 0;
  for (int l = 0; l < layers; ++l)
    count += (1.0 + sizes[l] + (l == form[1] ? form[2] : 0)) * sizes[static_cast<std::size_t>(l) + 1];
  if (count != static_cast<double>(parameters.size())) fields.fail(group + "/parameters", "has another length");
  PlainNetwork network = make_plain_network(shape, 1);
  set_parameters(parameters, network);
  return network;
}

void write_plain_adam(const h5::File& file, const std::string& group, const PlainAdam& adam) {
  const h5::Handle made = file.make_group(group);
  h5::write_numbers(file, group + "/steps", {static_cast<double>(adam.steps)});
  if (adam.first.empty()) return;
  write_floats(file, group + "/first", adam.first);
  write_floats(file, group + "/second", adam.second);
}

PlainAdam read_plain_adam(const h5::Fields& fields, const std::string& group, long long parameters) {
  PlainAdam adam;
  const std::vector<double> steps = fields.numbers(group + "/steps");
  if (steps.size() != 1 || !(steps[0] >= 0 && steps[0] <= most_steps))
    fields.fail(group + "/steps", "is no count of steps");
  adam.steps = static_cast<long long>(steps[0]);
  if (!fields.has(group + "/first")) return adam;
  adam.first = read_floats(fields, group + "/first");
  adam.second = read_floats(fields, group + "/second");
  if (std::ssize(adam.first) != parameters || std::ssize(adam.second) != parameters)
    fields.fail(group, "has moments of another number of parameters");
  return adam;
}

}  // namespace selvedge
