#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/motions/clip_procedural.hpp"
#include "pipeline/motions/clip_procedural_track.hpp"
#include "pipeline/motions/clip_split.hpp"
#include "pipeline/shapes/motion.hpp"
#include "tests/pipeline/fake_skeleton.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_clip_procedural {

namespace {

struct Body {
  std::string name;
  Points joints;
  double floor;
};

// As measured, a child's size with the floor left to be guessed, and far off with long legs.
std::vector<Body> bodies() {
  std::vector<Body> some = {{"upright", fake::skeleton(), 0},
                            {"small", fake::skeleton(0.7, 0.9), 0},
                            {"tall", fake::skeleton(1.05, 1.15), -1.2}};
  some[1].floor = 0.7 * 0.025 - 0.02 * measured(some[1].joints, 0).leg;
  some[2].joints.col(1).array() -= 1.2;
  return some;
}

const std::set<std::string> gaits = {"walk",          "walk_slow", "walk_fast", "walk_arms", "walk_turning",
                                     "walk_backward", "strut",     "march",     "sneak",     "run"};

struct Pace {
  double speed = 0, change = 0;  // rad/s, rad/s^2
  std::string where;
};

Pace pace(const Clip& clip) {
  Pace worst;
  for (Eigen::Index j = 0; j < 24; ++j) {
    Vec3 before = Vec3::Zero();
    for (std::size_t f = 0; f + 1 < clip.poses.size(); ++f) {
      const auto turn = [&](std::size_t at) { return rotation_matrix(clip.poses[at].rotations.row(j).transpose()); };
      const Vec3 speed = clip.fps * rotation_vector(turn(f).transpose() * turn(f + 1));
      const double change = clip.fps * (speed - before).norm();
      if (change > worst.change)
        worst.where = clip.joints[static_cast<std::size_t>(j)] + " in frame " + std::to_string(f);
      worst.speed = std::max(worst.speed, speed.norm());
      worst.change = std::max(worst.change, change);
      before = speed;
    }
  }
  return worst;
}

std::vector<Points> positions(const Clip& clip, const Points& joints) {
  std::vector<Points> all;
  for (const BodyPose& pose : clip.poses) all.push_back(fake::posed_joints(joints, pose));
  return all;
}

// How far a foot slides at most while it stands, and in how many frames it does.
std::pair<double, int> slide(const std::vector<Points>& x, int foot, double height) {
  double worst = 0;
  int frames = 0;
  std::size_t begin = 0;
  for (std::size_t f = 0; f < x.size(); ++f) {
    if (x[f](foot, 1) > height + 0.001) {
      begin = f + 1;
      continue;
    }
    ++frames;
    for (std::size_t g = begin; g < f; ++g) worst = std::max(worst, (x[f].row(foot) - x[g].row(foot)).norm());
  }
  return {worst, frames};
}

}  // namespace

TEST_CASE("clip_procedural: every clip is finite and moves as a person could, on bodies of any size", "[clip]") {
  for (const Body& body : bodies())
    for (const std::string& name : procedural_clip_names()) {
      INFO(body.name << ", " << name);
      const Clip clip = make_clip(name, body.joints, body.name == "small" ? std::nullopt : std::optional(body.floor));
      REQUIRE((clip.poses.size() >= 60 && clip.poses.size() <= 300));
      CHECK((clip.name == name && clip.fps == 30 && clip.joints == smpl_joint_names(24)));
      REQUIRE(std::all_of(clip.poses.begin(), clip.poses.end(), [](const BodyPose& pose) {
        return pose.rotations.rows() == 24 && pose.rotations.allFinite() && pose.translation.allFinite();
      }));
      const Pace most = pace(clip);
      INFO(most.where << ": " << most.speed << " rad/s, " << most.change << " rad/s2");
      CHECK((most.speed < 18 && most.change < (gaits.contains(name) ? 550 : 200)));
      for (std::size_t f = 2; f < clip.poses.size(); ++f) {
        const Vec3 push =
            900 * (clip.poses[f].translation - 2 * clip.poses[f - 1].translation + clip.poses[f - 2].translation);
        if (push.norm() >= 40) FAIL_CHECK("the body is pushed by " << push.norm() << " m/s2 in frame " << f);
      }
      // Begins and ends at rest.
      const std::size_t last = clip.poses.size() - 1;
      CHECK((clip.poses[1].rotations - clip.poses[0].rotations).cwiseAbs().maxCoeff() < 0.002);
      CHECK((clip.poses[last].rotations - clip.poses[last - 1].rotations).cwiseAbs().maxCoeff() < 0.002);
    }
}

TEST_CASE("clip_procedural: joints bend the way they do and no farther", "[clip]") {
  for (const Body& body : bodies())
    for (const std::string& name : procedural_clip_names()) {
      const Clip clip = make_clip(name, body.joints, body.floor);
      Eigen::Array3d knees_low(9, 9, 9), knees_high(-9, -9, -9);
      double straightest_elbow = 9, most_elbow = -9, neck = 0, spine = 0, hips = 0, ankles = 0, collars = 0;
      for (const BodyPose& pose : clip.poses) {
        const auto angle = [&](int j) { return pose.rotations.row(j).norm(); };
        for (int side = 0; side < 2; ++side) {
          knees_low = knees_low.min(pose.rotations.row(4 + side).transpose().array());
          knees_high = knees_high.max(pose.rotations.row(4 + side).transpose().array());
          const double bend = (side ? 1 : -1) * pose.rotations(18 + side, 1);
          straightest_elbow = std::min(straightest_elbow, bend);
          most_elbow = std::max(most_elbow, angle(18 + side));
          hips = std::max(hips, angle(1 + side));
          ankles = std::max(ankles, angle(7 + side));
          collars = std::max(collars, angle(13 + side));
        }
        neck = std::max({neck, angle(12), angle(15)});
        spine = std::max({spine, angle(3), angle(6), angle(9)});
      }
      INFO(body.name << ", " << name << ": knees " << knees_low.transpose() << " to " << knees_high.transpose()
                     << ", elbows " << straightest_elbow << " to " << most_elbow << ", hips " << hips << ", ankles "
                     << ankles << ", collars " << collars << ", neck " << neck << ", spine " << spine);
      CHECK((knees_low[0] > 0 && knees_high[0] < 2.6));
      CHECK((knees_low.tail<2>() > -0.35).all());
      CHECK((knees_high.tail<2>() < 0.35).all());
      CHECK((straightest_elbow > -0.05 && most_elbow < 2.6));
      CHECK((hips < 2.6 && ankles < 1.2 && collars < 0.6 && neck < 0.4 && spine < 0.4));
    }
}

TEST_CASE("clip_procedural: feet that stand stay where they are, and nothing goes under the ground", "[clip]") {
  for (const Body& body : bodies())
    for (const std::string& name : procedural_clip_names()) {
      INFO(body.name << ", " << name);
      const std::vector<Points> x = positions(make_clip(name, body.joints, body.floor), body.joints);
      double lowest = 9, lowest_foot = 9;
      for (const Points& frame : x) {
        lowest = std::min(lowest, frame.col(1).minCoeff());
        for (const int foot : {10, 11})
          lowest_foot = std::min(lowest_foot, frame(foot, 1) - (body.joints(foot, 1) - body.floor));
      }
      CHECK(lowest_foot > -1e-9);
      CHECK(lowest > 0.4 * (body.joints(10, 1) - body.floor));
      int standing_frames = 0;
      for (const int foot : {10, 11}) {
        const auto [way, frames] = slide(x, foot, body.joints(foot, 1) - body.floor);
        CHECK(way < 0.005);
        standing_frames += frames;
      }
      CHECK(standing_frames > (name == "run" ? 0.6 : 0.9) * static_cast<double>(x.size()));  // of two feet
    }
}

TEST_CASE("clip_procedural: walks get somewhere, in proportion to the legs", "[clip]") {
  const auto way = [](const std::string& name, const Points& joints) -> Vec3 {
    const Clip clip = make_clip(name, joints);
    return clip.poses.back().translation - clip.poses.front().translation;
  };
  const Points one = fake::skeleton(), half = fake::skeleton(0.5);
  CHECK(way("walk", one).z() > 3);
  CHECK(way("walk", half).z() == Approx(0.5 * way("walk", one).z()).epsilon(1e-3));
  CHECK(way("walk_backward", one).z() < -2);
  CHECK(way("run", one).z() > way("walk_fast", one).z());
  CHECK(way("idle", one).norm() < 1e-9);
  CHECK(std::abs(way("walk_turning", one).x()) > 1);
}

TEST_CASE("clip_procedural: the same bits twice; unknown names and bodies are refused", "[clip]") {
  const Points joints = fake::skeleton();
  for (const std::string name : {"run", "hug"}) {
    const Clip a = make_clip(name, joints), b = make_clip(name, joints);
    for (std::size_t f = 0; f < a.poses.size(); ++f)
      REQUIRE((a.poses[f].rotations == b.poses[f].rotations && a.poses[f].translation == b.poses[f].translation));
  }
  CHECK_THROWS_WITH(make_clip("wolk", joints), Catch::Contains("did you mean `walk`"));
  CHECK_THROWS_AS(make_clip("walk", joints.topRows(22)), Error);
  CHECK_THROWS_AS(make_clip("walk", -joints), Error);
  CHECK_THROWS_AS(make_clip("walk", Points::Zero(24, 3)), Error);
  Points mirrored = joints;
  mirrored.col(0) *= -1;
  CHECK_THROWS_WITH(make_clip("walk", mirrored), Catch::Contains("sides"));
  CHECK_THROWS_WITH(make_clip("walk", joints, 0.5), Catch::Contains("floor"));
}

TEST_CASE("clip_procedural: keys are met softly", "[clip]") {
  // A ramp averaged three times: at its kink w/24 * (1.5^4 - 3 * 0.5^4), away from it itself.
  CHECK(smooth_ramp(0, 1) == Approx((5.0625 - 3 * 0.0625) / 24));
  CHECK(smooth_ramp(-2, 1) == 0);
  CHECK(smooth_ramp(1.5, 1) == 1.5);
  CHECK(smooth_ramp(1.5 - 1e-9, 1) == Approx(1.5));
  const std::vector<double> times = {0, 1, 2, 3}, values = {1, 1, 4, 4};
  CHECK(smooth_between(times, values, 0.2, 0.5) == 1);
  CHECK(smooth_between(times, values, 0.2, 1.5) == Approx(2.5));
  CHECK(smooth_between(times, values, 0.2, 9) == Approx(4));
  double before = 1;
  for (double t = 0; t < 3; t += 0.01) {
    const double now = smooth_between(times, values, 0.3, t);
    CHECK((now >= before - 1e-12 && now < 4 + 1e-12));
    before = now;
  }
}

TEST_CASE("clip_procedural: the split names every clip once, eight of them for validation", "[clip]") {
  const auto path = source_root() / "configs" / "clips.yaml";
  const std::vector<ClipEntry> entries = read_clip_split(path);
  std::vector<std::string> names = procedural_clip_names(), listed;
  for (const ClipEntry& entry : entries) {
    listed.push_back(entry.name);
    CHECK(make_clip(entry.name, fake::skeleton()).poses.size() == static_cast<std::size_t>(entry.frames));
  }
  std::sort(names.begin(), names.end());
  std::sort(listed.begin(), listed.end());
  CHECK(names == listed);
  CHECK(names.size() >= 24);
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
  CHECK(std::count_if(entries.begin(), entries.end(), [](const ClipEntry& entry) { return entry.validation; }) == 8);

  const fake::Folder folder("clip_split");
  const auto split = [&](const std::string& text) { return read_clip_split(fake::write(folder, "c.yaml", text)); };
  const std::string walk = "{name: walk, frames: 180, split: training}";
  CHECK(split("clips: [" + walk + "]").size() == 1);
  CHECK_THROWS_WITH(split("clips:\n- " + walk + "\n- " + walk),
                    Catch::Contains("c.yaml:3") && Catch::Contains("twice"));
  CHECK_THROWS_WITH(split("clips: [{name: wolk, frames: 180, split: training}]"), Catch::Contains("`walk`"));
  CHECK_THROWS_WITH(split("clips: [{name: walk, frames: 180, split: test}]"), Catch::Contains("validation"));
  CHECK_THROWS_AS(split("clips: [{name: walk, split: training}]"), Error);
}

}  // namespace selvedge::test_clip_procedural
