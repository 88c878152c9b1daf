#include <catch2/catch.hpp>

#include "collision/contact/response.hpp"

namespace selvedge::test_response {

namespace {

// A vertex that falls from 1 to -1 through the middle of a triangle in y = 0, sliding along x by `slide`.
struct Fall {
  Points x0{4, 3}, x1{4, 3};
  NodePair pair{PairKind::vertex_face, {0, 1, 2, 3}};
  explicit Fall(double slide) {
    x0 << 0, 1, 0, -3, 0, -3, 0, 0, 6, 3, 0, -3;
    x1 = x0;
    x1.row(0) << slide, -1, 0;
  }
};

Vec3 momentum(const Eigen::VectorXd& inverse_mass, const Points& change) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < change.rows(); ++i)
    if (inverse_mass[i] > 0) sum += change.row(i).transpose() / inverse_mass[i];
  return sum;
}

}  // namespace

TEST_CASE("response: an impact is found early and faces the vertex", "[response]") {
  const Fall fall(0);
  const auto impact = find_impact(fall.pair, fall.x0, fall.x1, 0.01);
  REQUIRE(impact);
  CHECK(impact->time <= 0.5);
  CHECK(impact->time > 0.45);
  CHECK(impact->normal.y() == Approx(1));
  CHECK(impact->target == Approx(0.02));
  CHECK_FALSE(find_impact(fall.pair, fall.x0, fall.x0, 0.01));
}

TEST_CASE("response: an impulse closes the gap to its target and keeps momentum", "[response]") {
  Fall fall(0.3);
  Eigen::VectorXd inverse_mass(4);
  inverse_mass << 1, 0.5, 2, 4;
  auto impact = find_impact(fall.pair, fall.x0, fall.x1, 0.01).value();
  const Points before = fall.x1;
  impact.friction = 0.2;
  apply_impulse(impact, inverse_mass, fall.x0, fall.x1);
  CHECK(impact_gap(impact, fall.x1) == Approx(impact.target));
  CHECK(momentum(inverse_mass, fall.x1 - before).norm() < 1e-12);
}

TEST_CASE("response: friction sticks at a high coefficient and slides by Coulomb's law at a low one", "[response]") {
  Eigen::VectorXd inverse_mass(4);
  inverse_mass << 1, 0, 0, 0;  // the triangle is prescribed
  const double slide = 0.5;
  for (const double friction : {0.0, 0.1, 10.0}) {
    Fall fall(slide);
    auto impact = find_impact(fall.pair, fall.x0, fall.x1, 0.01).value();
    impact.friction = friction;
    apply_impulse(impact, inverse_mass, fall.x0, fall.x1);
    const double normal_change = fall.x1(0, 1) + 1;
    CHECK(fall.x1(0, 0) == Approx(std::max(0.0, slide - friction * normal_change)).margin(1e-12));
    CHECK(fall.x1.bottomRows(3) == fall.x0.bottomRows(3));
  }
}

TEST_CASE("response: a zone meets all its impacts with the least change, and only by pushing", "[response]") {
  // Vertex 0 is held up by triangle 1 2 3, which is pressed from below by vertex 4.
  Points x0(5, 3), x1(5, 3);
  x0 << 0, 1, 0, -3, 0, -3, 0, 0, 6, 3, 0, -3, 0, -1, 0;
  x1 = x0;
  x1.row(0) << 0, -0.5, 0;
  x1.row(4) << 0, 0.8, 0;
  const Eigen::VectorXd inverse_mass = Eigen::VectorXd::Ones(5);
  Impact above = find_impact({PairKind::vertex_face, {0, 1, 2, 3}}, x0, x1, 0.01).value();
  Impact below = find_impact({PairKind::vertex_face, {4, 1, 2, 3}}, x0, x1, 0.01).value();
  std::vector<Impact*> zone{&above, &below};
  const Points before = x1;
  const double violation = project_zone(zone, inverse_mass, x0, x1, 500, 1e-10).violation;
  CHECK(violation < 1e-10);
  CHECK(above.multiplier > 0);
  CHECK(below.multiplier > 0);
  CHECK(impact_gap(above, x1) == Approx(above.target).margin(1e-8));
  CHECK(impact_gap(below, x1) == Approx(below.target).margin(1e-8));
  CHECK(momentum(inverse_mass, x1 - before).norm() < 1e-12);
  // Least change: it is spanned by the impacts' own directions with their multipliers.
  Points spanned = before;
  for (const Impact* impact : zone)
    for (int i = 0; i < 4; ++i)
      spanned.row(impact->pair.nodes[i]) += impact->multiplier * impact->weights[i] * impact->normal.transpose();
  CHECK((spanned - x1).norm() < 1e-12);
}

TEST_CASE("response: friction in a zone takes no more than its normal impulse allows", "[response]") {
  Eigen::VectorXd inverse_mass(4);
  inverse_mass << 1, 0, 0, 0;
  const double slide = 0.5;
  for (const double friction : {0.0, 0.1, 10.0}) {
    Fall fall(slide);
    Impact impact = find_impact(fall.pair, fall.x0, fall.x1, 0.01).value();
    impact.friction = friction;
    std::vector<Impact*> zone{&impact};
    project_zone(zone, inverse_mass, fall.x0, fall.x1, 500, 1e-10);
    CHECK(impact_gap(impact, fall.x1) == Approx(impact.target));
    CHECK(fall.x1(0, 0) == Approx(std::max(0.0, slide - friction * (fall.x1(0, 1) + 1))).margin(1e-9));
    CHECK(impact.tangential.norm() <= friction * impact.multiplier * (1 + 1e-12));
  }
}

TEST_CASE("response: a rigid zone keeps distances and both momenta", "[response]") {
  Points x0(5, 3), x1;
  x0 << 0, 1, 0, -3, 0, -3, 0, 0, 6, 3, 0, -3, 0.4, -1, 0.2;
  const Points motion = 0.2 * Points::Random(5, 3);
  x1 = x0 + motion;
  Eigen::VectorXd inverse_mass(5);
  inverse_mass << 1, 0.5, 2, 4, 3;
  const std::vector<int> nodes{0, 1, 2, 3, 4};
  const Points before = x1;
  rigidify_zone(nodes, inverse_mass, x0, x1);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < i; ++j)
      CHECK((x1.row(i) - x1.row(j)).norm() == Approx((x0.row(i) - x0.row(j)).norm()).epsilon(1e-12));
  CHECK(momentum(inverse_mass, x1 - before).norm() < 1e-12);
  // A motion that is rigid already stays, to second order in its angle.
  Points turned = x0;
  const Mat3 small = Eigen::AngleAxisd(1e-4, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  for (int i = 0; i < 5; ++i) turned.row(i) = (small * row(x0, i)).transpose();
  const Points rigid = turned;
  rigidify_zone(nodes, inverse_mass, x0, turned);
  CHECK((turned - rigid).cwiseAbs().maxCoeff() < 1e-7);
  // Nodes on a line: nothing undefined.
  Points line(2, 3);
  line << 0, 0, 0, 1, 0, 0;
  Points line_end = line;
  line_end(1, 1) = 0.1;
  const std::vector<int> two{0, 1};
  rigidify_zone(two, inverse_mass, line, line_end);
  CHECK((line_end.row(1) - line_end.row(0)).norm() == Approx(1));
}

TEST_CASE("response: what has no inertia about an axis does not turn about it", "[response]") {
  const Mat3 inertia = Vec3(2, 3, 4).asDiagonal();
  CHECK((angular_velocity(inertia, Vec3(2, 6, 1)) - Vec3(1, 2, 0.25)).norm() < 1e-15);
  const Vec3 line = Vec3(1, 2, -2) / 3.0;
  const Mat3 rod = 0.7 * (Mat3::Identity() - line * line.transpose());
  const Vec3 across = line.cross(Vec3::UnitX());
  CHECK((angular_velocity(rod, 0.7 * across) - across).norm() < 1e-14);
  CHECK(angular_velocity(Mat3::Zero(), Vec3(0, 0, 0)) == Vec3(0, 0, 0));
}

}  // namespace selvedge::test_response
