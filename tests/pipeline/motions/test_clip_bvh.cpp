#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/motions/clip_bvh.hpp"
#include "pipeline/shapes/motion.hpp"
#include "tests/pipeline/fake_skeleton.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/motions/fake_bvh.hpp"

namespace selvedge::test_clip_bvh {

namespace {

const double pi = std::numbers::pi;

const std::string two_joints = R"(HIERARCHY
ROOT Base
{
  OFFSET 1 2 3
  CHANNELS 6 Zposition Xposition Yposition Zrotation Xrotation Yrotation
  JOINT Upper Arm {
    OFFSET 0 10 0
    CHANNELS 3 Yrotation Zrotation Xrotation
    End Site
    { OFFSET 0 5 0 }
  }
}
MOTION
Frames: 2
Frame Time: 0.0416667
0 0 0 0 0 0   0 0 0
30 10 20 90 90 0   0 90 0
)";

Mat3 about(int axis, double degrees) { return rotation_matrix(degrees * pi / 180 * Vec3::Unit(axis)); }

using fake::mixamo;
using fake::Names;
using fake::Rig;
using fake::text_of;

// The body of the tests, ten units a metre, its arms hanging down by 45 degrees, its legs apart.
Rig arms_down() {
  Rig rig{mixamo, 10 * fake::skeleton(), {}};
  for (int side = 0; side < 2; ++side) {
    const double m = side ? -1 : 1;
    for (const int j : {18, 20, 22}) {
      const Vec3 pivot = row(rig.rest, 16 + side), arm = row(rig.rest, j + side) - pivot;
      rig.rest.row(j + side) = (pivot + about(2, -45 * m) * arm).transpose();
    }
    for (const int j : {4, 7, 10}) rig.rest(j + side, 0) += m * (j == 4 ? 0.4 : 0.8);
  }
  for (int f = 0; f < 6; ++f) {
    Points degrees = Points::Zero(24, 3);
    for (Eigen::Index j = 0; j < 24 && f > 0; ++j)
      for (int k = 0; k < 3; ++k) degrees(j, k) = 25 * std::sin(0.7 * f + 1.3 * static_cast<double>(j) + 2.1 * k);
    rig.frames.push_back(degrees);
  }
  return rig;
}

std::vector<Vec3> roots() {
  std::vector<Vec3> at;
  for (int f = 0; f < 6; ++f) at.emplace_back(3 * f, 0.2 * f, -2 * f);
  return at;
}

// Largest difference of the limbs' directions between file and clip. `turn` takes the file's axes to the clip's.
double limb_error(const BvhFile& bvh, const Clip& clip, const Points& joints, const Mat3& turn) {
  const std::vector<int> matched = matched_joints(bvh, {});
  double worst = 0;
  for (int f = 0; f < static_cast<int>(clip.poses.size()); ++f) {
    const BvhPose theirs = bvh_pose(bvh, f);
    const Points ours = fake::posed_joints(joints, clip.poses[static_cast<std::size_t>(f)]);
    for (const auto& [a, b] : std::vector<std::pair<int, int>>{{1, 4}, {4, 7}, {16, 18}, {18, 20}})
      for (const int side : {0, 1}) {
        const auto at = [&](int j) { return row(theirs.positions, matched[static_cast<std::size_t>(j + side)]); };
        const Vec3 wanted = turn * (at(b) - at(a)).normalized();
        worst = std::max(worst, (wanted - (row(ours, b + side) - row(ours, a + side)).normalized()).norm());
      }
  }
  return worst;
}

double lowest_foot(const Clip& clip, const Points& joints) {
  double lowest = 9;
  for (const BodyPose& pose : clip.poses) {
    const Points x = fake::posed_joints(joints, pose);
    for (const int j : {7, 8, 10, 11}) lowest = std::min(lowest, x(j, 1) - joints(j, 1));
  }
  return lowest;
}

}  // namespace

TEST_CASE("clip_bvh: a chain of two joints, by hand", "[clip]") {
  const BvhFile bvh = parse_bvh(two_joints, "two.bvh");
  REQUIRE(bvh.joints.size() == 2);
  CHECK((bvh.joints[1].name == "Upper Arm" && bvh.joints[1].parent == 0 && bvh.joints[1].first_channel == 6));
  CHECK((bvh.fps == 24 && bvh.motion.rows() == 2 && bvh.motion.cols() == 9));
  const BvhPose rest = bvh_pose(bvh, 0);
  CHECK(row(rest.positions, 1) == Vec3(1, 12, 3));
  const BvhPose pose = bvh_pose(bvh, 1);
  // Z by 90 outside X by 90: y goes to z first, and stays there.
  CHECK(row(pose.positions, 0).isApprox(Vec3(1 + 10, 2 + 20, 3 + 30)));
  CHECK(row(pose.positions, 1).isApprox(Vec3(11, 22, 43), 1e-12));
  CHECK(pose.rotations[1].isApprox(about(2, 90) * about(0, 90) * about(2, 90), 1e-12));
}

TEST_CASE("clip_bvh: hips below a root that does not move carry the figure's way", "[clip]") {
  const Points joints = fake::skeleton();
  const Rig rig = arms_down();
  const std::string direct = text_of(rig, roots());
  const Clip wanted = retargeted(parse_bvh(direct, "a.bvh"), joints, {});
  for (const bool whole : {false, true}) {  // position channels count from the parent, or from the offset
    std::vector<Vec3> moved = roots();
    if (whole)
      for (Vec3& at : moved) at += row(rig.rest, 0);
    std::string text = text_of(rig, moved);
    const std::string begin = "HIERARCHY\nROOT",
                      reference = "HIERARCHY\nROOT Reference\n{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT";
    text.replace(text.find(begin), begin.size(), reference);
    text.insert(text.find("MOTION"), "}\n");
    const Clip clip = retargeted(parse_bvh(text, "a.bvh"), joints, {});
    REQUIRE(clip.poses.size() == wanted.poses.size());
    for (std::size_t f = 0; f < clip.poses.size(); ++f)
      CHECK((clip.poses[f].translation - wanted.poses[f].translation).norm() < 1e-9);
    CHECK((clip.poses.back().translation - clip.poses.front().translation).norm() > 0.05);
  }
}

TEST_CASE("clip_bvh: errors name file and line", "[clip]") {
  const auto broken = [](const std::string& from, const std::string& to) {
    std::string text = two_joints;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  const auto fails = [](const std::string& text, const std::string& where, const std::string& what) {
    INFO(where << " " << what);
    CHECK_THROWS_WITH(parse_bvh(text, "two.bvh"), Catch::StartsWith("two.bvh:" + where + ":") && Catch::Contains(what));
  };
  fails("", "1", "HIERARCHY");
  fails("PK\x03", "1", "BVH");
  fails(broken("OFFSET 0 10 0", "OFFSET 0 ten 0"), "7", "ten");
  fails(broken("OFFSET 0 10 0", "OFFSET 0 nan 0"), "7", "finite");
  fails(broken("Yrotation Zrotation Xrotation\n", "Yrotation Zrotaton Xrotation\n"), "8", "Zrotation");
  fails(broken("Yrotation Zrotation Xrotation\n", "Yrotation Yrotation Xrotation\n"), "9", "twice");
  fails(broken("CHANNELS 3", "CHANNELS 7"), "8", "7");
  fails(broken("Upper Arm", "Base"), "6", "second joint `Base`");
  fails(broken("Frames: 2", "Frames: 3"), "17", "18 numbers");
  fails(broken("Frames: 2", "Frames: 0"), "15", "no frames");
  fails(broken("0.0416667", "0"), "15", "time of a frame");
  fails(broken("0.0416667", "1e-310"), "15", "time of a frame is 1e-310");
  fails(broken("0.0416667", "33.3"), "15", "time of a frame is 33.3");
  fails(broken("OFFSET 0 10 0", "OFFSET 0 1e308 0"), "7", "1e+308");
  fails(broken("30 10 20", "30 1e308 20"), "17", "1e+308");
  // A hundred million frames of nothing are as many poses.
  fails("HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 0 }\nMOTION Frames: 100000000 Frame Time: 1\n", "2", "no channels");
  fails(broken("30 10 20", "30 x 20"), "17", "`x`");
  fails(two_joints.substr(0, 120), "6", "ends");
  CHECK_THROWS_AS(read_bvh("/nowhere.bvh"), Error);
}

TEST_CASE("clip_bvh: common rigs are known by their names", "[clip]") {
  const auto count = [](const Names& names) {
    BvhFile bvh;
    for (const std::string& name : names)
      if (!name.empty()) bvh.joints.push_back({name, -1, {}, {}, 0});
    const std::vector<int> found = matched_joints(bvh, {});
    int right = 0;
    for (std::size_t j = 0; j < 24; ++j)
      if (found[j] >= 0) right += bvh.joints[static_cast<std::size_t>(found[j])].name == names[j] ? 1 : -100;
    return right;
  };
  CHECK(count(mixamo) == 22);
  Names prefixed = mixamo;
  for (std::string& name : prefixed)
    if (!name.empty()) name = "mixamorig:" + name;
  CHECK(count(prefixed) == 22);
  CHECK(count(smpl_joint_names(24)) == 24);
  CHECK(count({"Hips",
               "LeftUpLeg",
               "RightUpLeg",
               "LowerBack",
               "LeftLeg",
               "RightLeg",
               "Spine",
               "LeftFoot",
               "RightFoot",
               "Spine1",
               "LeftToeBase",
               "RightToeBase",
               "Neck1",
               "LeftShoulder",
               "RightShoulder",
               "Head",
               "LeftArm",
               "RightArm",
               "LeftForeArm",
               "RightForeArm",
               "LeftHand",
               "RightHand",
               "",
               ""}) == 22);
  CHECK(count({"root",
               "upperleg01.L",
               "upperleg01.R",
               "spine05",
               "lowerleg01.L",
               "lowerleg01.R",
               "spine03",
               "foot.L",
               "foot.R",
               "spine01",
               "toe1-1.L",
               "toe1-1.R",
               "neck01",
               "clavicle.L",
               "clavicle.R",
               "head",
               "upperarm01.L",
               "upperarm01.R",
               "lowerarm01.L",
               "lowerarm01.R",
               "wrist.L",
               "wrist.R",
               "",
               ""}) == 22);
  CHECK(count({"pelvis",     "thigh_l",    "thigh_r",    "spine_01",   "calf_l",  "calf_r",     "spine_02",   "foot_l",
               "foot_r",     "spine_03",   "ball_l",     "ball_r",     "neck_01", "clavicle_l", "clavicle_r", "head",
               "upperarm_l", "upperarm_r", "lowerarm_l", "lowerarm_r", "hand_l",  "hand_r",     "",           ""}) ==
        22);

  Names helped = mixamo;  // joints between the hips and a leg go by the leg's name with strokes before it
  helped.insert(helped.begin(), {"__LeftUpLeg", "__RightUpLeg"});
  BvhFile with_helpers;
  for (const std::string& name : helped)
    if (!name.empty()) with_helpers.joints.push_back({name, -1, {}, {}, 0});
  CHECK(matched_joints(with_helpers, {})[1] == 3);

  Names odd = mixamo;
  odd[4] = "Knie";
  BvhFile bvh;
  bvh.file = "odd.bvh";
  for (const std::string& name : odd)
    if (!name.empty()) bvh.joints.push_back({name, -1, {}, {}, 0});
  CHECK_THROWS_WITH(matched_joints(bvh, {}), Catch::Contains("odd.bvh") && Catch::Contains("left_knee"));
  CHECK(matched_joints(bvh, {{"left_knee", "Knie"}})[4] == 4);
  CHECK_THROWS_WITH(matched_joints(bvh, {{"left_knee", "Kni"}}), Catch::Contains("did you mean `Knie`"));
  CHECK_THROWS_WITH(matched_joints(bvh, {{"left_kne", "Knie"}}), Catch::Contains("did you mean `left_knee`"));
}

TEST_CASE("clip_bvh: limbs point where the file's do, whatever its rest pose, unit and axes", "[clip]") {
  const Rig rig = arms_down();
  const Points joints = fake::skeleton();
  const BvhOptions options{{}, 0, -1, 0.0};
  const BvhFile bvh = parse_bvh(text_of(rig, roots()), "rig.bvh");
  const Clip clip = retargeted(bvh, joints, options);
  REQUIRE(clip.poses.size() == 6);
  CHECK((clip.name == "rig" && clip.fps == 30 && clip.joints == smpl_joint_names(24)));
  CHECK(limb_error(bvh, clip, joints, Mat3::Identity()) < 1e-9);
  CHECK(std::abs(lowest_foot(clip, joints)) < 1e-9);
  // At rest only the limbs turn.
  for (const Eigen::Index j : {0, 3, 6, 9, 12, 13, 14, 15, 20, 21, 22, 23})
    CHECK(clip.poses[0].rotations.row(j).norm() < 1e-9);
  // By the least rotation, for an arm that is not quite square to z.
  CHECK((row(clip.poses[0].rotations, 16) - Vec3(0, 0, -pi / 4)).norm() < 0.1);
  // Legs of the rig are longer, since they stand apart.
  const double legs = limb_error(bvh, clip, joints, Mat3::Identity());
  const double scale =
      retargeted(bvh, joints, {{}, 0.1, -1, 0.0}).poses[1].translation.x() / clip.poses[1].translation.x();
  CHECK((scale > 1.001 && scale < 1.02 && legs < 1e-9));

  // The same with Z up, as Blender writes it: (x, y, z) to (x, -z, y).
  Mat3 z_up;
  z_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  BvhFile other = bvh;
  for (BvhJoint& joint : other.joints) joint.offset = z_up * joint.offset;
  for (Eigen::Index f = 0; f < other.motion.rows(); ++f) {
    other.motion.block<1, 3>(f, 0) = (z_up * Vec3(bvh.motion.block<1, 3>(f, 0).transpose())).transpose();
    for (std::size_t j = 0; j < other.joints.size(); ++j) {
      const Eigen::Index c = other.joints[j].first_channel + (j == 0 ? 3 : 0);
      const Vec3 xyz = bvh.motion.block<1, 3>(f, c).transpose();
      other.joints[j].channels.resize(j == 0 ? 3 : 0);
      // X by a, Y by b, Z by c become X by a, Z by b, -Y by c.
      for (const BvhChannel channel : {BvhChannel::x_rotation, BvhChannel::z_rotation, BvhChannel::y_rotation})
        other.joints[j].channels.push_back(channel);
      other.motion.block<1, 3>(f, c) << xyz[0], xyz[1], -xyz[2];
    }
  }
  const Clip same = retargeted(other, joints, options);
  for (std::size_t f = 0; f < 6; ++f) {
    CHECK((same.poses[f].rotations - clip.poses[f].rotations).norm() < 1e-9);
    CHECK((same.poses[f].translation - clip.poses[f].translation).norm() < 1e-9);
  }

  // A zero pose that is no standing person, as motion capture has it: a frame in which it stands serves as rest.
  Rig flat = rig;
  for (Eigen::Index j = 0; j < 24; ++j)
    flat.rest.row(j) = Eigen::RowVector3d(0, 0.1 * static_cast<double>(j), 10 * static_cast<double>(j % 5));
  CHECK_THROWS_WITH(retargeted(parse_bvh(text_of(flat, roots()), "flat.bvh"), joints, options),
                    Catch::Contains("flat.bvh") && Catch::Contains("rest_frame"));
  const Clip from_frame = retargeted(bvh, joints, {{}, 0, 0, 0.0});
  for (std::size_t f = 0; f < 6; ++f) CHECK((from_frame.poses[f].rotations - clip.poses[f].rotations).norm() < 1e-9);
  CHECK_THROWS_AS(retargeted(bvh, joints, {{}, 0, 6, 0.0}), Error);
  CHECK_THROWS_AS(retargeted(bvh, joints, {{}, -1, -1, 0.0}), Error);
}

TEST_CASE("clip_bvh: MakeHuman's walk and dance", "[clip]") {
  const std::filesystem::path folder = fake::open_data() / "makehuman";
  if (!std::filesystem::exists(folder / "walk1.bvh")) {
    WARN("skipped: no " << (folder / "walk1.bvh").string());
    return;
  }
  const Points joints = fake::skeleton();
  Mat3 y_up;  // the files are Z up
  y_up << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  for (const auto& [name, frames] : std::vector<std::pair<std::string, std::size_t>>{{"walk1", 14}, {"dance1", 1}}) {
    const BvhFile bvh = read_bvh(folder / (name + ".bvh"));
    const Clip clip = retargeted(bvh, joints, {{}, 0, -1, 0.0});
    REQUIRE(clip.poses.size() == frames);
    CHECK((clip.fps == 24 && clip.name == name));
    CHECK(limb_error(bvh, clip, joints, y_up) < 1e-9);
    CHECK(std::abs(lowest_foot(clip, joints)) < 1e-9);
    for (const BodyPose& pose : clip.poses) {
      const Points x = fake::posed_joints(joints, pose);
      CHECK((x(15, 1) > 1.3 && x(10, 1) < 0.5));                               // upright
      if (name == "walk1") CHECK((x(1, 0) > x(2, 0) && x(13, 0) > x(14, 0)));  // faces z
    }
  }
}

}  // namespace selvedge::test_clip_bvh
