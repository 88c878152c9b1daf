#include <catch2/catch.hpp>

#include <random>

#include "collision/distance/edge_pass.hpp"
#include "collision/distance/outside_budget.hpp"
#include "tests/collision/sheets.hpp"
#include "tests/collision/solids.hpp"

namespace selvedge::test_edge_pass {

using testing::Solid;

namespace {

// Figure 3 of the paper: two vertices of a strip come to lie on a convex body, and the edge between them goes through.
Solid ridge_strip() {
  return testing::solid_of({{-0.3, -0.2, 0.02}, {0.3, -0.2, 0.02}, {-0.3, 0.2, 0.02}, {0.3, 0.2, 0.02}},
                           {{0, 1, 2}, {1, 3, 2}});
}

}  // namespace

TEST_CASE("edge pass: an edge over a ridge is lifted so that its deepest point lies at the margin", "[distance]") {
  // A ridge along y: a block turned by 45 degrees about y, its highest edge at z = 0.1.
  Solid ridge = testing::block({-1, -1, -1}, {1, 1, 1}, 2);
  const Mat3 turn = Eigen::AngleAxisd(std::atan(1.0), Vec3::UnitY()).toRotationMatrix();
  ridge.x = testing::rotated(ridge.x, turn);
  ridge.x.col(2).array() += 0.1 - std::sqrt(2.0);
  DistanceField body(ridge.surface);
  body.move_to(ridge.x);
  const Solid strip = ridge_strip();
  for (const SignedDistance& d : body.ask(strip.x)) REQUIRE(d.value > 0);  // no vertex is inside
  Points x = strip.x;
  const EdgePassReport report = pass_edges(body, strip.surface, {.rounds = 15, .margin = 1e-3}, x);
  CHECK(report.pairs_before > 0);
  CHECK(report.pairs_after == 0);
  CHECK(report.edges >= 2);
  double highest = 0;
  for (int v = 0; v < 4; ++v) highest = std::max(highest, x(v, 2));
  CHECK(highest < 0.15);  // lifted, not thrown away
  for (int i = 0; i <= 20; ++i) {
    const Points on_edge = (1 - i / 20.0) * x.row(0) + i / 20.0 * x.row(1);
    CHECK(body.ask(on_edge).front().value > 0);
  }
  Points held = strip.x;
  pass_edges(body, strip.surface, {.rounds = 1}, held, std::vector<char>(4, true));
  CHECK(held == strip.x);
}

TEST_CASE("edge pass: a face pierced by a body vertex is lifted; clear cloth is left alone", "[distance]") {
  Solid spike = testing::ball(2);  // an octahedron
  DistanceField body(spike.surface);
  body.move_to(spike.x);
  const Solid sheet = testing::solid_of({{-0.5, -0.5, 0.97}, {0.5, -0.5, 0.97}, {0, 0.5, 0.97}}, {{0, 1, 2}});
  Points x = sheet.x;
  const EdgePassReport report = pass_edges(body, sheet.surface, {.rounds = 60, .margin = 1e-3}, x);
  CHECK(report.pairs_before > 0);
  CHECK(report.edges == 0);
  CHECK(report.faces > 0);
  CHECK(report.pairs_after == 0);
  Points above = sheet.x;
  above.col(2).array() += 0.5;
  x = above;
  CHECK(pass_edges(body, sheet.surface, {.rounds = 4}, x).pairs_before == 0);
  CHECK(x == above);
}

TEST_CASE("edge pass: one round takes most crossings off a coarse cap that lies on a finer ball", "[distance]") {
  const Solid ball = testing::ball(24);
  DistanceField body(ball.surface);
  body.move_to(ball.x);
  // A cap of edges four times as long, its vertices just outside.
  const Solid coarse = testing::ball(8);
  std::vector<std::array<int, 3>> faces;
  for (const auto& t : coarse.surface.triangles.rowwise())
    if (std::min({coarse.x(t(0), 2), coarse.x(t(1), 2), coarse.x(t(2), 2)}) > 0.2) faces.push_back({t(0), t(1), t(2)});
  Triangles triangles(std::ssize(faces), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) triangles(t, k) = faces[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
  const Surface cap = make_surface(static_cast<int>(coarse.x.rows()), triangles);
  const Points start = 1.001 * coarse.x;
  Points once = start, thrice = start;
  const EdgePassReport first = pass_edges(body, cap, {.rounds = 1}, once);
  REQUIRE(first.pairs_before > 50);
  CHECK(2 * first.pairs_after <= first.pairs_before);
  CHECK(pass_edges(body, cap, {.rounds = 3}, thrice).pairs_after == 0);
  // A diagonal of 0.55 between points of a ball of radius 1 lies 0.039 deep: that much is needed, and little more
  // taken.
  CHECK((thrice - start).rowwise().norm().maxCoeff() < 0.042);
}

TEST_CASE("outside budget: no point that is spared has come inside", "[distance]") {
  const Solid solid = testing::blob(8);
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  Points at(300, 3), body = solid.x;
  for (int i = 0; i < at.rows(); ++i)
    at.row(i) = (1.2 + 0.01 * i) * Vec3(normal(random), normal(random), normal(random)).normalized().transpose();
  DistanceField field(solid.surface);
  OutsideBudget budget;
  int asked = 0, wrong = 0;
  for (int frame = 0; frame < 30; ++frame) {
    field.move_to(body);
    const std::vector<SignedDistance> found = field.ask(at);
    const std::vector<int> due = budget.due(at, body);
    asked += static_cast<int>(due.size());
    for (int i = 0; i < at.rows(); ++i)
      if (!std::binary_search(due.begin(), due.end(), i)) wrong += found[i].value <= 0;
    for (const int i : due) budget.renew(i, found[i].value);
    at *= 0.99;
    body *= 1.005;
  }
  CHECK(wrong == 0);
  CHECK(asked >= 300);
  CHECK(asked < 30 * 300 * 2 / 3);
  CHECK(budget.due(at.topRows(10), body).size() == 10);  // another garment: all of it
}

}  // namespace selvedge::test_edge_pass
