#include "pipeline/bodies/body.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_body {

namespace {

constexpr double quarter = std::numbers::pi / 2;

// Two joints, at vertices 0 and 1: (0, 0, 0) and (1, 0, 0). Vertex 2 beyond the second follows it, vertex 3 both.
BodyModel two_joints() {
  BodyModel body;
  body.name = "arm";
  body.skin.rest.resize(4, 3);
  body.skin.rest << 0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1, 0;
  body.skin.triangles.resize(2, 3);
  body.skin.triangles << 0, 1, 3, 1, 2, 3;
  const std::vector<Eigen::Triplet<double>> weights{{0, 0, 1}, {1, 1, 1}, {2, 1, 1}, {3, 0, 0.5}, {3, 1, 0.5}};
  body.skin.weights.resize(4, 2);
  body.skin.weights.setFromTriplets(weights.begin(), weights.end());
  body.skin.shape_directions = Eigen::MatrixXd::Zero(12, 1);  // as far again from the origin in x
  for (int v = 0; v < 4; ++v) body.skin.shape_directions(3 * v, 0) = body.skin.rest(v, 0);
  body.joints = {"root", "elbow"};
  body.parents = {-1, 0};
  const std::vector<Eigen::Triplet<double>> regressor{{0, 0, 1}, {1, 1, 1}};
  body.regressor.resize(2, 4);
  body.regressor.setFromTriplets(regressor.begin(), regressor.end());
  return body;
}

BodyPose rest_pose(int joints) {
  BodyPose pose;
  pose.rotations = Points::Zero(joints, 3);
  return pose;
}

Points rows(const std::vector<Vec3>& list) {
  Points x(static_cast<Eigen::Index>(list.size()), 3);
  for (std::size_t v = 0; v < list.size(); ++v) x.row(static_cast<Eigen::Index>(v)) = list[v].transpose();
  return x;
}

double farthest(const Points& a, const Points& b) { return (a - b).cwiseAbs().maxCoeff(); }

// The same by other means: unit quaternions, the joints' own positions, and each vertex seen from its joints.
Points posed_by_quaternions(const BodyModel& body, const Eigen::VectorXd& shape, const BodyPose& pose) {
  const int n = static_cast<int>(body.skin.rest.rows()), joints = static_cast<int>(body.parents.size());
  const auto shaped_vertex = [&](int v) {
    Vec3 x = body.skin.rest.row(v);
    for (int i = 0; i < shape.size(); ++i) x += shape[i] * body.skin.shape_directions.col(i).segment<3>(3 * v);
    return x;
  };
  const Eigen::MatrixXd regressor = body.regressor, weights = body.skin.weights;
  std::vector<Vec3> home(joints, Vec3::Zero()), there(joints);
  std::vector<Eigen::Quaterniond> local(joints), world(joints);
  for (int j = 0; j < joints; ++j) {
    for (int v = 0; v < n; ++v)
      if (regressor(j, v) != 0) home[j] += regressor(j, v) * shaped_vertex(v);
    const Vec3 r = pose.rotations.row(j);
    const double half = r.norm() / 2;
    const Vec3 vector = half == 0 ? Vec3::Zero().eval() : (std::sin(half) / (2 * half) * r).eval();
    local[j] = Eigen::Quaterniond(std::cos(half), vector.x(), vector.y(), vector.z());
    const int p = body.parents[j];
    world[j] = p < 0 ? local[j] : world[p] * local[j];
    there[j] = p < 0 ? home[j] : (there[p] + world[p] * (home[j] - home[p])).eval();
  }
  Points result(n, 3);
  for (int v = 0; v < n; ++v) {
    Vec3 x = shaped_vertex(v);
    for (int j = 1; j < joints && body.skin.pose_directions.cols() > 0; ++j) {
      const Vec3 axes[3] = {local[j] * Vec3::UnitX(), local[j] * Vec3::UnitY(), local[j] * Vec3::UnitZ()};
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          x += (axes[b][a] - (a == b)) * body.skin.pose_directions.col(9 * (j - 1) + 3 * a + b).segment<3>(3 * v);
    }
    Vec3 sum = pose.translation;
    for (int j = 0; j < joints; ++j) sum += weights(v, j) * (world[j] * (x - home[j]) + there[j]);
    result.row(v) = sum;
  }
  return result;
}

}  // namespace

TEST_CASE("two joints bend as one computes by hand") {
  const BodyModel body = two_joints();
  REQUIRE_NOTHROW(check_body(body, "arm"));
  BodyPose pose = rest_pose(2);
  CHECK(posed(body, {}, pose) == body.skin.rest);

  pose.rotations.row(1) << 0, 0, quarter;
  CHECK(farthest(posed(body, {}, pose), rows({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 0.5, 0}})) < 1e-15);

  pose.rotations.row(0) << 0, quarter, 0;  // (x, y, z) becomes (z, y, -x)
  pose.translation << 10, 0, 0;
  CHECK(farthest(posed(body, {}, pose), rows({{10, 0, 0}, {10, 0, -1}, {10, 1, -1}, {10, 0.5, -0.5}})) < 1e-14);

  const Eigen::VectorXd twice = Eigen::VectorXd::Ones(1);
  CHECK(joint_positions(body, twice) == rows({{0, 0, 0}, {2, 0, 0}}));
  CHECK(shaped(body.skin, twice) == rows({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {2, 1, 0}}));
  CHECK(farthest(posed(body, twice, pose), rows({{10, 0, 0}, {10, 0, -2}, {10, 2, -2}, {10, 0.5, -1.5}})) < 1e-14);
}

TEST_CASE("pose blend shapes go with the entries of the rotation, row by row") {
  BodyModel body = two_joints();
  body.skin.pose_directions = Eigen::MatrixXd::Zero(12, 9);
  body.skin.pose_directions(3 * 2 + 2, 1) = 0.25;  // a quarter turn about z has -1 in row 0, column 1
  body.skin.pose_directions(3 * 2 + 2, 3) = 1;     // and 1 in row 1, column 0
  body.skin.pose_directions(3 * 2 + 2, 8) = 100;   // and 1 in row 2, column 2, as the rest pose has
  BodyPose pose = rest_pose(2);
  CHECK(posed(body, {}, pose) == body.skin.rest);
  pose.rotations.row(0) << 0, 0, quarter;  // the root's turn has no part in it
  CHECK(posed(body, {}, pose)(2, 2) == 0);
  pose.rotations.row(0).setZero();
  pose.rotations.row(1) << 0, 0, quarter;
  CHECK((posed(body, {}, pose).row(2) - Eigen::RowVector3d(1, 1, 0.75)).norm() < 1e-14);
}

TEST_CASE("angles from tiny to many turns are met") {
  const BodyModel body = two_joints();
  BodyPose pose = rest_pose(2);
  for (const double angle :
       {1e-300, 1e-200, 1e-162, 1e-20, 1e-12, 1e-9, 1e-8, 1e-6, 1e-3, 1.0, 3.0, 3.1415926, 100.0}) {
    INFO(angle);
    pose.rotations.row(1) << 0, 0, angle;
    const Points x = posed(body, {}, pose);
    CHECK(x.allFinite());
    CHECK(x(2, 0) == Approx(1 + std::cos(angle)).margin(1e-15));
    if (angle >= 1e-150) CHECK(x(2, 1) == Approx(std::sin(angle)).epsilon(1e-14));
    if (angle < 1e-150) CHECK(std::abs(x(2, 1)) < 1e-150);
  }
}

TEST_CASE("skinning agrees with an implementation by quaternions") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const BodyModel body = fake::body(24, 700, 10, seed != 3, seed);
    fake::Dice dice{std::mt19937(seed + 10)};
    const BodyPose pose = fake::pose(24, seed + 20);
    for (const int given : {0, 4, 10}) {
      const Eigen::VectorXd shape = dice.matrix(given, 1, 3);
      CHECK(farthest(posed(body, shape, pose), posed_by_quaternions(body, shape, pose)) < 1e-12);
    }
  }
}

TEST_CASE("a turn of the root about itself and a translation move the body rigidly") {
  BodyModel body = fake::body(24, 300, 10, true);
  BodyPose pose = fake::pose(24);
  pose.rotations.row(0).setZero();
  const Points before = posed(body, {}, pose);
  pose.rotations.row(0) << 0, quarter, 0;
  pose.translation += Vec3(1, 2, 3);
  const Points after = posed(body, {}, pose);
  for (int v = 1; v < before.rows(); ++v)
    CHECK((after.row(v) - after.row(0)).norm() == Approx((before.row(v) - before.row(0)).norm()).epsilon(1e-12));
}

TEST_CASE("any number of threads poses with the same bits") {
  const BodyModel body = fake::body(24, 3001, 10, true);
  const BodyPose pose = fake::pose(24);
  const Eigen::VectorXd shape = Eigen::VectorXd::LinSpaced(10, -2, 2);
  const Points once = posed(body, shape, pose), resting = shaped(body.skin, shape);
  CHECK(posed(body, shape, pose) == once);
  for (const int n : {1, 2, 3, 4})
    with_threads(n, [&] {
      CHECK(posed(body, shape, pose) == once);
      CHECK(shaped(body.skin, shape) == resting);
    });
}

TEST_CASE("what does not fit a body is refused") {
  const BodyModel body = fake::body(4, 20, 2, true);
  const BodyPose pose = fake::pose(4);
  const Points joints = joint_positions(body, {});
  CHECK_THROWS_AS(shaped(body.skin, Eigen::VectorXd::Zero(3)), Error);
  CHECK_THROWS_AS(posed(body, Eigen::VectorXd::Constant(1, std::nan("")), pose), Error);
  CHECK_THROWS_AS(posed(body, {}, fake::pose(5)), Error);
  CHECK_THROWS_AS(joint_transforms(body, joints.topRows(3), pose), Error);
  CHECK_THROWS_AS(posed(body.skin, {}, pose, JointTransforms(3)), Error);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    BodyPose broken = pose;
    broken.rotations(2, 1) = bad;
    CHECK_THROWS_AS(posed(body, {}, broken), Error);
  }
  SkinnedSurface garment = body.skin;
  garment.pose_directions = Eigen::MatrixXd::Zero(60, 9);
  CHECK_THROWS_AS(posed(garment, {}, pose, joint_transforms(body, joints, pose)), Error);
  garment.pose_directions.resize(60, 0);
  CHECK_NOTHROW(posed(garment, {}, pose, joint_transforms(body, joints, pose)));
}

TEST_CASE("a body that is not sound is refused, with the name of the field") {
  const auto complaint = [](auto change) -> std::string {
    BodyModel body = fake::body(4, 20, 2, true);
    change(body);
    try {
      check_body(body, "file", {.triangles = "f"});
    } catch (const Error& error) {
      CHECK_FALSE(error.cure().empty());
      return error.where();
    }
    return "nothing";
  };
  const double nan = std::nan("");
  CHECK(complaint([](BodyModel&) {}) == "nothing");
  CHECK(complaint([&](BodyModel& b) { b.skin.rest(3, 1) = nan; }) == "file: rest");
  CHECK(complaint([&](BodyModel& b) { b.skin.rest.resize(0, 3); }) == "file: rest");
  CHECK(complaint([](BodyModel& b) { b.skin.triangles(2, 0) = 20; }) == "file: f");
  CHECK(complaint([](BodyModel& b) { b.skin.triangles(2, 0) = -1; }) == "file: f");
  CHECK(complaint([](BodyModel& b) { b.skin.triangles.resize(0, 3); }) == "file: f");
  CHECK(complaint([](BodyModel& b) { b.skin.weights.resize(20, 3); }) == "file: weights");
  CHECK(complaint([](BodyModel& b) { b.skin.weights.valuePtr()[0] += 0.01; }) == "file: weights");
  CHECK(complaint([&](BodyModel& b) { b.skin.weights.valuePtr()[0] = nan; }) == "file: weights");
  CHECK(complaint([](BodyModel& b) { b.skin.shape_directions.resize(59, 2); }) == "file: shape_directions");
  CHECK(complaint([&](BodyModel& b) { b.skin.shape_directions(7, 1) = nan; }) == "file: shape_directions");
  CHECK(complaint([](BodyModel& b) { b.skin.pose_directions.resize(60, 26); }) == "file: pose_directions");
  CHECK(complaint([&](BodyModel& b) { b.skin.pose_directions(7, 1) = nan; }) == "file: pose_directions");
  CHECK(complaint([](BodyModel& b) { b.joints.pop_back(); }) == "file: joints");
  CHECK(complaint([](BodyModel& b) { b.joints[2] = b.joints[1]; }) == "file: joints");
  CHECK(complaint([](BodyModel& b) { b.parents[0] = 0; }) == "file: parents");
  CHECK(complaint([](BodyModel& b) { b.parents[2] = 2; }) == "file: parents");
  CHECK(complaint([](BodyModel& b) { b.parents[2] = -1; }) == "file: parents");
  CHECK(complaint([](BodyModel& b) { b.regressor.resize(4, 19); }) == "file: regressor");
  CHECK(complaint([&](BodyModel& b) { b.regressor.valuePtr()[0] = nan; }) == "file: regressor");
  CHECK(complaint([](BodyModel& b) { b.regressor.setZero(); }) == "file: regressor");
  CHECK(complaint([](BodyModel& b) { b.regressor *= 1.001; }) == "nothing");
  CHECK(complaint([](BodyModel& b) { b.regressor *= 1.1; }) == "file: regressor");
}

}  // namespace selvedge::test_body
