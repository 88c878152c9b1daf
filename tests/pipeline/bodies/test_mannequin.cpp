#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "collision/exact/inside.hpp"
#include "collision/search/intersections.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/bodies/mannequin_form.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_mannequin {

namespace {

const BodyModel& body() {  // made by the first call, into a folder that is not there yet
  static const fake::Folder folder("mannequin");
  static const BodyModel made = kept_mannequin(folder.path / "kept");
  return made;
}

const Surface& surface() {
  static const Surface made = make_surface(static_cast<int>(body().skin.rest.rows()), body().skin.triangles);
  return made;
}

Points with_shape(const Eigen::VectorXd& coefficients) { return shaped(body().skin, coefficients); }

int shape_index(const std::string& name) {
  const auto found = std::find(mannequin_shapes.begin(), mannequin_shapes.end(), name);
  REQUIRE(found != mannequin_shapes.end());
  return static_cast<int>(found - mannequin_shapes.begin());
}

Eigen::VectorXd only(const std::string& name, double value) {
  return value * Eigen::VectorXd::Unit(mannequin_shapes.size(), shape_index(name));
}

int joint(const std::string& name) {
  const auto found = std::find(body().joints.begin(), body().joints.end(), name);
  REQUIRE(found != body().joints.end());
  return static_cast<int>(found - body().joints.begin());
}

double volume_of(const Points& x) {  // [l]
  double sum = 0;
  for (const auto& t : body().skin.triangles.rowwise()) sum += row(x, t[0]).dot(row(x, t[1]).cross(row(x, t[2])));
  return 1000 * sum / 6;
}

Vec3 size_of(const Points& x) { return x.colwise().maxCoeff() - x.colwise().minCoeff(); }

// Extent along an axis of what lies near a height, without the arms.
double extent_at(const Points& x, double y, int axis) {
  double low = 1, high = -1;
  for (int v = 0; v < x.rows(); ++v) {
    const Vec3 rest = row(body().skin.rest, v);
    if (std::abs(rest.y() - (y - mannequin_pelvis_height)) > 0.02 || std::abs(rest.x()) > 0.2) continue;
    low = std::min(low, x(v, axis));
    high = std::max(high, x(v, axis));
  }
  return high - low;
}

double least_angle(const Points& x, const Triangles& triangles) {  // [degrees]
  double least = 180;
  for (const auto& t : triangles.rowwise())
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = row(x, t[k]), a = row(x, t[(k + 1) % 3]) - p, b = row(x, t[(k + 2) % 3]) - p;
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi);
    }
  return least;
}

// Triangles that face away from where they face at rest.
int turned_over(const Points& x) {
  const auto normal = [](const Points& at, const auto& t) {
    return Vec3((row(at, t[1]) - row(at, t[0])).cross(row(at, t[2]) - row(at, t[0])));
  };
  int count = 0;
  for (const auto& t : body().skin.triangles.rowwise()) count += !(normal(x, t).dot(normal(body().skin.rest, t)) > 0);
  return count;
}

void check_shape(const Eigen::VectorXd& coefficients) {
  IntersectionCache cache;
  const Points x = with_shape(coefficients);
  INFO("shape " << coefficients.transpose());
  CHECK(intersecting_pairs(surface(), x, cache).empty());
  CHECK(turned_over(x) == 0);
  CHECK(least_angle(x, body().skin.triangles) > 5);
  const Points joints = body().regressor * x;
  const std::vector<char> within = inside(surface(), x, joints);
  CHECK(std::count(within.begin(), within.end(), 1) == joints.rows());
}

}  // namespace

TEST_CASE("mannequin: one closed surface of even triangles, as large as a person") {
  const Points& x = body().skin.rest;
  CHECK(x.rows() >= 6000);
  CHECK(x.rows() <= 8000);
  CHECK(is_closed(surface()));
  CHECK(surface().nonmanifold_edges == 0);
  CHECK(surface().component_count == 1);
  CHECK(surface().isolated_vertices == 0);
  CHECK(surface().vertex_count - surface().edges.rows() + surface().triangles.rows() == 2);
  std::set<std::pair<int, int>> directed;
  for (const auto& t : body().skin.triangles.rowwise())
    for (int k = 0; k < 3; ++k) directed.emplace(t[k], t[(k + 1) % 3]);
  CHECK(directed.size() == static_cast<std::size_t>(2 * surface().edges.rows()));

  CHECK(volume_of(x) > 55);  // positive: normals point outward
  CHECK(volume_of(x) < 85);
  CHECK(size_of(x).y() == Approx(1.72).margin(0.02));
  CHECK(size_of(x).x() == Approx(1.77).margin(0.03));
  CHECK(x.col(1).minCoeff() == Approx(-mannequin_pelvis_height).margin(0.005));

  CHECK(least_angle(x, body().skin.triangles) > 20);
  for (const auto& edge : surface().edges.rowwise()) {
    const double length = (row(x, edge[1]) - row(x, edge[0])).norm();
    if (length < 0.005 || length > 0.03) FAIL_CHECK("edge of " << length << " m at " << x.row(edge[0]));
  }
}

TEST_CASE("mannequin: left and right are the same to the bit") {
  const Points& x = body().skin.rest;
  std::map<std::array<double, 3>, int> at;
  for (int v = 0; v < x.rows(); ++v) at[{x(v, 0), x(v, 1), x(v, 2)}] = v;
  REQUIRE(at.size() == static_cast<std::size_t>(x.rows()));
  const int left = joint("left_elbow"), right = joint("right_elbow");
  int wrong = 0;
  for (int v = 0; v < x.rows(); ++v) {
    const auto twin = at.find({-x(v, 0), x(v, 1), x(v, 2)});
    REQUIRE(twin != at.end());
    const int w = twin->second;
    wrong += body().skin.weights.coeff(v, left) != body().skin.weights.coeff(w, right);
    const auto d = body().skin.shape_directions.middleRows(3 * v, 3),
               e = body().skin.shape_directions.middleRows(3 * w, 3);
    wrong += d.row(0) != -e.row(0) || d.bottomRows(2) != e.bottomRows(2);
  }
  CHECK(wrong == 0);
}

TEST_CASE("mannequin: SMPL's joints, and a regressor that finds them") {
  const std::vector<std::string> names{"pelvis",     "left_hip",      "right_hip",      "spine1",      "left_knee",
                                       "right_knee", "spine2",        "left_ankle",     "right_ankle", "spine3",
                                       "left_foot",  "right_foot",    "neck",           "left_collar", "right_collar",
                                       "head",       "left_shoulder", "right_shoulder", "left_elbow",  "right_elbow",
                                       "left_wrist", "right_wrist",   "left_hand",      "right_hand"};
  CHECK(body().joints == names);
  CHECK(body().parents ==
        std::vector<int>{-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21});

  const SkinWeights& regressor = body().regressor;
  REQUIRE(regressor.rows() == 24);
  REQUIRE(regressor.cols() == body().skin.rest.rows());
  CHECK(regressor.nonZeros() < 24 * 400);
  for (int j = 0; j < 24; ++j) {
    CHECK(regressor.row(j).sum() == Approx(1).margin(1e-12));
    CHECK(regressor.row(j).nonZeros() >= 12);
  }
  CHECK(std::all_of(regressor.valuePtr(), regressor.valuePtr() + regressor.nonZeros(), [](double w) { return w > 0; }));

  const Points joints = regressor * body().skin.rest;
  CHECK(row(joints, 0).norm() < 1e-9);
  CHECK((row(joints, joint("left_knee")) - Vec3(0.118, 0.475 - 0.94, 0)).norm() < 1e-9);
  CHECK((row(joints, joint("right_wrist")) - Vec3(-0.70, 1.386 - 0.94, -0.017)).norm() < 1e-9);
  CHECK(joints(joint("left_elbow"), 1) == Approx(joints(joint("left_shoulder"), 1)).margin(0.01));  // T-pose
  // A map that is affine takes the joints along.
  Mat3 stretch;
  stretch << 1.1, 0.2, 0, -0.1, 0.9, 0.05, 0.03, 0, 1.2;
  const Points mapped = (body().skin.rest * stretch.transpose()).rowwise() + Eigen::RowVector3d(0.1, 2, 3);
  const Points expected = (joints * stretch.transpose()).rowwise() + Eigen::RowVector3d(0.1, 2, 3);
  CHECK((regressor * mapped - expected).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("mannequin: weights are a smooth partition, and limbs belong to themselves") {
  const SkinWeights& weights = body().skin.weights;
  const Points& x = body().skin.rest;
  REQUIRE(weights.rows() == x.rows());
  REQUIRE(weights.cols() == 24);
  double worst_sum = 0, least = 1;
  int most = 0;
  for (int v = 0; v < x.rows(); ++v) {
    worst_sum = std::max(worst_sum, std::abs(weights.row(v).sum() - 1));
    int count = 0;
    double foreign = 0;  // of what should be no concern of the place
    for (SkinWeights::InnerIterator entry(weights, v); entry; ++entry, ++count) {
      least = std::min(least, entry.value());
      const std::string& name = body().joints[static_cast<std::size_t>(entry.col())];
      const bool arm = name == "left_shoulder" || name == "left_elbow" || name == "left_wrist" || name == "left_hand";
      if (x(v, 0) > 0.3 && !arm) foreign += entry.value();
      if (x(v, 1) < 0.68 - 0.94 && x(v, 0) > 0 && !name.starts_with("left_")) foreign += entry.value();
      if (x(v, 1) > 1.58 - 0.94 && name != "head") foreign += entry.value();
      if (x(v, 1) < 1.2 - 0.94 && (arm || name.ends_with("collar"))) foreign += entry.value();
    }
    if (foreign > 0.01) FAIL_CHECK(foreign << " pulled by other parts at " << x.row(v));
    most = std::max(most, count);
  }
  CHECK(worst_sum < 1e-12);
  CHECK(least > 0);
  CHECK(most <= 6);
  CHECK(most >= 3);
  const Eigen::MatrixXd dense(weights);
  double jump = 0;
  for (const auto& edge : surface().edges.rowwise())
    jump = std::max(jump, (dense.row(edge[0]) - dense.row(edge[1])).cwiseAbs().maxCoeff());
  CHECK(jump < 0.4);
}

TEST_CASE("mannequin: each shape does what it is called") {
  const Points& x = body().skin.rest;
  REQUIRE(body().skin.shape_directions.rows() == 3 * x.rows());
  REQUIRE(body().skin.shape_directions.cols() == static_cast<int>(mannequin_shapes.size()));
  CHECK(body().skin.pose_directions.cols() == 0);
  const auto change = [&](const std::string& name, const auto& measure) {
    return measure(with_shape(only(name, 1))) - measure(x);
  };
  const auto tall = [](const Points& at) { return size_of(at).y(); };
  const auto span = [](const Points& at) { return size_of(at).x(); };
  const auto leg = [](const Points& at) { return extent_at(at, 0.79, 1) - 0.04 - at.col(1).minCoeff(); };
  const auto hip_width = [](const Points& at) { return extent_at(at, 0.86, 0); };
  const auto hip_height = [](const Points& at) {
    const Points joints = body().regressor * at;
    return joints(1, 1) - joints(7, 1);
  };
  CHECK(change("height", tall) == Approx(0.035 * tall(x)));
  CHECK(change("weight", volume_of) > 5);
  CHECK(std::abs(change("weight", tall)) < 0.003);
  CHECK(change("leg_length", hip_height) > 0.014);
  CHECK(std::abs(change("leg_length", tall)) < 0.002);
  CHECK(change("leg_length", leg) > 0.014);
  CHECK(change("arm_length", span) == Approx(0.026).margin(0.003));
  CHECK(change("shoulder_width", span) == Approx(0.020).margin(0.002));
  CHECK(change("hip_width", hip_width) > 0.018);
  CHECK(std::abs(change("hip_width", span)) < 1e-9);
  CHECK(change("waist", [](const Points& at) { return extent_at(at, 1.08, 0); }) > 0.012);
  CHECK(change("chest", [](const Points& at) { return extent_at(at, 1.26, 2); }) > 0.009);
  CHECK(change("muscle", volume_of) > 1);
  CHECK(change("muscle", volume_of) < 5);
  CHECK(change("head_size", tall) == Approx(0.006).margin(0.002));
  CHECK((body().regressor * with_shape(only("muscle", 3)) - body().regressor * x).cwiseAbs().maxCoeff() < 0.02);
}

TEST_CASE("mannequin: free of self-intersection at three sigma") {
  check_shape(Eigen::VectorXd::Zero(10));
  std::mt19937_64 random(5);
  for (int i = 0; i < 12; ++i) {
    Eigen::VectorXd shape(10);
    for (double& value : shape) value = -3 + 6 * static_cast<double>(random() >> 11) * 0x1p-53;
    check_shape(shape);
  }
  for (const unsigned signs : {0u, 1023u, 341u, 682u, 0b0001000010u, 0b1110111101u}) {
    Eigen::VectorXd shape(10);
    for (int k = 0; k < 10; ++k) shape[k] = signs >> k & 1 ? 3 : -3;
    check_shape(shape);
  }
}

TEST_CASE("mannequin: the same bits twice, made anew or from a file") {
  const auto check_same = [](const BodyModel& other) {
    CHECK(other.name == body().name);
    CHECK(other.skin.rest == body().skin.rest);
    CHECK(other.skin.triangles == body().skin.triangles);
    CHECK(other.skin.shape_directions == body().skin.shape_directions);
    CHECK(Eigen::MatrixXd(other.skin.weights) == Eigen::MatrixXd(body().skin.weights));
    CHECK(Eigen::MatrixXd(other.regressor) == Eigen::MatrixXd(body().regressor));
  };
  const fake::Folder folder("mannequin_again");
  const auto file = folder.path / ("mannequin-" + std::to_string(mannequin_recipe) + ".h5");
  BodyModel marked = body();  // seen if the file is what is used
  marked.skin.rest(0, 1) += 1;
  write_body(file, marked);
  CHECK(kept_mannequin(folder.path).skin.rest == marked.skin.rest);
  std::filesystem::resize_file(file, 1000);
  check_same(kept_mannequin(folder.path));
  check_same(read_body(file));
  check_body(body(), "mannequin");
}

TEST_CASE("mannequin: the recipe's number goes with its tables") {
  // When this fails because the mannequin was changed: raise mannequin_recipe, and write the new sums here.
  const Form form = mannequin_form();
  double form_sum = 0, joint_sum = 0;
  for (int i = 0; i < 48; ++i)
    for (int j = 0; j < 24; ++j)
      form_sum += signed_value(form, Vec3(0.04 * (i % 24), 0.075 * j, i < 24 ? -0.05 : 0.08));
  for (const MannequinJoint& entry : mannequin_joints())
    joint_sum = 0.9 * joint_sum + entry.position.dot(Vec3(1, 2, 3));
  CHECK(mannequin_recipe == 1);
  CHECK(form_sum == Approx(261.6565464563).epsilon(1e-9));
  CHECK(joint_sum == Approx(21.5901970964).epsilon(1e-9));
  CHECK(body().skin.shape_directions.norm() == Approx(2.2845859568).epsilon(1e-3));
  CHECK(Eigen::MatrixXd(body().skin.weights).norm() == Approx(75.9532251826).epsilon(1e-3));
}

TEST_CASE("mannequin: bends at its joints and nowhere else") {
  const auto turned = [](const std::map<std::string, Vec3>& rotations) {
    BodyPose pose{Points::Zero(24, 3), Vec3::Zero()};
    for (const auto& [name, rotation] : rotations) pose.rotations.row(joint(name)) = rotation.transpose();
    return posed(body(), Eigen::VectorXd(), pose);
  };
  const Points& x = body().skin.rest;
  const double quarter = std::numbers::pi / 2;
  CHECK((turned({}) - x).cwiseAbs().maxCoeff() < 1e-12);

  const Points bent = turned({{"left_elbow", {0, 0, quarter}}, {"left_knee", {quarter, 0, 0}}});
  const Vec3 elbow = row(Points(body().regressor * x), joint("left_elbow"));
  for (int v = 0; v < x.rows(); ++v) {
    const Vec3 moved = row(bent, v) - row(x, v), arm = row(x, v) - elbow;
    if (x(v, 0) < 0 || (x(v, 1) > -0.2 && x(v, 0) < 0.3)) CHECK(moved.norm() < 1e-9);
    if (x(v, 0) > 0.55 && x(v, 1) > 0) CHECK((row(bent, v) - elbow - Vec3(-arm.y(), arm.x(), arm.z())).norm() < 1e-9);
  }
  CHECK(volume_of(bent) == Approx(volume_of(x)).epsilon(0.03));

  const Points arms_down = turned({{"left_shoulder", {0, 0, -1.3}}, {"right_shoulder", {0, 0, 1.3}}});
  CHECK(volume_of(arms_down) == Approx(volume_of(x)).epsilon(0.03));
  CHECK(arms_down.col(0).maxCoeff() < 0.4);
  const Points sitting = turned({{"left_hip", {-quarter, 0, 0}},
                                 {"right_hip", {-quarter, 0, 0}},
                                 {"left_knee", {quarter, 0, 0}},
                                 {"right_knee", {quarter, 0, 0}}});
  CHECK(volume_of(sitting) == Approx(volume_of(x)).epsilon(0.06));
  CHECK(sitting.col(2).maxCoeff() > 0.4);
  // Edges keep about their lengths, so that no skin is torn.
  for (const Points* pose : {&bent, &arms_down, &sitting})
    for (const auto& edge : surface().edges.rowwise())
      if ((row(*pose, edge[1]) - row(*pose, edge[0])).norm() > 0.06) FAIL_CHECK("torn at " << x.row(edge[0]));
}

}  // namespace selvedge::test_mannequin
