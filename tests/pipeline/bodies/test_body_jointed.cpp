#include "pipeline/bodies/body_jointed.hpp"

#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <numbers>
#include <numeric>

#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/bone_weights.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "pipeline/tools/dress.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_body_jointed {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// An open tube along X from x0 to x1.
struct Tube {
  static constexpr int around = 24;
  Points x;
  Triangles triangles;

  Tube(double x0, double x1, int rings, double radius, const Vec3& at = Vec3::Zero())
      : x(rings * around, 3), triangles(2 * (rings - 1) * around, 3) {
    for (int i = 0, t = 0; i < rings; ++i)
      for (int j = 0; j < around; ++j) {
        const double angle = 2 * std::numbers::pi * j / around, along = x0 + (x1 - x0) * i / (rings - 1);
        x.row(i * around + j) << along + at[0], radius * std::cos(angle) + at[1], radius * std::sin(angle) + at[2];
        if (i + 1 == rings) continue;
        const int a = i * around + j, b = i * around + (j + 1) % around;
        triangles.row(t++) << a, b, a + around;
        triangles.row(t++) << b, b + around, a + around;
      }
  }
  Surface surface() const { return make_surface(static_cast<int>(x.rows()), triangles); }
};

Points line_of_joints(const std::vector<double>& at) {
  Points joints = Points::Zero(static_cast<Eigen::Index>(at.size()), 3);
  for (std::size_t j = 0; j < at.size(); ++j) joints(static_cast<Eigen::Index>(j), 0) = at[j];
  return joints;
}

// The two side by side.
Tube both(const Tube& a, const Tube& b) {
  Tube all = a;
  all.x.conservativeResize(a.x.rows() + b.x.rows(), Eigen::NoChange);
  all.x.bottomRows(b.x.rows()) = b.x;
  all.triangles.conservativeResize(a.triangles.rows() + b.triangles.rows(), Eigen::NoChange);
  all.triangles.bottomRows(b.triangles.rows()) = b.triangles.array() + static_cast<int>(a.x.rows());
  return all;
}

std::string joints_file(const Points& joints, bool right = true) {
  std::string text = "joints:\n";
  const std::vector<std::string> names = smpl_joint_names(24);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const Vec3 p = row(joints, static_cast<int>(j));
    if (right || !names[j].starts_with("right_"))
      text += fmt::format("  {}: [{:.17g}, {:.17g}, {:.17g}]\n", names[j], p[0], p[1], p[2]);
  }
  return text;
}

}  // namespace

TEST_CASE("bone weights: on a long tube they pass from bone to bone as the known solution does", "[body_jointed]") {
  // w'' = (w - p) / r^2 with a step p at the joint: w = exp(-|x| / r) / 2 on the far side of it.
  const double radius = 0.05;
  const Tube tube(-1, 0.9, 761, radius);
  const SkinWeights weights = bone_weights(tube.surface(), tube.x, line_of_joints({-1, 0, 1}), {-1, 0, 1});
  double worst = 0;
  for (int v = 0; v < tube.x.rows(); ++v) {
    CHECK(weights.row(v).sum() == Approx(1));
    const double x = tube.x(v, 0);
    if (std::abs(x) > 0.3) continue;
    const double near = 0.5 * std::exp(-std::abs(x) / radius);
    worst = std::max(worst, std::abs(weights.coeff(v, 1) - (x > 0 ? 1 - near : near)));
  }
  CHECK(worst < 0.01);
}

TEST_CASE("bone weights: a bone behind the surface of another limb is not taken", "[body_jointed]") {
  // A thick trunk along X, and an arm beside it whose bone is nearer to the trunk's side than the trunk's own.
  const Tube trunk(-0.5, 0.5, 41, 0.15), arm(-0.5, 0.5, 41, 0.04, Vec3(0, 0.2, 0)), all = both(trunk, arm);
  Points joints(4, 3);
  joints << -0.5, 0, 0, 0.5, 0, 0, -0.5, 0.2, 0, 0.5, 0.2, 0;
  // 1 and 3 end the bones of 0 and 2; 2 hangs on 0 by a bone that leaves the trunk at its end.
  const SkinWeights weights = bone_weights(all.surface(), all.x, joints, {-1, 0, 0, 2});
  double trunk_of_arm = 0, arm_of_arm = 1;
  for (int v = 0; v < all.x.rows(); ++v) {
    if (std::abs(all.x(v, 0)) > 0.25) continue;
    if (v < trunk.x.rows())
      trunk_of_arm = std::max(trunk_of_arm, weights.coeff(v, 2));
    else
      arm_of_arm = std::min(arm_of_arm, weights.coeff(v, 2));
  }
  CHECK(trunk_of_arm < 0.1);
  CHECK(arm_of_arm > 0.9);
}

TEST_CASE("bone weights: a piece that sees no bone takes the nearest", "[body_jointed]") {
  const Tube tube(-1.2, 1.2, 97, 0.1);
  Tube all = tube;
  all.x.conservativeResize(tube.x.rows() + 3, Eigen::NoChange);
  all.x.bottomRows(3) << 0.5, 0.2, 0, 0.52, 0.2, 0, 0.5, 0.2, 0.02;
  all.triangles.conservativeResize(tube.triangles.rows() + 1, Eigen::NoChange);
  const int n = static_cast<int>(tube.x.rows());
  all.triangles.bottomRows(1) << n, n + 1, n + 2;
  const SkinWeights weights = bone_weights(all.surface(), all.x, line_of_joints({-1, 0, 1}), {-1, 0, 1});
  for (int v = n; v < n + 3; ++v) CHECK(weights.coeff(v, 1) == Approx(1));
}

TEST_CASE("jointed body: the mannequin's mesh and joints give a body that moves as the mannequin does",
          "[body_jointed]") {
  const Folder folder("body_jointed");
  const BodyModel& model = fake::mannequin();
  const Points joints = joint_positions(model, {});
  write_obj(folder.path / "mesh.obj", 10 * model.skin.rest, model.skin.triangles);
  fake::write(folder, "joints.yaml", joints_file(joints, false));
  BodyRequest request{folder.path / "mesh.obj", {}, {}, "dm", folder.path / "body.h5", folder.path / "joints.yaml"};
  const BodyReport report = convert_body(request);
  CHECK((report.closed && report.t_pose && report.joints == 24));
  const BodyModel body = read_body(request.out);
  CHECK((body.joints == smpl_joint_names(24) && body.parents == smpl_joint_parents()));
  CHECK((joint_positions(body, {}) - joints).rowwise().norm().maxCoeff() < 2e-4);  // the right side was mirrored

  BodyPose pose{Points::Zero(24, 3), Vec3::Zero()};
  pose.rotations(16, 2) = -1.2;  // left shoulder: the arm comes down
  pose.rotations(18, 1) = -1;    // elbow
  pose.rotations(1, 0) = -0.9;   // hip: the thigh is lifted
  pose.rotations(4, 0) = 1.2;    // knee
  pose.rotations(3, 0) = 0.3;    // back
  const Eigen::VectorXd off = (posed(body, {}, pose) - posed(model, {}, pose)).rowwise().norm();
  CHECK(off.mean() < 0.006);
  CHECK(off.maxCoeff() < 0.06);
}

// The mesh with its right half on vertices of its own, as a file has it where a texture has its seam.
Tube split_in_the_middle(const SkinnedSurface& skin, std::vector<int>& original) {
  Tube all(0, 1, 2, 1);
  all.triangles = skin.triangles;
  const int n = static_cast<int>(skin.rest.rows());
  const auto is_right_half = [&](Eigen::Index t) {
    return skin.rest(all.triangles(t, 0), 0) + skin.rest(all.triangles(t, 1), 0) + skin.rest(all.triangles(t, 2), 0) <
           0;
  };
  std::vector<char> left(static_cast<std::size_t>(n), 0);
  for (Eigen::Index t = 0; t < all.triangles.rows(); ++t)
    for (int k = 0; k < 3 && !is_right_half(t); ++k) left[static_cast<std::size_t>(skin.triangles(t, k))] = 1;
  original.resize(static_cast<std::size_t>(n));
  std::iota(original.begin(), original.end(), 0);
  std::vector<int> copy(static_cast<std::size_t>(n), -1);
  for (Eigen::Index t = 0; t < all.triangles.rows(); ++t) {
    if (!is_right_half(t)) continue;
    for (int k = 0; k < 3; ++k) {
      const int v = skin.triangles(t, k);
      int& twin = copy[static_cast<std::size_t>(v)];
      if (!left[static_cast<std::size_t>(v)]) continue;
      if (twin < 0) {
        twin = static_cast<int>(original.size());
        original.push_back(v);
      }
      all.triangles(t, k) = twin;
    }
  }
  all.x = skin.rest(original, Eigen::all);
  return all;
}

TEST_CASE("jointed body: a mesh that its file splits at a seam moves as the whole one", "[body_jointed]") {
  const Folder folder("body_jointed_split");
  const BodyModel& model = fake::mannequin();
  fake::write(folder, "joints.yaml", joints_file(joint_positions(model, {})));
  std::vector<int> original;
  const Tube split = split_in_the_middle(model.skin, original);
  REQUIRE(original.size() > static_cast<std::size_t>(model.skin.rest.rows()) + 20);
  write_obj(folder.path / "whole.obj", model.skin.rest, model.skin.triangles);
  write_obj(folder.path / "split.obj", split.x, split.triangles);
  const BodyModel whole = read_jointed(folder.path / "whole.obj", folder.path / "joints.yaml", 1);
  const BodyModel seamed = read_jointed(folder.path / "split.obj", folder.path / "joints.yaml", 1);
  double apart = 0, at_seam = 0;
  for (std::size_t v = 0; v < original.size(); ++v) {
    const Eigen::RowVectorXd mine = seamed.skin.weights.row(static_cast<Eigen::Index>(v)),
                             theirs = whole.skin.weights.row(original[v]), twin = seamed.skin.weights.row(original[v]);
    apart = std::max(apart, (mine - theirs).cwiseAbs().maxCoeff());
    at_seam = std::max(at_seam, (mine - twin).cwiseAbs().maxCoeff());
  }
  CHECK(at_seam == 0);
  CHECK(apart < 1e-6);
}

TEST_CASE("jointed body: what is wrong is named by file and line", "[body_jointed]") {
  const Folder folder("body_jointed_wrong");
  const BodyModel& model = fake::mannequin();
  const Points joints = joint_positions(model, {});
  write_obj(folder.path / "mesh.obj", model.skin.rest, model.skin.triangles);
  const auto refused = [&](const std::string& file, const std::string& what, const std::string& unit = "m") {
    fake::write(folder, "joints.yaml", file);
    BodyRequest request{folder.path / "mesh.obj", {}, {}, unit, folder.path / "body.h5", folder.path / "joints.yaml"};
    CHECK_THROWS_WITH(convert_body(request), Contains(what));
  };
  const std::string good = joints_file(joints), half = joints_file(joints, false);
  refused("joints: {}\n", "joints.pelvis");
  refused(good + "  left_thumb: [0, 0, 0]\n", "joints.yaml:26: `joints.left_thumb`");
  refused(good, "outside the body", "cm");
  Points off = joints;
  off(4, 2) += 0.3;
  refused(joints_file(off), "joints.yaml:6: `joints.left_knee` lies outside the body");
  off = joints;
  off(0, 0) += 0.06;
  refused(joints_file(off, false), "mirrored");
  fake::write(folder, "joints.yaml", good);
  BodyRequest twice{folder.path / "mesh.obj",   "a.mhskel", {}, "m", folder.path / "body.h5",
                    folder.path / "joints.yaml"};
  CHECK_THROWS_WITH(convert_body(twice), Contains("twice"));
}

TEST_CASE("jointed body: MakeHuman's body wears its helpers' skirt and tights and bows", "[body_jointed]") {
  const std::filesystem::path data = fake::open_data() / "makehuman";
  if (!std::filesystem::exists(data / "body.obj")) {
    WARN("skipped: no " << (data / "body.obj").string());
    return;
  }
  const Folder folder("body_jointed_real");
  BodyRequest body{data / "body.obj", {}, {}, "dm", folder.path / "body.h5", ""};
  body.joints = source_root() / "configs/real/makehuman_joints.yaml";
  const BodyReport made = convert_body(body);
  CHECK((made.vertices == 13380 && made.closed && !made.t_pose));
  for (const auto& [name, pairs] : {std::pair("skirt", 0), std::pair("tights", 96)}) {
    DressRequest dressing;
    dressing.mesh = data / fmt::format("helper_{}.obj", name);
    dressing.unit = "dm";
    dressing.body = body.out.string();
    dressing.out = folder.path / fmt::format("{}.h5", name);
    CHECK(dress(dressing).body_pairs == pairs);
    const std::filesystem::path scene = fake::write(
        folder, "scene.yaml",
        fmt::format("run: {{frames: 6}}\ncontact: {{thickness: 1 mm}}\ncloths: [{{garment: {{file: {}}}}}]\n"
                    "obstacles: [{{name: person, body: {{model: {}, clip: bow}}}}]\n",
                    dressing.out.string(), body.out.string()));
    const Setup setup = read_setup(scene);
    const RunSummary run = fake::run(setup, *make_stepper(setup), folder.path / name);
    CHECK(run.frames == 6);
    CHECK((run.pairs == run.worst_pairs && run.worst_frame == 0));  // none after frame 0
    CHECK((run.pairs > 0) == (pairs > 0));
  }
}

}  // namespace selvedge::test_body_jointed
