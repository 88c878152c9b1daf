#include "pipeline/motions/t_pose.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/mannequin_form.hpp"
#include "pipeline/shapes/motion.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/pipeline/fake_makehuman.hpp"
#include "tests/pipeline/fake_skeleton.hpp"

namespace selvedge::test_t_pose {

namespace {

// Joints and nothing on them: SMPL's and two of a finger on the left wrist.
BodyModel with_finger() {
  BodyModel body;
  body.name = "bones";
  body.joints = smpl_joint_names(24);
  body.parents = smpl_joint_parents();
  body.joints.insert(body.joints.end(), {"left_index1", "left_index2"});
  body.parents.insert(body.parents.end(), {20, 24});
  return body;
}

Points with_finger(const Points& joints) {
  Points all(26, 3);
  all << joints, joints.row(22), joints.row(22) + Eigen::RowVector3d(0.03, 0, 0);
  return all;
}

Mat3 turn_of(const JointTransforms& transforms, int joint) {
  return transforms[static_cast<std::size_t>(joint)].leftCols<3>();
}

Vec3 direction(const Points& x, int from, int to) { return (row(x, to) - row(x, from)).normalized(); }

}  // namespace

TEST_CASE("t_pose: arms out are taken as SMPL's zero pose, arms down are not") {
  const BodyModel body = with_finger();
  CHECK_FALSE(t_pose(body, with_finger(fake::skeleton())));
  CHECK(arms_off_t_pose(fake::skeleton()) < 0.15);
  CHECK(arms_off_t_pose(fake::lowered(fake::skeleton())) > 0.7);
  BodyModel lacking = body;
  lacking.joints[4] = "knee";
  CHECK_THROWS_WITH(t_pose(lacking, with_finger(fake::skeleton())), Catch::Contains("left_knee"));
  lacking = body;
  lacking.joints[22] = "palm";  // the wrist stands in for a hand
  CHECK(row(smpl_joints(lacking, with_finger(fake::skeleton())), 22) == row(fake::skeleton(), 20));
}

TEST_CASE("t_pose: limbs go where the mannequin's are, the rest stays") {
  const BodyModel body = with_finger();
  const Points joints = with_finger(fake::lowered(fake::skeleton()));
  const std::optional<BodyPose> t = t_pose(body, joints);
  REQUIRE(t);
  const JointTransforms transforms = joint_transforms(body, joints, *t);
  const Points x = posed_joints(body, joints, *t);
  const auto model = mannequin_joints();
  for (const auto& [a, b] : std::vector<std::pair<int, int>>{{1, 4}, {4, 7}, {16, 18}, {18, 20}, {20, 22}})
    for (const int side : {0, 1}) {
      const Vec3 wanted =
          model[static_cast<std::size_t>(b + side)].position - model[static_cast<std::size_t>(a + side)].position;
      CHECK((direction(x, a + side, b + side) - wanted.normalized()).norm() < 1e-9);
    }
  for (const int j : {0, 3, 6, 9, 12, 13, 14, 15, 7, 8, 10, 11})  // trunk, head, collars and feet
    CHECK((turn_of(transforms, j) - Mat3::Identity()).norm() < 1e-9);
  for (const int j : {22, 24, 25}) CHECK((turn_of(transforms, j) - turn_of(transforms, 20)).norm() < 1e-9);
  // The elbow is a hinge that unbends: what was up on the forearm in the bend's plane is neither twisted nor tilted.
  const Vec3 hinge = direction(joints, 16, 18).cross(direction(joints, 18, 20)).normalized();
  CHECK((turn_of(transforms, 18) * hinge - turn_of(transforms, 16) * hinge).norm() < 0.12);
  CHECK((x.row(0) - joints.row(0)).norm() == 0);
}

TEST_CASE("t_pose: a clip moves every joint as it moves a body that was modelled in the T-pose") {
  const BodyModel body = with_finger();
  const Points joints = with_finger(fake::lowered(fake::skeleton()));
  const BodyPose t = *t_pose(body, joints);
  const JointTransforms to_t = joint_transforms(body, joints, t);
  const Points t_joints = posed_joints(body, joints, t);
  Clip clip{"any", 30, smpl_joint_names(52), {fake::pose(52, 3), fake::pose(52, 4, 1)}, {}};
  const Clip own = from_own_zero_pose(clip, body, joints, t);
  CHECK((own.joints == body.joints && own.fps == 30 && own.name == "any" && own.poses.size() == 2));
  for (std::size_t f = 0; f < 2; ++f) {
    const BodyPose wanted = matched(clip.poses[f], clip.joints, body.joints);
    CHECK(own.poses[f].translation == wanted.translation);
    CHECK((posed_joints(body, joints, own.poses[f]) - posed_joints(body, t_joints, wanted)).norm() < 1e-9);
    const JointTransforms a = joint_transforms(body, joints, own.poses[f]);
    const JointTransforms b = joint_transforms(body, t_joints, wanted);
    for (int j = 0; j < 26; ++j) CHECK((turn_of(a, j) - turn_of(b, j) * turn_of(to_t, j)).norm() < 1e-9);
  }
}

}  // namespace selvedge::test_t_pose
