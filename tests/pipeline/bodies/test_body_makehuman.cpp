#include "pipeline/bodies/body_makehuman.hpp"

#include <catch2/catch.hpp>

#include <numbers>

#include "collision/exact/inside.hpp"
#include "collision/geometry/surface.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/motions/clip_bvh.hpp"
#include "pipeline/motions/clip_procedural.hpp"
#include "pipeline/motions/t_pose.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/pipeline/fake_makehuman.hpp"
#include "tests/pipeline/fake_skeleton.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_body_makehuman {

using Catch::Matchers::Contains;

namespace {

BodyModel read(const fake::Folder& folder, const fake::MakeHuman& rig) {
  const auto [mesh, skeleton, weights] = rig.write(folder);
  return read_makehuman(mesh, skeleton, weights, rig.unit);
}

// What reading says of a rig that was changed.
template <class Change>
std::string complaint(const fake::Folder& folder, const Change& change) {
  fake::MakeHuman rig(fake::skeleton());
  change(rig);
  return testing::refusal([&] { read(folder, rig); });
}

Points without_off(const Points& joints, const Vec3& off) { return joints.rowwise() - off.transpose(); }

// The real body with its weights, where the open data has them.
struct Real {
  std::filesystem::path folder = fake::open_data() / "makehuman";
  bool present(const std::string& mesh) const {
    if (std::filesystem::exists(folder / mesh)) return true;
    WARN("skipped: no " << (folder / mesh).string());
    return false;
  }
  BodyModel body(const std::filesystem::path& mesh) const {
    return read_makehuman(mesh, folder / "default.mhskel", folder / "default_weights.mhw", 0.1);
  }
};

void check_joints(const BodyModel& body, const Points& joints) {
  const Surface surface = make_surface(static_cast<int>(body.skin.rest.rows()), body.skin.triangles);
  const std::vector<char> within = inside(surface, body.skin.rest, joints);
  for (int j = 0; j < 24; ++j) {
    const std::string& name = body.joints[static_cast<std::size_t>(j)];
    INFO(name);
    CHECK(within[static_cast<std::size_t>(j)] == 1);
    const bool left = name.starts_with("left_");
    const int other = left ? j + 1 : name.starts_with("right_") ? j - 1 : j;
    CHECK((row(joints, j).cwiseProduct(Vec3(-1, 1, 1)) - row(joints, other)).norm() < 0.003);
  }
}

double volume_of(const BodyModel& body, const Points& x) {
  double sum = 0;
  for (const auto& t : body.skin.triangles.rowwise()) sum += row(x, t[0]).dot(row(x, t[1]).cross(row(x, t[2])));
  return sum / 6;
}

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

}  // namespace

TEST_CASE("makehuman: bones become SMPL's joints, weights and places come along") {
  const fake::Folder folder("makehuman");
  const Points joints = fake::skeleton();
  const fake::MakeHuman rig(joints);
  const BodyModel body = read(folder, rig);
  CHECK((body.name == "small" && body.joints == smpl_joint_names(24) && body.parents == smpl_joint_parents()));
  REQUIRE((body.skin.rest.rows() == 144 && body.skin.triangles.rows() == 192));
  CHECK((row(body.skin.rest, 6 * 4) - row(joints, 4) - Vec3(rig.radius, 0, 0)).norm() < 1e-12);  // metres
  CHECK(is_closed(make_surface(144, body.skin.triangles)));
  CHECK((body.skin.shape_directions.cols() == 0 && body.skin.pose_directions.cols() == 0));
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(144, 24);
  for (int v = 0; v < 144; ++v) {
    const int j = v / 6, parent = smpl_joint_parents()[static_cast<std::size_t>(j)];
    expected(v, j) += 0.5;
    expected(v, std::max(parent, 0)) += 0.5;
  }
  CHECK((Eigen::MatrixXd(body.skin.weights) - expected).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((without_off(joint_positions(body, {}), rig.off) - joints).cwiseAbs().maxCoeff() < 1e-9);

  // Without helpers a joint is where the skin bends, the root amid what bends about it.
  fake::MakeHuman bare = rig;
  bare.helpers = false;
  const BodyModel alone = read(folder, bare);
  CHECK(alone.skin.rest == body.skin.rest);
  const Points means = joint_positions(alone, {});
  CHECK((means - joints).bottomRows(23).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((row(means, 0) - row(joints, 0)).norm() < 0.05);

  // In a pose the middle of each octahedron stays where its joint is.
  const BodyPose pose = fake::pose(24);
  const Points x = posed(alone, {}, pose), expected_joints = fake::posed_joints(means, pose);
  for (int j = 1; j < 24; ++j) CHECK((x.middleRows(6 * j, 6).colwise().mean() - expected_joints.row(j)).norm() < 1e-9);
}

TEST_CASE("makehuman: vertices between those of the body are left out, its own stay in order") {
  const fake::Folder folder("makehuman_between");
  fake::MakeHuman rig(fake::skeleton());
  std::string text = rig.mesh();
  text.insert(text.find("f 133 "), "g other\n");  // the left hand
  text.insert(text.find("f 139 "), "g body\n");
  const auto [mesh, skeleton, weights] = rig.write(folder);
  fake::write(folder, "small.obj", text);
  // Nothing moves with the hand any more, and this is said.
  CHECK_THROWS_WITH(read_makehuman(mesh, skeleton, weights, 0.1), Contains("small.mhw") && Contains("left_hand"));
  for (int v = 120; v < 126; ++v) rig.weights["weights"]["finger4-1.L"].push_back({v, 0.1});  // of the wrist
  fake::write(folder, "small.mhw", rig.weights.dump());
  for (const char k : {'2', '3', '4', '5'})
    rig.skeleton["joints"][std::string("finger") + k + "-1.L____head"] = {120, 121};
  fake::write(folder, "small.mhskel", rig.skeleton.dump());
  const BodyModel body = read_makehuman(mesh, skeleton, weights, 0.1);
  REQUIRE(body.skin.rest.rows() == 138);
  CHECK((row(body.skin.rest, 132) - row(rig.joints, 23) - Vec3(rig.radius, 0, 0)).norm() < 1e-12);
  CHECK((row(joint_positions(body, {}), 22) - row(rig.joints, 20)).norm() < 1e-9);
}

TEST_CASE("makehuman: what is wrong with a rig is named by file and place") {
  const fake::Folder folder("makehuman_wrong");
  using Rig = fake::MakeHuman;
  CHECK(complaint(folder, [](Rig&) {}).empty());
  const auto skeleton = [&](const auto& change, const std::string& where, const std::string& what) {
    const std::string said = complaint(folder, [&](Rig& rig) { change(rig.skeleton); });
    INFO(said);
    CHECK_THAT(said, Contains("small.mhskel: " + where) && Contains(what));
  };
  using Json = nlohmann::json;
  skeleton([](Json& s) { s = Json::array(); }, "bones", "missing");
  skeleton([](Json& s) { s.erase("bones"); }, "bones", "missing");
  skeleton([](Json& s) { s.erase("joints"); }, "joints", "missing");
  skeleton([](Json& s) { s["bones"] = 3; }, "bones", "no object");
  skeleton([](Json& s) { s["bones"]["head"].erase("parent"); }, "bones/head/parent", "missing");
  skeleton([](Json& s) { s["bones"]["head"]["parent"] = 7; }, "bones/head/parent", "no text");
  skeleton([](Json& s) { s["bones"]["head"]["parent"] = "nack"; }, "bones/head/parent", "`nack` is no bone");
  skeleton([](Json& s) { s["bones"]["head"].erase("head"); }, "bones/head/head", "missing");
  skeleton([](Json& s) { s["joints"].erase("head____head"); }, "joints/head____head", "missing");
  skeleton([](Json& s) { s["joints"]["head____head"] = Json::array(); }, "joints/head____head", "empty");
  skeleton([](Json& s) { s["joints"]["head____head"] = {1, -2}; }, "joints/head____head[1]", "-2 is no vertex");
  skeleton([](Json& s) { s["joints"]["head____head"] = {1.5}; }, "joints/head____head[0]", "1.5 is no vertex");
  skeleton([](Json& s) { s["joints"]["head____head"] = {5000000000}; }, "joints/head____head[0]", "is no vertex");
  skeleton([](Json& s) { s["bones"]["root"]["parent"] = "foot.L"; }, "bones/", "hangs on itself");
  skeleton([](Json& s) { s["bones"]["eye.L"]["parent"] = "eye.L"; }, "bones/eye.L", "hangs on itself");
  skeleton([](Json& s) { s["bones"].erase("toe5-1.R"); }, "has no bone `toe5-1.R`", "right_foot");
  skeleton([](Json& s) { s["bones"]["spine05"]["parent"] = nullptr; }, "", "`spine05` hangs on none that is known");
  skeleton([](Json& s) { s["joints"]["head____head"] = {0, 1}; }, "", "puts the joint head outside");

  const auto weights = [&](const auto& change, const std::string& where, const std::string& what) {
    const std::string said = complaint(folder, [&](Rig& rig) { change(rig.weights); });
    INFO(said);
    CHECK_THAT(said, Contains("small.mhw: " + where) && Contains(what));
  };
  weights([](Json& w) { w.erase("weights"); }, "weights", "missing");
  weights([](Json& w) { w["weights"] = {1}; }, "weights", "no object");
  weights([](Json& w) { w["weights"]["foot.L"] = 1; }, "weights/foot.L", "no list");
  weights([](Json& w) { w["weights"]["tail"] = Json::array(); }, "weights/tail", "no bone of the skeleton");
  weights([](Json& w) { w["weights"]["foot.L"][2] = {1}; }, "weights/foot.L[2]", "no pair");
  weights([](Json& w) { w["weights"]["foot.L"][2] = {"1", 1}; }, "weights/foot.L[2][0]", "is no vertex");
  weights([](Json& w) { w["weights"]["foot.L"][2] = {1, "1"}; }, "weights/foot.L[2][1]", "no number");
  weights([](Json& w) { w["weights"]["foot.L"][2] = {1, 1.01}; }, "weights/foot.L[2]", "has the weight 1.01");
  weights([](Json& w) { w["weights"]["foot.L"][2] = {1, -0.1}; }, "weights/foot.L[2]", "has the weight -0.1");
  weights(
      [](Json& w) {
        for (Json& list : w["weights"])
          for (Json& entry : list)
            if (entry[0] == 70) entry[1] = 0;
      },
      "", "no weight for vertex 70");
  weights(
      [](Json& w) {  // each joint all for itself
        for (auto& [bone, list] : w["weights"].items())
          for (Json& entry : list)
            entry[1] = bone == "eye.L" && entry[0] < 144 && entry[0] >= 90 && entry[0] < 96 ? 1 : 0.5;
        for (Json& entry : w["weights"]["neck02"])
          if (entry[0] >= 90 && entry[0] < 96) entry[1] = 0;
      },
      "", "the joint head and its parent");

  const std::string mixed = complaint(folder, [](Rig& rig) {
    for (Json& list : rig.weights["weights"])
      for (Json& entry : list)
        if (entry[0] < 144) entry[0] = entry[0].get<int>() * 7 % 144;
  });
  CHECK_THAT(mixed, Contains("small.obj") && Contains("another order") && Contains("small.mhw"));
}

TEST_CASE("makehuman: files that are no JSON or not there are refused with the line") {
  const fake::Folder folder("makehuman_text");
  const fake::MakeHuman rig(fake::skeleton());
  const auto [mesh, skeleton, weights] = rig.write(folder);
  std::string text = rig.weights.dump(1);
  const auto refused = [&, m = mesh, s = skeleton, w = weights](const std::string& what) {
    CHECK_THROWS_WITH(read_makehuman(m, s, w, 0.1), Contains(what));
  };
  fake::write(folder, "small.mhw", text.substr(0, text.size() / 2));
  const auto lines = 1 + std::count(text.begin(), text.begin() + static_cast<long>(text.size() / 2), '\n');
  refused("small.mhw:" + std::to_string(lines) + ": is no JSON");
  text.replace(text.find(": ["), 3, ": {");
  fake::write(folder, "small.mhw", text);
  refused("is no JSON");
  fake::write(folder, "small.mhw", "{\n \"weights\":\n {\"root\": [[1, NaN]]}}");
  refused("small.mhw:3: is no JSON");
  fake::write(folder, "small.mhw", "{\"weights\": {\"root\": [[1, 1e999]]}}");
  refused("small.mhw: has a number that is too large");
  std::filesystem::remove(folder.path / "small.mhw");
  refused("small.mhw: cannot be opened");
  fake::write(folder, "small.mhskel", "");
  refused("small.mhskel:1: is no JSON");
  rig.write(folder);
  fake::write(folder, "small.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng hair\nf 1 2 3\ng body\nf 1 1 2\n");
  refused("small.obj: has no faces of a body");
}

TEST_CASE("makehuman: the command's conversion is what scenes read") {
  const fake::Folder folder("makehuman_convert");
  const fake::MakeHuman rig(fake::lowered(fake::skeleton()));
  const auto [mesh, skeleton, weights] = rig.write(folder);
  BodyRequest request{mesh, skeleton, weights, "dm", folder.path / "body.h5"};
  const BodyReport report = convert_body(request);
  CHECK((report.vertices == 144 && report.triangles == 192 && report.joints == 24 && report.shapes == 0));
  CHECK((report.closed && !report.t_pose));
  CHECK(report.arms_off > 0.7);
  const BodyModel read_back = read_body(request.out), direct = read_makehuman(mesh, skeleton, weights, 0.1);
  CHECK((read_back.skin.rest == direct.skin.rest && read_back.joints == direct.joints));
  CHECK(Eigen::MatrixXd(read_back.skin.weights) == Eigen::MatrixXd(direct.skin.weights));
  CHECK(joint_positions(read_back, {}) == joint_positions(direct, {}));
  CHECK(report.height == Approx(direct.skin.rest.col(1).maxCoeff() - direct.skin.rest.col(1).minCoeff()));
  CHECK_THAT(body_text(report), Contains("144 vertices") && Contains("clips are carried over"));
  CHECK(nlohmann::json::parse(body_json(report))["joints"] == 24);

  const auto refused = [&](const BodyRequest& wrong, const std::string& what) {
    CHECK_THROWS_WITH(convert_body(wrong), Contains(what));
  };
  refused({mesh, skeleton, weights, "ell", request.out}, "ell");
  refused({mesh, skeleton, weights, "dm", folder.path / "body.obj"}, "no .h5 file");
  refused({mesh, {}, weights, "dm", request.out}, "--skeleton");
  refused({request.out, skeleton, weights, "dm", request.out}, "neither a mesh");
}

TEST_CASE("makehuman: a body whose vertices were numbered anew is refused, not skinned at random") {
  const Real real;
  if (!real.present("body.obj")) return;
  CHECK_THROWS_WITH(real.body(real.folder / "body.obj"), Contains("body.obj") && Contains("another order"));
}

TEST_CASE("makehuman: the real body has its joints inside, with its helpers and without") {
  const Real real;
  if (!real.present("base.obj")) return;
  const BodyModel body = real.body(real.folder / "base.obj");
  const Mesh given = read_mesh(real.folder / "body.obj");
  REQUIRE((body.skin.rest.rows() == 13380 && body.skin.triangles.rows() == 26756));
  CHECK(is_closed(make_surface(13380, body.skin.triangles)));
  CHECK((body.skin.rest.colwise().sum() - 0.1 * given.x.colwise().sum()).norm() < 1e-6);  // it is body.obj
  for (int v = 0; v < 13380; ++v) REQUIRE(std::abs(body.skin.weights.row(v).sum() - 1) < 1e-12);
  const Points joints = joint_positions(body, {});
  check_joints(body, joints);
  CHECK((row(joints, 18) - Vec3(0.3129, 0.3493, 0.0132)).norm() < 2e-4);  // the elbow's helpers

  const fake::Folder folder("makehuman_bare");
  write_obj(folder.path / "bare.obj", body.skin.rest / 0.1, body.skin.triangles);
  const BodyModel bare = real.body(folder.path / "bare.obj");
  CHECK((bare.skin.rest - body.skin.rest).cwiseAbs().maxCoeff() < 1e-12);
  const Points means = joint_positions(bare, {});
  check_joints(bare, means);
  CHECK((means - joints).rowwise().norm().maxCoeff() < 0.11);  // the chest; the others
  CHECK((means - joints).rowwise().norm().mean() < 0.04);
}

TEST_CASE("makehuman: the real body does as the mannequin does in the same clip") {
  const Real real;
  if (!real.present("base.obj")) return;
  const BodyModel body = real.body(real.folder / "base.obj"), mannequin = make_mannequin();
  const Points joints = joint_positions(body, {}), model = joint_positions(mannequin, {});
  const std::optional<BodyPose> t = t_pose(body, joints);
  REQUIRE(t);
  REQUIRE_FALSE(t_pose(mannequin, model));
  const Points t_joints = posed_joints(body, joints, *t);
  const double floor = posed(body, {}, *t).col(1).minCoeff(), model_floor = mannequin.skin.rest.col(1).minCoeff();
  const double volume = volume_of(body, body.skin.rest);
  CHECK(volume == Approx(0.055).margin(0.02));
  const auto made = [&](const std::string& name, const Points& at, double soles) {
    if (!name.ends_with(".bvh")) return make_clip(name, at, soles);
    return retargeted(read_bvh(real.folder / name), at, {{}, 0, -1, soles});
  };
  for (const std::string name : {"walk", "arms_up_down", "bow", "spin", "walk1.bvh"}) {
    INFO(name);
    const Clip clip = from_own_zero_pose(made(name, t_joints, floor), body, joints, *t);
    const Clip theirs = made(name, model, model_floor);
    REQUIRE(clip.poses.size() == theirs.poses.size());
    double off = 0, hands_off = 0, least = 1, most = 0, low = 1, high = -1;
    for (std::size_t f = 0; f < clip.poses.size(); f += 5) {
      const Points x = posed(body, {}, clip.poses[f]);
      REQUIRE(x.allFinite());
      const double share = volume_of(body, x) / volume;
      least = std::min(least, share), most = std::max(most, share);
      low = std::min(low, x.col(1).minCoeff()), high = std::max(high, x.col(1).minCoeff());
      const Points a = posed_joints(body, joints, clip.poses[f]), b = posed_joints(mannequin, model, theirs.poses[f]);
      const auto angle = [&](int from, int to) {
        return degrees_between(row(a, to) - row(a, from), row(b, to) - row(b, from));
      };
      for (const int side : {0, 1}) {
        off = std::max({off, angle(16 + side, 18 + side), angle(18 + side, 20 + side)});
        hands_off = std::max(hands_off, angle(20 + side, 22 + side));
      }
    }
    INFO("arms off " << off << ", hands off " << hands_off << " degrees, volume " << least << " to " << most
                     << ", lowest point " << low << " to " << high);
    CHECK(off < 3);
    CHECK(hands_off < 5);
    CHECK((least > 0.9 && most < 1.1));
    CHECK((low > -0.03 && high < (name.ends_with(".bvh") ? 0.05 : 0.01)));
  }
}

}  // namespace selvedge::test_body_makehuman
