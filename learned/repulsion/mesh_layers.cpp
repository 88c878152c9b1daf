#include "learned/repulsion/mesh_layers.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/parallel.hpp"

namespace selvedge {
namespace {

constexpr int targets_at_once = 64;

// Sets the sources of each target, ascending.
void set_sources(const std::vector<std::vector<int>>& sources, MeshLayer& layer) {
  layer.begin = {0};
  for (const std::vector<int>& own : sources) {
    layer.source.insert(layer.source.end(), own.begin(), own.end());
    layer.begin.push_back(static_cast<int>(layer.source.size()));
  }
}

// The sources of a fine vertex one level up: its own coarse vertex and those of its neighbours.
std::vector<std::vector<int>> sources_above(const Adjacency& ring, const std::vector<int>& coarse_of) {
  std::vector<std::vector<int>> sources(coarse_of.size());
  for (int v = 0; v < ring.vertex_count(); ++v) {
    std::vector<int>& own = sources[static_cast<std::size_t>(v)];
    own.push_back(coarse_of[static_cast<std::size_t>(v)]);
    for (const int w : ring.of(v)) own.push_back(coarse_of[static_cast<std::size_t>(w)]);
    std::ranges::sort(own);
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
  return sources;
}

std::vector<std::vector<int>> sources_beside(const Adjacency& ring) {
  std::vector<std::vector<int>> sources(static_cast<std::size_t>(ring.vertex_count()));
  for (int v = 0; v < ring.vertex_count(); ++v) {
    std::vector<int>& own = sources[static_cast<std::size_t>(v)];
    own.assign(ring.of(v).begin(), ring.of(v).end());
    own.insert(std::ranges::upper_bound(own, v), v);
  }
  return sources;
}

// Mixtures begin at random, so that features keep their variance. Pooling begins as the mean.
void begin_layer(int channels_in, int channels_out, int kernels, std::uint64_t seed, MeshLayer& layer) {
  PlainShape shape;
  shape.inputs = channels_in;
  shape.outputs = {(kernels + 1) * channels_out};
  layer.kernels = make_plain_network(shape, seed);
  shape.inputs = kernels;
  shape.outputs = {static_cast<int>(layer.source.size())};
  layer.mix = make_plain_network(shape, seed + 1);
  AffineLayer& mix = layer.mix.layers[0];
  for (int i = 0; i < layer.targets(); ++i) {
    const int first = layer.begin[static_cast<std::size_t>(i)], end = layer.begin[static_cast<std::size_t>(i) + 1];
    const float share = 1 / static_cast<float>(end - first);
    mix.weight.middleRows(first, end - first) *= std::sqrt(share / 2);
    std::fill(mix.bias.begin() + first, mix.bias.begin() + end, share);
  }
}

// All cases, with one row per vertex.
FeatureRows rectified_vertices(const FeatureRows& cases, int channels) {
  return Eigen::Map<const FeatureRows>(cases.data(), cases.size() / channels, channels).cwiseMax(0.0f);
}

// The kernels' values of each source of each case.
FeatureRows kernel_values(const MeshLayer& layer, const FeatureRows& inputs) {
  return evaluate(layer.kernels, rectified_vertices(inputs, layer.channels_in()));
}

FeatureRows mixed(const MeshLayer& layer, const FeatureRows& values, Eigen::Index cases) {
  const int channels = layer.channels_out(), targets = layer.targets(), kernels = layer.mix.inputs();
  const AffineLayer& mix = layer.mix.layers[0];
  FeatureRows outputs = FeatureRows::Zero(cases, Eigen::Index{targets} * channels);
  parallel_for(static_cast<int>(cases) * targets, targets_at_once, [&](int n) {
    const int which = n / targets, i = n % targets;
    auto sum = outputs.row(which).segment(Eigen::Index{i} * channels, channels);
    for (int e = layer.begin[static_cast<std::size_t>(i)]; e < layer.begin[static_cast<std::size_t>(i) + 1]; ++e) {
      const auto value = values.row(Eigen::Index{which} * layer.sources + layer.source[static_cast<std::size_t>(e)]);
      for (int k = 0; k < kernels; ++k) sum += mix.weight(e, k) * value.segment(Eigen::Index{k} * channels, channels);
      sum += mix.bias[static_cast<std::size_t>(e)] * value.tail(channels);
    }
  });
  return outputs;
}

// Derivatives by the kernels' values. Each case has its own rows.
FeatureRows by_kernel_values(const MeshLayer& layer, const FeatureRows& by_outputs) {
  const int channels = layer.channels_out(), kernels = layer.mix.inputs();
  const AffineLayer& mix = layer.mix.layers[0];
  FeatureRows result = FeatureRows::Zero(by_outputs.rows() * layer.sources, layer.kernels.outputs());
  parallel_for(static_cast<int>(by_outputs.rows()), 1, [&](int which) {
    for (int i = 0; i < layer.targets(); ++i) {
      const auto by = by_outputs.row(which).segment(Eigen::Index{i} * channels, channels);
      for (int e = layer.begin[static_cast<std::size_t>(i)]; e < layer.begin[static_cast<std::size_t>(i) + 1]; ++e) {
        auto to = result.row(Eigen::Index{which} * layer.sources + layer.source[static_cast<std::size_t>(e)]);
        for (int k = 0; k < kernels; ++k) to.segment(Eigen::Index{k} * channels, channels) += mix.weight(e, k) * by;
        to.tail(channels) += mix.bias[static_cast<std::size_t>(e)] * by;
      }
    }
  });
  return result;
}

// Derivatives by the edges' coefficients, in the order of parameters_of. Each edge has one target.
std::vector<float> by_mix(const MeshLayer& layer, const FeatureRows& values, const FeatureRows& by_outputs) {
  const int channels = layer.channels_out(), kernels = layer.mix.inputs();
  const auto edges = static_cast<int>(layer.source.size());
  std::vector<float> result(static_cast<std::size_t>(parameter_count(layer.mix)), 0);
  Eigen::Map<FeatureRows> weight(result.data(), edges, kernels);
  Eigen::Map<Eigen::RowVectorXf> bias(result.data() + weight.size(), edges);
  parallel_for(layer.targets(), targets_at_once, [&](int i) {
    for (int e = layer.begin[static_cast<std::size_t>(i)]; e < layer.begin[static_cast<std::size_t>(i) + 1]; ++e)
      for (Eigen::Index which = 0; which < by_outputs.rows(); ++which) {
        const auto by = by_outputs.row(which).segment(Eigen::Index{i} * channels, channels);
        const auto value = values.row(which * layer.sources + layer.source[static_cast<std::size_t>(e)]);
        for (int k = 0; k < kernels; ++k) weight(e, k) += by.dot(value.segment(Eigen::Index{k} * channels, channels));
        bias(e) += by.dot(value.tail(channels));
      }
  });
  return result;
}

}  // namespace

PooledMesh pooled(const Adjacency& ring) {
  PooledMesh made;
  made.coarse_of.assign(static_cast<std::size_t>(ring.vertex_count()), -1);
  std::vector<char> beside_centre(made.coarse_of.size(), false);
  int count = 0;
  for (int v = 0; v < ring.vertex_count(); ++v) {
    if (beside_centre[static_cast<std::size_t>(v)]) continue;
    made.coarse_of[static_cast<std::size_t>(v)] = count;
    for (const int w : ring.of(v)) {
      beside_centre[static_cast<std::size_t>(w)] = true;
      if (made.coarse_of[static_cast<std::size_t>(w)] < 0) made.coarse_of[static_cast<std::size_t>(w)] = count;
    }
    ++count;
  }
  std::vector<std::pair<int, int>> pairs;
  for (int v = 0; v < ring.vertex_count(); ++v)
    for (const int w : ring.of(v)) {
      const int a = made.coarse_of[static_cast<std::size_t>(v)], b = made.coarse_of[static_cast<std::size_t>(w)];
      if (a < b) pairs.emplace_back(a, b);
    }
  made.ring = adjacency_of(count, unique_edges(pairs));
  return made;
}

std::vector<MeshLayer> make_mesh_layers(const Adjacency& ring, const MeshShape& shape, std::uint64_t seed) {
  const auto channels = [&](int level) { return shape.channels << std::min(level, 2); };
  std::vector<Adjacency> rings{ring};
  std::vector<std::vector<int>> coarse;
  for (int level = 0; level < shape.levels; ++level) {
    PooledMesh above = pooled(rings.back());
    coarse.push_back(std::move(above.coarse_of));
    rings.push_back(std::move(above.ring));
  }
  std::vector<MeshLayer> layers;
  for (int level = shape.levels; level-- > 0;) {
    MeshLayer up;
    up.sources = rings[static_cast<std::size_t>(level) + 1].vertex_count();
    set_sources(sources_above(rings[static_cast<std::size_t>(level)], coarse[static_cast<std::size_t>(level)]), up);
    begin_layer(channels(level + 1), channels(level), shape.kernels, seed + 2 * layers.size(), up);
    layers.push_back(std::move(up));
  }
  MeshLayer last;
  last.sources = ring.vertex_count();
  set_sources(sources_beside(ring), last);
  begin_layer(channels(0), 3, shape.kernels, seed + 2 * layers.size(), last);
  layers.push_back(std::move(last));
  return layers;
}

FeatureRows evaluate(std::span<const MeshLayer> layers, const FeatureRows& inputs) {
  FeatureRows at = inputs;
  for (const MeshLayer& layer : layers) at = mixed(layer, kernel_values(layer, at), at.rows());
  return at;
}

MeshGradients backward(std::span<const MeshLayer> layers, const FeatureRows& inputs, const FeatureRows& by_outputs) {
  std::vector<FeatureRows> read{inputs}, values;
  for (const MeshLayer& layer : layers) {
    values.push_back(kernel_values(layer, read.back()));
    read.push_back(mixed(layer, values.back(), inputs.rows()));
  }
  MeshGradients result;
  result.parts.resize(2 * layers.size());
  FeatureRows by = by_outputs;
  for (std::size_t l = layers.size(); l-- > 0;) {
    const MeshLayer& layer = layers[l];
    result.parts[2 * l + 1] = by_mix(layer, values[l], by);
    const FeatureRows vertices = rectified_vertices(read[l], layer.channels_in());
    PlainGradients own = backward(layer.kernels, vertices, {}, {by_kernel_values(layer, by), {}});
    result.parts[2 * l] = std::move(own.parameters);
    own.inputs = own.inputs.cwiseProduct(vertices.unaryExpr([](float h) { return h > 0 ? 1.0f : 0.0f; })).eval();
    by = Eigen::Map<const FeatureRows>(own.inputs.data(), read[l].rows(), read[l].cols());
  }
  result.inputs = by;
  return result;
}

}  // namespace selvedge
