#include <catch2/catch.hpp>

#include <random>

#include "learned/repulsion/mesh_layers.hpp"

namespace selvedge::test_mesh_layers {

namespace {

// A sheet of n x n vertices, of triangles.
Adjacency sheet(int n) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (j + 1 < n) pairs.emplace_back(n * i + j, n * i + j + 1);
      if (i + 1 < n) pairs.emplace_back(n * i + j, n * i + j + n);
      if (i + 1 < n && j + 1 < n) pairs.emplace_back(n * i + j, n * i + j + n + 1);
    }
  return adjacency_of(n * n, unique_edges(pairs));
}

FeatureRows drawn(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  FeatureRows made(rows, columns);
  for (float& value : made.reshaped()) value = static_cast<float>(static_cast<double>(random() >> 11) * 0x1p-52 - 1);
  return made;
}

double weighted_sum(std::span<const MeshLayer> layers, const FeatureRows& inputs, const FeatureRows& weights) {
  return evaluate(layers, inputs).cwiseProduct(weights).cast<double>().sum();
}

// Largest difference of gradients from central ones, relative to the largest component.
template <class Set>
double difference(std::vector<float> values, std::span<const float> gradient, const Set& loss_at) {
  double worst = 0, largest = 0;
  for (const float g : gradient) largest = std::max(largest, std::abs(static_cast<double>(g)));
  for (std::size_t k = 0; k < values.size(); k += std::max<std::size_t>(1, values.size() / 41)) {
    const float kept = values[k], step = 1e-3f;
    values[k] = kept + step;
    const double above = loss_at(values);
    values[k] = kept - step;
    const double below = loss_at(values);
    values[k] = kept;
    worst = std::max(worst, std::abs((above - below) / (2e-3) - static_cast<double>(gradient[k])));
  }
  return worst / largest;
}

}  // namespace

TEST_CASE("mesh layers: every fine vertex is a centre or beside its centre, and levels shrink", "[mesh_layers]") {
  const Adjacency ring = sheet(9);
  const PooledMesh above = pooled(ring);
  REQUIRE(above.ring.vertex_count() < 81 / 2);
  std::vector<int> members(static_cast<std::size_t>(above.ring.vertex_count()), 0);
  for (int v = 0; v < 81; ++v) {
    const int own = above.coarse_of[static_cast<std::size_t>(v)];
    REQUIRE((own >= 0 && own < above.ring.vertex_count()));
    ++members[static_cast<std::size_t>(own)];
    // Two fine neighbours lie in one coarse vertex or in adjacent ones.
    for (const int w : ring.of(v)) {
      const int other = above.coarse_of[static_cast<std::size_t>(w)];
      const auto around = above.ring.of(own);
      CHECK((other == own || std::ranges::find(around, other) != around.end()));
    }
  }
  for (const int count : members) CHECK((count >= 1 && count <= 7));
}

TEST_CASE("mesh layers: one edge with one kernel is that affine map of what is above zero", "[mesh_layers]") {
  std::vector<MeshLayer> layers = make_mesh_layers(sheet(2), {0, 2, 1}, 3);
  REQUIRE(layers.size() == 1);
  MeshLayer& layer = layers[0];
  AffineLayer &kernels = layer.kernels.layers[0], &mix = layer.mix.layers[0];
  mix.weight.setZero();
  std::ranges::fill(mix.bias, 0.0f);
  mix.weight(layer.begin[1] + 1, 0) = 2;  // vertex 1 reads itself: its sources are 0, 1, 3
  for (std::size_t k = 0; k < kernels.bias.size(); ++k) kernels.bias[k] = static_cast<float>(k);
  FeatureRows inputs(1, 8);
  inputs << 9, 9, 0.5f, -4, 9, 9, 9, 9;
  const FeatureRows outputs = evaluate(layers, inputs);
  for (int c = 0; c < 3; ++c) {
    CHECK(outputs(0, 3 + c) == Approx(2 * (0.5f * kernels.weight(c, 0) + static_cast<float>(c))));
    CHECK(outputs(0, c) == 0);
  }
}

TEST_CASE("mesh layers: gradients by differences, through three levels", "[mesh_layers]") {
  std::vector<MeshLayer> layers = make_mesh_layers(sheet(7), {2, 3, 4}, 11);
  REQUIRE(layers.size() == 3);
  const Eigen::Index read = layers[0].sources * layers[0].channels_in();
  const FeatureRows inputs = drawn(2, read, 1), weights = drawn(2, 3 * 49, 2);
  const MeshGradients made = backward(layers, inputs, weights);
  REQUIRE(made.parts.size() == 6);
  for (std::size_t l = 0; l < layers.size(); ++l)
    for (PlainNetwork* network : {&layers[l].kernels, &layers[l].mix}) {
      const std::vector<float> kept = parameters_of(*network);
      CAPTURE(l);
      const std::vector<float>& gradient = made.parts[2 * l + (network == &layers[l].mix ? 1 : 0)];
      REQUIRE(gradient.size() == kept.size());
      CHECK(difference(kept, gradient, [&](const std::vector<float>& values) {
              set_parameters(values, *network);
              return weighted_sum(layers, inputs, weights);
            }) < 3e-3);
      set_parameters(kept, *network);
    }
  const std::vector<float> at(inputs.data(), inputs.data() + inputs.size());
  CHECK(difference(at, {made.inputs.data(), static_cast<std::size_t>(made.inputs.size())},
                   [&](const std::vector<float>& values) {
                     return weighted_sum(layers, Eigen::Map<const FeatureRows>(values.data(), 2, read), weights);
                   }) < 3e-3);
}

}  // namespace selvedge::test_mesh_layers
