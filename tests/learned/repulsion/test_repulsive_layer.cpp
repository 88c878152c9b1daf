#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "learned/repulsion/repulsive_layer.hpp"
#include "learned/repulsion/smooth_push.hpp"
#include "tests/learned/repulsion/dressed_blob.hpp"

namespace selvedge::test_repulsive_layer {

using testing::Solid;

namespace {

struct Dressed : fake::DressedBlob {
  Dressed() : DressedBlob(12, 14) {}
};

int inside(const Dressed& d, const Points& x) {
  int count = 0;
  for (const SignedDistance& at : d.field.ask(x)) count += at.value < -1e-6;
  return count;
}

AskScale constant(double alpha) {
  return [alpha](std::span<const int> vertices, std::span<const double>) { return constant_scale(vertices, alpha); };
}

constexpr double no_depth = std::numeric_limits<double>::infinity();

// A scale with a slope, for one vertex.
double scale_at(double f) { return 1.3 + 5 * f + 40 * f * f; }
double scale_slope(double f) { return 5 + 80 * f; }

Vec3 layer_at(const DistanceField& field, const Vec3& x, const Vec3* frozen) {
  const SignedDistance at = field.ask(Points(x.transpose())).front();
  // The surrogate of the frozen direction knows f to first order and n as a constant.
  return x - scale_at(at.value) * at.value * (frozen ? *frozen : at.gradient);
}

// What push_smoothly minimises over u, for the nearest points and normals at x.
double smooth_push_objective(const Points& u, const Adjacency& ring, const std::vector<SignedDistance>& at_x,
                             const SmoothPushOptions& options) {
  double sum = options.damping * u.squaredNorm();
  for (int v = 0; v < u.rows(); ++v) {
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (const int next : ring.of(v)) mean += u.row(next) / static_cast<double>(ring.of(v).size());
    if (!ring.of(v).empty()) sum += options.smoothness * (u.row(v) - mean).squaredNorm();
    const SignedDistance& at = at_x[static_cast<std::size_t>(v)];
    if (at.value < 0 && at.gradient.norm() > 0)
      sum += std::pow(u.row(v).dot(at.gradient.normalized()) - (options.gap - at.value), 2);
  }
  return sum;
}

}  // namespace

TEST_CASE("repulsive layer: both Jacobians agree with differences on faces, edges and vertices", "[refu]") {
  const Dressed d;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.2, 1.2);
  constexpr double step = 1e-6;
  int tested[3] = {};
  for (int trial = 0; trial < 60000 && (tested[0] < 20 || tested[1] < 20 || tested[2] < 20); ++trial) {
    const Vec3 x(unit(random), unit(random), unit(random));
    const SignedDistance at = d.field.ask(Points(x.transpose())).front();
    if (!(at.value < -0.01) || tested[static_cast<int>(at.place)] >= 20) continue;
    Mat3 full, frozen;
    bool same_place = true;
    for (int k = 0; k < 3; ++k) {
      const Vec3 forth = x + step * Vec3::Unit(k), back = x - step * Vec3::Unit(k);
      for (const Vec3& p : {forth, back}) {
        const SignedDistance beside = d.field.ask(Points(p.transpose())).front();
        same_place &= beside.place == at.place && (beside.closest - at.closest).norm() < 10 * step;
        same_place &= at.place == SurfacePlace::vertex || beside.triangle == at.triangle;
      }
      full.col(k) = (layer_at(d.field, forth, nullptr) - layer_at(d.field, back, nullptr)) / (2 * step);
      frozen.col(k) = (layer_at(d.field, forth, &at.gradient) - layer_at(d.field, back, &at.gradient)) / (2 * step);
    }
    if (!same_place) continue;
    const double alpha = scale_at(at.value), slope = scale_slope(at.value);
    CHECK((full_jacobian(at, alpha, slope) - full).cwiseAbs().maxCoeff() < 1e-6);
    CHECK((frozen_jacobian(at, alpha, slope) - frozen).cwiseAbs().maxCoeff() < 1e-6);
    ++tested[static_cast<int>(at.place)];
  }
  for (const int count : tested) CHECK(count >= 10);
}

TEST_CASE("repulsive layer: what is outside stays bit for bit, what is inside goes by alpha f", "[refu]") {
  const Dressed d;
  REQUIRE(inside(d, d.garment.x) > 20);
  RepulsionOptions options;
  options.deep = no_depth;
  const Repelled made = repel(d.garment.x, d.ring, d.ask, constant(1.5), options);
  std::vector<char> moved(static_cast<std::size_t>(d.garment.x.rows()), false);
  for (const PushedVertex& p : made.pushed) {
    moved[static_cast<std::size_t>(p.vertex)] = true;
    CHECK(p.at.value < 0);
    CHECK((made.x.row(p.vertex) - d.garment.x.row(p.vertex)).norm() == Approx(-1.5 * p.at.value));
  }
  const std::vector<SignedDistance> found = d.field.ask(d.garment.x);
  for (int v = 0; v < made.x.rows(); ++v) {
    CHECK(moved[static_cast<std::size_t>(v)] == (found[static_cast<std::size_t>(v)].value < 0));
    if (!moved[static_cast<std::size_t>(v)]) CHECK(made.x.row(v) == d.garment.x.row(v));
  }
  const Repelled naive = repel(d.garment.x, d.ring, d.ask, constant(1), options);
  CHECK(inside(d, naive.x) == 0);
  const std::vector<char> held(static_cast<std::size_t>(d.garment.x.rows()), true);
  CHECK(repel(d.garment.x, d.ring, d.ask, constant(1), options, held).pushed.empty());
}

TEST_CASE("repulsive layer: no scale takes a vertex farther out than the bound", "[refu]") {
  const Dressed d;
  RepulsionOptions options;
  options.deep = no_depth;
  options.most_beyond = 0.002;
  const Repelled made = repel(d.garment.x, d.ring, d.ask, constant(40), options);
  const Repelled free = repel(d.garment.x, d.ring, d.ask, constant(1), options);
  REQUIRE(made.pushed.size() > 20);
  for (const PushedVertex& p : made.pushed) {
    const double push = (made.x.row(p.vertex) - d.garment.x.row(p.vertex)).norm();
    CHECK(p.bounded == (-39 * p.at.value > 0.002));
    CHECK(push == Approx(p.bounded ? 0.002 - p.at.value : -40 * p.at.value));
    // The derivative of the bounded push by the distance: a push of -f and a constant.
    if (p.bounded) CHECK(p.alpha + p.at.value * p.slope == Approx(1));
  }
  for (const PushedVertex& p : free.pushed) CHECK_FALSE(p.bounded);
}

TEST_CASE("repulsive layer: rechecked, no vertex is inside whatever the scales are", "[refu]") {
  const Dressed d;
  const AskScale wild = [](std::span<const int> vertices, std::span<const double>) {
    Scales made = constant_scale(vertices, 1);
    for (std::size_t i = 0; i < vertices.size(); ++i) made.alpha[i] = 1 + 40.0 * ((vertices[i] * 37) % 11) / 10;
    return made;
  };
  for (const double shrink : {1.0, 0.7, 0.2}) {  // 0.2: everything is deep inside
    RepulsionOptions options;
    options.recheck = 3;
    options.deep = 0.05;
    const Points x = shrink * d.garment.x;
    const Repelled made = repel(x, d.ring, d.ask, wild, options);
    CHECK(inside(d, made.x) == 0);
    CHECK(made.x.allFinite());
    if (shrink < 0.5) CHECK(made.deep > 100);
  }
}

TEST_CASE("repulsive layer: figure 3, a scale of 1 leaves the edge crossing and a larger one does not", "[refu]") {
  // A ridge; two vertices inside on its two sides, joined by an edge.
  Solid ridge = testing::block({-1, -1, -1}, {1, 1, 1}, 2);
  ridge.x = testing::rotated(ridge.x, Eigen::AngleAxisd(std::atan(1.0), Vec3::UnitY()).toRotationMatrix());
  DistanceField field(ridge.surface);
  field.move_to(ridge.x);
  const double top = std::sqrt(2.0);
  const Solid strip =
      testing::solid_of({{-0.06, 0, top - 0.09}, {0.06, 0, top - 0.09}, {0, 0.3, top + 0.3}}, {{0, 1, 2}});
  const AskDistance ask = [&](const Points& at, std::vector<SignedDistance>& found) { found = field.ask(at); };
  const Adjacency ring = adjacency_of(3, strip.surface.edges);
  RepulsionOptions options;
  options.deep = no_depth;
  const auto deepest_on_edge = [&](double alpha) {
    const Repelled made = repel(strip.x, ring, ask, constant(alpha), options);
    REQUIRE(made.pushed.size() == 2);
    CHECK(made.torn == 0);
    double deepest = 1;
    for (int i = 1; i < 40; ++i)
      deepest = std::min(deepest, field.ask((1 - i / 40.0) * made.x.row(0) + i / 40.0 * made.x.row(1)).front().value);
    return deepest;
  };
  CHECK(deepest_on_edge(1) < -1e-3);
  CHECK(deepest_on_edge(7) > 0);
}

TEST_CASE("repulsive layer: neighbours that go apart are counted as torn; a vanishing gradient moves nothing",
          "[refu]") {
  const Solid slab = testing::block({-1, -1, -0.01}, {1, 1, 0.01}, 4);
  DistanceField field(slab.surface);
  field.move_to(slab.x);
  const Solid sheet = testing::solid_of({{0.1, 0, 0.002}, {0.2, 0, -0.002}, {0.1, 0.1, 2}}, {{0, 1, 2}});
  const Adjacency ring = adjacency_of(3, sheet.surface.edges);
  const AskDistance ask = [&](const Points& at, std::vector<SignedDistance>& found) { found = field.ask(at); };
  CHECK(repel(sheet.x, ring, ask, constant(1), {}).torn == 1);
  const AskDistance nothing = [](const Points& at, std::vector<SignedDistance>& found) {
    found.assign(static_cast<std::size_t>(at.rows()), {});
    for (SignedDistance& d : found) d.value = -1;
  };
  CHECK(repel(sheet.x, ring, nothing, constant(1), {}).x == sheet.x);
}

TEST_CASE("smooth push: the displacement minimises the objective, and clears the garment smoothly", "[refu]") {
  const Dressed d;
  const SmoothPushOptions options{0.01, 4, 0.8, 1, 1e-12, 2000};
  const SmoothlyPushed made = push_smoothly(d.garment.x, d.ring, d.ask, options);
  CHECK(made.penetrating == inside(d, d.garment.x));
  const std::vector<SignedDistance> found = d.field.ask(d.garment.x);
  const Points u = made.x - d.garment.x;
  const double least = smooth_push_objective(u, d.ring, found, options);
  CHECK(least < smooth_push_objective(Points::Zero(u.rows(), 3), d.ring, found, options));
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0, 1e-3);
  for (int trial = 0; trial < 20; ++trial) {
    Points other = u;
    for (double& value : other.reshaped()) value += normal(random);
    CHECK(smooth_push_objective(other, d.ring, found, options) > least);
  }
  SmoothPushOptions stiff = options;
  stiff.rounds = 3;
  stiff.damping = 1e-3;
  CHECK(inside(d, push_smoothly(d.garment.x, d.ring, d.ask, stiff).x) < made.penetrating / 4);
}

}  // namespace selvedge::test_repulsive_layer
