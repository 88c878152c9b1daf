#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/motions/clip_amass.hpp"
#include "pipeline/shapes/motion.hpp"
#include "tests/pipeline/fake_npz.hpp"
#include "tests/pipeline/fake_skeleton.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_clip_amass {

namespace {

const double pi = std::numbers::pi;

// Value of column c in frame f, so that each is recognised.
double value(std::size_t f, std::size_t c) { return 0.001 * static_cast<double>(c) + 0.01 * static_cast<double>(f); }

template <class T>
std::string table(std::size_t frames, std::size_t columns, std::size_t first = 0) {
  std::vector<T> values;
  for (std::size_t f = 0; f < frames; ++f)
    for (std::size_t c = 0; c < columns; ++c) values.push_back(static_cast<T>(value(f, first + c)));
  return fake::npy<T>({frames, columns}, values);
}

template <class T>
fake::NpzEntries smplh(std::size_t frames) {
  std::vector<T> betas;
  for (int k = 0; k < 16; ++k) betas.push_back(static_cast<T>(0.25 * k));
  return {{"poses", table<T>(frames, 156)},
          {"trans", table<T>(frames, 3)},
          {"dmpls", table<T>(frames, 8)},
          {"betas", fake::npy<T>({16}, betas)},
          {"gender", fake::npy_of("'<U4'", false, "()", std::string("m\0\0\0a\0\0\0l\0\0\0e\0\0\0", 16))},
          {"mocap_framerate", fake::npy<double>({}, {120.0})}};
}

template <class T>
fake::NpzEntries smplx(std::size_t frames) {
  return {{"root_orient", table<T>(frames, 3)},
          {"pose_body", table<T>(frames, 63, 3)},
          {"pose_jaw", table<T>(frames, 3, 66)},
          {"pose_eye", table<T>(frames, 6, 69)},
          {"pose_hand", table<T>(frames, 90, 75)},
          {"trans", table<T>(frames, 3)},
          {"betas", fake::npy<T>({1, 10}, std::vector<T>(10, T(0.5)))},
          {"labels", fake::npy_of("'|O'", false, "(1, )", "not a pickle")},
          {"mocap_frame_rate", fake::npy<float>({}, {60.0F})}};
}

const Vec3 pelvis(0.1, 0.9, -0.2);

void check_rotations(const Clip& clip, std::size_t pose, std::size_t frame, double tolerance) {
  Points wanted(clip.poses[pose].rotations.rows(), 3);
  for (Eigen::Index j = 0; j < wanted.rows(); ++j)
    for (int k = 0; k < 3; ++k) wanted(j, k) = value(frame, static_cast<std::size_t>(3 * j + k));
  CHECK((clip.poses[pose].rotations - wanted).bottomRows(wanted.rows() - 1).cwiseAbs().maxCoeff() < tolerance);
}

}  // namespace

TEST_CASE("clip_amass: SMPL+H files in both precisions", "[clip]") {
  const fake::Folder folder("amass_h");
  const auto check = [&](const fake::NpzEntries& entries, double tolerance, bool compressed) {
    const auto path = fake::write_npz(folder.path / "walk_poses.npz", entries, compressed);
    std::vector<std::string> warnings;
    const Clip clip = read_amass(path, pelvis, warnings);
    CHECK((clip.name == "walk_poses" && clip.fps == 120 && clip.joints == smpl_joint_names(52)));
    REQUIRE(clip.poses.size() == 10);
    for (std::size_t f = 0; f < 10; ++f) check_rotations(clip, f, f, tolerance);
    REQUIRE(clip.shape.size() == 10);
    CHECK(clip.shape[9] == 2.25);
    CHECK(read_amass_shape(path, warnings, 16).size() == 16);
    CHECK(warnings.empty());
  };
  check(smplh<double>(10), 1e-12, false);
  check(smplh<float>(10), 1e-6, true);
}

TEST_CASE("clip_amass: angles that only degrees could mean are said", "[clip]") {
  const fake::Folder folder("amass_degrees");
  const auto warned = [&](std::size_t column, double angle) {
    std::vector<double> poses(2 * 72, 0);
    poses[72 + column] = angle;
    std::vector<std::string> warnings;
    read_amass(fake::write_npz(folder.path / "a.npz", {{"poses", fake::npy<double>({2, 72}, poses)},
                                                       {"trans", fake::npy<double>({2, 3}, std::vector<double>(6))},
                                                       {"mocap_framerate", fake::npy<double>({}, {60})}}),
               pelvis, warnings);
    return fake::lines(warnings);
  };
  CHECK_THAT(warned(12, 45), Catch::Contains("a.npz: poses turns a joint by 45 rad") && Catch::Contains("degrees"));
  CHECK(warned(12, 6.2).empty());
  CHECK(warned(1, 45).empty());  // the root
}

TEST_CASE("clip_amass: SMPL-X files", "[clip]") {
  const fake::Folder folder("amass_x");
  const auto path = fake::write_npz(folder.path / "x.npz", smplx<float>(7));
  std::vector<std::string> warnings;
  const Clip clip = read_amass(path, pelvis, warnings);
  CHECK(clip.joints == smpl_joint_names(55));
  REQUIRE(clip.poses.size() == 7);
  CHECK(clip.fps == 60);
  check_rotations(clip, 6, 6, 1e-6);
  // On SMPL's joints hands are dropped.
  const BodyPose pose = matched(clip.poses[1], clip.joints, smpl_joint_names(24));
  CHECK(pose.rotations.topRows(22) == clip.poses[1].rotations.topRows(22));
  CHECK(pose.rotations.bottomRows(2).isZero(0));

  // Without hands and face only the body is there.
  fake::NpzEntries body = smplx<double>(2);
  for (const std::string name : {"pose_hand", "pose_jaw", "pose_eye", "betas"}) body.erase(name);
  const Clip bare = read_amass(fake::write_npz(folder.path / "b.npz", body), pelvis, warnings);
  CHECK((bare.joints.size() == 22 && bare.joints.back() == "right_wrist" && bare.shape.size() == 0));
  // With hands alone the joints are SMPL+H's: root, body, hands.
  fake::NpzEntries handed = smplx<double>(2);
  for (const std::string name : {"pose_jaw", "pose_eye"}) handed.erase(name);
  handed["pose_hand"] = table<double>(2, 90, 66);
  const Clip hands = read_amass(fake::write_npz(folder.path / "h.npz", handed), pelvis, warnings);
  CHECK(hands.joints == smpl_joint_names(52));
  check_rotations(hands, 1, 1, 1e-12);
  fake::NpzEntries all = smplx<double>(2);
  all["poses"] = table<double>(2, 165);
  for (const std::string name : {"root_orient", "pose_body"}) all.erase(name);
  const Clip one = read_amass(fake::write_npz(folder.path / "o.npz", all), pelvis, warnings);
  CHECK(one.joints == smpl_joint_names(55));
  check_rotations(one, 1, 1, 1e-12);
}

TEST_CASE("clip_amass: Z up becomes Y up about the pelvis", "[clip]") {
  // The posed joints of the file, with (x, y, z) -> (x, z, -y) afterwards, are those of the clip.
  const fake::Folder folder("amass_up");
  fake::NpzEntries entries = smplh<double>(1);
  std::vector<double> poses(72, 0.0);
  const Vec3 upright(pi / 2, 0, 0);  // AMASS's bodies are turned to stand along z
  for (std::size_t k = 0; k < 3; ++k) poses[k] = upright[static_cast<int>(k)];
  poses[3 * 16 + 2] = 0.7;
  entries["poses"] = fake::npy<double>({1, 72}, poses);
  entries["trans"] = fake::npy<double>({1, 3}, {0.3, -2, 0.1});
  const Points joints = fake::skeleton();
  std::vector<std::string> warnings;
  const Clip clip = read_amass(fake::write_npz(folder.path / "u.npz", entries), row(joints, 0), warnings);
  REQUIRE(clip.joints == smpl_joint_names(24));
  BodyPose theirs{Points::Zero(24, 3), Vec3(0.3, -2, 0.1)};
  theirs.rotations.row(0) = upright.transpose();
  theirs.rotations(16, 2) = 0.7;
  const Points z_up = fake::posed_joints(joints, theirs), y_up = fake::posed_joints(joints, clip.poses[0]);
  for (int j = 0; j < 24; ++j) CHECK((row(y_up, j) - Vec3(z_up(j, 0), z_up(j, 2), -z_up(j, 1))).norm() < 1e-12);
  CHECK(y_up(15, 1) > y_up(10, 1) + 1);
}

TEST_CASE("clip_amass: what is missing or wrong is named", "[clip]") {
  const fake::Folder folder("amass_bad");
  const auto fails = [&](const fake::NpzEntries& entries, const std::string& what) {
    INFO(what);
    std::vector<std::string> warnings;
    CHECK_THROWS_WITH(read_amass(fake::write_npz(folder.path / "bad.npz", entries), pelvis, warnings),
                      Catch::Contains("bad.npz") && Catch::Contains(what));
  };
  const auto with = [](fake::NpzEntries entries, const std::string& name, const std::string& bytes) {
    if (bytes.empty())
      entries.erase(name);
    else
      entries[name] = bytes;
    return entries;
  };
  const fake::NpzEntries h = smplh<double>(5), x = smplx<double>(5);
  fails(with(h, "poses", ""), "root_orient");
  fails(with(h, "poses", table<double>(5, 150)), "150");
  fails(with(h, "poses", table<double>(4, 156)), "poses");
  fails(with(h, "poses", fake::npy<double>({156}, std::vector<double>(156, 0.0))), "poses");
  fails(with(h, "trans", ""), "trans");
  fails(with(h, "trans", table<double>(5, 4)), "trans");
  fails(with(h, "trans", table<double>(0, 3)), "no frames");
  fails(with(h, "mocap_framerate", ""), "mocap_frame");
  fails(with(h, "mocap_framerate", fake::npy<double>({}, {0.0})), "frame rate");
  fails(with(h, "mocap_framerate", fake::npy<double>({2}, {30.0, 30.0})), "frame rate");
  fails(with(h, "betas", table<double>(4, 10)), "4 rows");
  fails(with(h, "betas", fake::npy<double>({1, 1, 10}, std::vector<double>(10, 0.0))), "betas");
  fails(with(x, "pose_body", ""), "pose_body");
  fails(with(x, "pose_body", table<double>(5, 66)), "pose_body");
  fails(with(x, "pose_hand", table<double>(4, 90)), "pose_hand");
  std::vector<double> bad(15, 0.0);
  bad[7] = NAN;
  fails(with(h, "trans", fake::npy<double>({5, 3}, bad)), "finite");
  fails(with(h, "poses", fake::npy_of("'|O'", false, "(5, 156)", "pickle")), "poses");
  std::vector<std::string> warnings;
  CHECK_THROWS_AS(read_amass(folder.path / "none.npz", pelvis, warnings), Error);
}

TEST_CASE("clip_amass: of shapes by frame the first is taken, and that others differ is said", "[clip]") {
  const fake::Folder folder("amass_betas");
  fake::NpzEntries entries = smplh<double>(3);
  const auto shape = [&](const std::string& betas, std::vector<std::string>& warnings) {
    entries["betas"] = betas;
    const auto path = fake::write_npz(folder.path / "b.npz", entries);
    CHECK(read_amass(path, pelvis, warnings).shape.size() == 2);
    return read_amass_shape(path, warnings);
  };
  std::vector<std::string> none, said;
  CHECK(shape(fake::npy<double>({3, 2}, {1, 2, 1, 2, 1, 2}), none) == Eigen::Vector2d(1, 2));
  CHECK(none.empty());
  CHECK(shape(fake::npy<double>({3, 2}, {1, 2, 1, 2.5, 1, 2}), said) == Eigen::Vector2d(1, 2));
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("betas") && Catch::Contains("by 0.5") && Catch::Contains("frame 0"));
}

TEST_CASE("clip_amass: a length that its frames do not have is said", "[clip]") {
  const fake::Folder folder("amass_length");
  fake::NpzEntries entries = smplh<double>(240);  // 2 s
  const auto warnings = [&](double seconds) {
    entries["mocap_time_length"] = fake::npy<double>({}, {seconds});
    std::vector<std::string> all;
    read_amass(fake::write_npz(folder.path / "l.npz", entries), pelvis, all);
    return all;
  };
  CHECK(warnings(2).empty());
  REQUIRE(warnings(8).size() == 1);
  CHECK_THAT(warnings(8)[0], Catch::Contains("is 8 s") && Catch::Contains("are 2 s"));
}

}  // namespace selvedge::test_clip_amass
