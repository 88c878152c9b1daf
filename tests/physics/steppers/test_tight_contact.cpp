#include <catch2/catch.hpp>

#include <cmath>

#include "physics/energies/measures.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_tight_contact {

using testing::add_obstacle;
using testing::make_world;
using testing::Sheet;
using testing::World;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double radius = 0.05;     // of the bar, along z [m]
constexpr double straight = 0.1;    // of the belt beside the bar, at each end [m]
constexpr double clearance = 2e-3;  // of the belt at the start: the thickness [m]
constexpr int across = 3, along = 80;

// A strip round half the bar, its ends straight down: row i of vertices is at arc length i / along.
Sheet belt() {
  Sheet s;
  const double r = radius + clearance, length = 2 * straight + pi * r, width = 0.02;
  s.x.resize((along + 1) * (across + 1), 3);
  s.triangles.resize(2 * along * across, 3);
  for (int i = 0, t = 0; i <= along; ++i) {
    const double a = length * i / along - straight;
    const double angle = std::clamp(a / r, 0.0, pi), below = a < 0 ? a : std::min(0.0, pi * r - a);
    for (int j = 0; j <= across; ++j) {
      const int v = i * (across + 1) + j;
      s.x.row(v) << -r * std::cos(angle), r * std::sin(angle) + below, width * (double(j) / across - 0.5);
      if (i == along || j == across) continue;
      const int b = v + across + 1;
      s.triangles.row(t++) << v, b, v + 1;
      s.triangles.row(t++) << v + 1, b, b + 1;
    }
  }
  return s;
}

Sheet bar(int sides) {
  Sheet s;
  s.x.resize(2 * sides, 3);
  s.triangles.resize(2 * sides, 3);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * pi * i / sides;
    for (const int end : {0, 1}) s.x.row(2 * i + end) << radius * std::cos(angle), radius * std::sin(angle), end - 0.5;
    const int a = 2 * i, b = 2 * ((i + 1) % sides);
    s.triangles.row(2 * i) << a, b, a + 1;
    s.triangles.row(2 * i + 1) << a + 1, b, b + 1;
  }
  return s;
}

// Mean force across the rows from first to last, without side contraction: E h width (l^2 - 1) l / 2 of each [N].
double tension(const World& w, const Points& x, int first, int last) {
  double stretch = 0;
  for (int i = first; i < last; ++i)
    for (int j = 0; j <= across; ++j) {
      const int a = i * (across + 1) + j, b = a + across + 1;
      stretch += (x.row(b) - x.row(a)).norm() / (w.scene.rest.row(b) - w.scene.rest.row(a)).norm();
    }
  const double l = stretch / ((last - first) * (across + 1));
  return (l * l - 1) * l;
}

struct Pulled {
  double ratio = 0, stretch = 0;
  int impulses = 0;
};

// Tightens the belt, then pulls it round the bar. The figures are of the last ten frames.
Pulled pull(double friction) {
  World w = make_world(belt());
  add_obstacle(w, bar(90));
  w.scene.contact.self = false;
  w.scene.contact.friction = friction;
  w.drive.acceleration.setZero();
  for (int j = 0; j <= across; ++j) w.scene.pins.push_back(j);
  for (int j = 0; j <= across; ++j) w.scene.pins.push_back(along * (across + 1) + j);
  auto stepper = make_recovering_conventional_stepper(w.scene, {});
  State state = w.state;
  Pulled pulled;
  constexpr int tighten = 10, frames = 45;
  for (int f = 1; f <= frames; ++f) {
    const double tight = 0.008 * std::min(1.0, double(f) / tighten), slid = 0.3e-3 * std::max(0, f - tighten);
    w.drive.pins.resize(static_cast<Eigen::Index>(w.scene.pins.size()), 3);
    for (std::size_t p = 0; p < w.scene.pins.size(); ++p) {
      w.drive.pins.row(p) = w.state.x.row(w.scene.pins[p]);
      w.drive.pins(p, 1) -= tight + (p <= across ? -slid : slid);
    }
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    REQUIRE(report.collision.pairs_after == 0);
    state = to;
    if (f <= frames - 10) continue;
    pulled.impulses += report.collision.impulses;
    pulled.ratio += 0.1 * tension(w, state.x, along - 20, along - 5) / tension(w, state.x, 5, 20);
    pulled.stretch = std::max(pulled.stretch, principal_stretches(w.scene, state.x).maxCoeff());
  }
  return pulled;
}

}  // namespace

TEST_CASE("tight cloth is borne by the solve, without impulses", "[tight_contact]") {
  const Pulled pulled = pull(0.3);
  CHECK(pulled.impulses == 0);
  CHECK(pulled.stretch < 1.09);  // 1.05 in the mean where it is pulled hardest
}

TEST_CASE("a belt on a bar holds by its capstan ratio", "[tight_contact]") {
  const double mu = GENERATE(0.0, 0.1, 0.3, 0.5);
  const Pulled pulled = pull(mu);
  CAPTURE(mu);
  CHECK(pulled.ratio == Approx(std::exp(mu * pi)).epsilon(0.03));
}

}  // namespace selvedge::test_tight_contact
