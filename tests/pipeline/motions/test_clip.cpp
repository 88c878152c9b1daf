#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "pipeline/motions/clip.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge::test_clip {

namespace {

const double pi = std::numbers::pi;

Clip two_poses(const Vec3& from, const Vec3& to, double fps) {
  Clip clip{"two", fps, {"pelvis", "left_shoulder"}, {}, {}};
  for (const Vec3& rotation : {from, to}) {
    BodyPose pose{Points::Zero(2, 3), Vec3(0, 0, rotation.norm())};
    pose.rotations.row(1) = rotation.transpose();
    clip.poses.push_back(pose);
  }
  return clip;
}

// A second of a steady turn of the shoulder while the body walks along z, at 30 frames a second.
Clip steady() {
  Clip clip{"steady", 30, {"pelvis", "left_shoulder"}, {}, {}};
  for (int f = 0; f <= 30; ++f) {
    BodyPose pose{Points::Zero(2, 3), Vec3(0, 1, 1.2 * f / 30)};
    pose.rotations(0, 1) = 1;
    pose.rotations(1, 2) = -1 + 2.0 * f / 30;
    clip.poses.push_back(pose);
  }
  return clip;
}

Vec3 joint(const BodyPose& pose, Eigen::Index j) { return pose.rotations.row(j).transpose(); }

double angle_between(const Vec3& a, const Vec3& b) {
  return rotation_vector(rotation_matrix(a).transpose() * rotation_matrix(b)).norm();
}

}  // namespace

TEST_CASE("clip: rotations go along great arcs", "[clip]") {
  // A third of the way from 90 degrees about x to 90 about y: R(x, 90)^T R(y, 90) is a turn by 120 about (-1, 1, -1).
  const Clip clip = two_poses(Vec3(pi / 2, 0, 0), Vec3(0, pi / 2, 0), 1);
  const Mat3 third =
      rotation_matrix(Vec3(pi / 2, 0, 0)) * rotation_matrix(Vec3(-1, 1, -1) / std::sqrt(3) * (2 * pi / 9));
  CHECK((rotation_matrix(joint(pose_at(clip, 1.0 / 3), 1)) - third).norm() < 1e-12);
  CHECK(joint(pose_at(clip, 0.5), 0).isZero(0));

  // The shorter way: from 170 to -170 degrees through 180.
  const Clip over = two_poses(Vec3(0, 0, 17 * pi / 18), Vec3(0, 0, -17 * pi / 18), 1);
  CHECK(std::abs(joint(pose_at(over, 0.5), 1)[2]) == Approx(pi).epsilon(1e-9));

  // Ends are held, frames are met exactly.
  CHECK(pose_at(clip, -3).rotations == clip.poses[0].rotations);
  CHECK(pose_at(clip, 7).rotations == clip.poses[1].rotations);
  CHECK(pose_at(two_poses({1, 2, 3}, {0, 4, 0}, 30), 1 / 30.0).rotations.row(1) == Eigen::RowVector3d(0, 4, 0));
  CHECK_THROWS_AS(pose_at(Clip{}, 0), Error);
  CHECK(end_of(two_poses({1, 2, 3}, {0, 4, 0}, 4)) == 0.25);
}

TEST_CASE("clip: joints are matched by name", "[clip]") {
  const BodyPose pose = two_poses({1, 2, 3}, {4, 5, 6}, 1).poses[0];
  const BodyPose other = matched(pose, {"pelvis", "left_shoulder"}, {"jaw", "left_shoulder", "pelvis"});
  CHECK(joint(other, 0).isZero(0));
  CHECK(joint(other, 1) == Vec3(1, 2, 3));
  CHECK(other.translation == pose.translation);
}

TEST_CASE("clip: blending in starts at rest and passes frame 0 as the clip does", "[clip]") {
  const Clip clip = steady();
  for (const StartPose start : {StartPose::zero, StartPose::arms_down}) {
    const Clip blended = blended_in(clip, 0.5, start);
    REQUIRE(blended.poses.size() == 15 + 31);
    for (std::size_t f = 0; f < 31; ++f) CHECK(blended.poses[15 + f].rotations == clip.poses[f].rotations);
    CHECK(joint(blended.poses[0], 0).isApprox(Vec3(0, 1, 0), 1e-12));  // the heading
    CHECK(joint(blended.poses[0], 1).norm() == Approx(start == StartPose::zero ? 0 : pi / 4).margin(1e-12));
    CHECK(angle_between(joint(blended.poses[0], 1), joint(blended.poses[1], 1)) < 0.01);
    // The steady turn is 2/30 a frame and the walk 0.04; at frame 0 both are there without a jump.
    CHECK(angle_between(joint(blended.poses[14], 1), joint(blended.poses[15], 1)) == Approx(2 / 30.0).epsilon(0.05));
    for (std::size_t f = 0; f + 1 < blended.poses.size(); ++f) {
      const Vec3 way = blended.poses[f + 1].translation - blended.poses[f].translation;
      CHECK((way[2] >= 0 && way[2] < 0.0401));
      CHECK(angle_between(joint(blended.poses[f], 1), joint(blended.poses[f + 1], 1)) < 0.2);
    }
  }
  Points bent = Points::Zero(clip.poses[0].rotations.rows(), 3);
  bent.row(0) << 0.3, 0, 0;
  bent.row(1) << 0, 0.2, 0.5;
  const Clip other = blended_in(clip, 0.5, bent);
  CHECK(joint(other.poses[0], 1).isApprox(Vec3(0, 0.2, 0.5), 1e-12));
  const Mat3 turned = rotation_matrix(Vec3(0, 1, 0)) * rotation_matrix(Vec3(0.3, 0, 0));
  CHECK(rotation_matrix(joint(other.poses[0], 0)).isApprox(turned, 1e-12));
  CHECK(blended_in(clip, 0, StartPose::zero).poses.size() == clip.poses.size());
  CHECK_THROWS_AS(blended_in(clip, -1, StartPose::zero), Error);
}

}  // namespace selvedge::test_clip
