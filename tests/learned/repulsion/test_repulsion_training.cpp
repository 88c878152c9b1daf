#include <catch2/catch.hpp>

#include <limits>

#include "learned/repulsion/repulsion_training.hpp"
#include "tests/learned/repulsion/dressed_blob.hpp"

namespace selvedge::test_repulsion_training {

namespace {

struct LayerCase : fake::DressedBlob {
  Points truth;
  std::vector<float> inputs{0.4f, -0.3f, 0.8f};
  ScaleNetwork network;
  double most_beyond = std::numeric_limits<double>::infinity();

  explicit LayerCase(ScaleForm form) : DressedBlob(10, 8), truth(1.3 * garment.x) {
    ScaleShape shape{3, garment.surface.vertex_count, 64};
    shape.latent = 12;
    shape.unit = 0.1;
    shape.form = form;
    shape.range = ScaleRange::at_least_zero;
    network = make_scale_network(shape, 4);
    network.g.layers.back().weight *= 60;
    network.g.layers.back().bias[0] -= 0.8f;  // scales under 1 leave something inside for the collision loss
  }

  Repelled layer(const Points& x) const {
    const ScaleEvaluator scale(network, inputs);
    RepulsionOptions options;
    options.deep = std::numeric_limits<double>::infinity();
    options.most_beyond = most_beyond;
    return repel(x, ring, ask, scale, options);
  }
  double loss(const Points& x) const { return repulsion_losses(layer(x), truth, ask, {}).total; }
};

}  // namespace

TEST_CASE("repulsion losses: gradients by positions agree with differences", "[repulsion_training]") {
  const LayerCase c(ScaleForm::vertex_latents);
  const Repelled layer = c.layer(c.garment.x);
  REQUIRE(layer.pushed.size() > 10);
  const RepulsionLosses losses = repulsion_losses(layer, c.truth, c.ask, {});
  CHECK(losses.collision > 0);
  CHECK(losses.total == Approx(1.5 * losses.reconstruction + 0.5 * losses.collision));
  int tested = 0;
  for (std::size_t i = 0; i < layer.pushed.size(); i += 2) {
    const int v = layer.pushed[i].vertex;
    if (layer.pushed[i].at.value > -0.01) continue;
    for (int k = 0; k < 3; ++k) {
      Points forth = c.garment.x, back = forth;
      forth(v, k) += 1e-5;
      back(v, k) -= 1e-5;
      // The network's scale is a float: its difference is good to a percent.
      CHECK((c.loss(forth) - c.loss(back)) / 2e-5 == Approx(losses.by_x(v, k)).epsilon(0.02).margin(0.05));
    }
    ++tested;
  }
  CHECK(tested > 3);
  const int outside = [&] {
    for (int v = 0;; ++v)
      if (std::ranges::none_of(layer.pushed, [v](const PushedVertex& p) { return p.vertex == v; })) return v;
  }();
  CHECK((row(losses.by_x, outside) - 3 * (row(layer.x, outside) - row(c.truth, outside))).norm() < 1e-12);
}

TEST_CASE("repulsion losses: a bounded push has the gradient of its bound, and none by its scale",
          "[repulsion_training]") {
  LayerCase c(ScaleForm::vertex_latents);
  c.network.g.layers.back().bias[0] += 5;
  c.most_beyond = 1e-3;
  const Repelled layer = c.layer(c.garment.x);
  const RepulsionLosses losses = repulsion_losses(layer, c.truth, c.ask, {});
  int tested = 0;
  for (std::size_t i = 0; i < layer.pushed.size(); ++i) {
    const int v = layer.pushed[i].vertex;
    if (!layer.pushed[i].bounded || layer.pushed[i].at.value > -0.01) continue;
    CHECK(losses.by_alpha[i] == 0);
    for (int k = 0; k < 3; ++k) {
      Points forth = c.garment.x, back = forth;
      forth(v, k) += 1e-6;
      back(v, k) -= 1e-6;
      CHECK((c.loss(forth) - c.loss(back)) / 2e-6 == Approx(losses.by_x(v, k)).epsilon(1e-4).margin(1e-3));
    }
    ++tested;
  }
  CHECK(tested > 3);
}

TEST_CASE("repulsion losses: gradients by the scale network's parameters agree with differences",
          "[repulsion_training]") {
  for (const ScaleForm form : {ScaleForm::vertex_latents, ScaleForm::shared_latent, ScaleForm::distance_only}) {
    LayerCase c(form);
    const Repelled layer = c.layer(c.garment.x);
    const RepulsionLosses losses = repulsion_losses(layer, c.truth, c.ask, {});
    std::vector<int> vertices;
    std::vector<double> distances;
    for (const PushedVertex& p : layer.pushed) {
      vertices.push_back(p.vertex);
      distances.push_back(p.at.value);
    }
    const ScaleGradients made = scale_gradients(c.network, c.inputs, vertices, distances, losses.by_alpha);
    const auto check = [&](PlainNetwork& part, const std::vector<float>& gradient) {
      if (part.layers.empty()) return;
      REQUIRE(static_cast<long long>(gradient.size()) == parameter_count(part));
      std::vector<float> all = parameters_of(part);
      std::vector<std::size_t> order(all.size());
      for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
      std::ranges::sort(order,
                        [&](std::size_t a, std::size_t b) { return std::abs(gradient[a]) > std::abs(gradient[b]); });
      REQUIRE(std::abs(gradient[order[0]]) > 0);
      for (const std::size_t k : {order[0], order[1], order[2]}) {
        const float kept = all[k];
        all[k] = kept + 2e-3f;
        set_parameters(all, part);
        const double above = c.loss(c.garment.x);
        all[k] = kept - 2e-3f;
        set_parameters(all, part);
        const double below = c.loss(c.garment.x);
        all[k] = kept;
        set_parameters(all, part);
        CHECK((above - below) / 4e-3 == Approx(gradient[k]).epsilon(0.05).margin(1e-4));
      }
    };
    check(c.network.h, made.h);
    check(c.network.k, made.k);
    check(c.network.g, made.g);
  }
}

}  // namespace selvedge::test_repulsion_training
