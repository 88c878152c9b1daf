#include "pipeline/garments/garment.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_garment {

namespace {

const BodyModel& mannequin() {
  static const BodyModel body = kept_mannequin(cache_folder());
  return body;
}

// The body's own surface, moved outward along the rays from its joint chain: a copy 1 % larger in x and z.
Points around(const BodyModel& body, double scale) {
  Points x = body.skin.rest;
  x.col(0) *= scale;
  x.col(2) *= scale;
  return x;
}

BodyPose bent() {
  BodyPose pose{Points::Zero(24, 3), Vec3(0.1, 0.2, 0.3)};
  pose.rotations.row(4) << 0.9, 0, 0;
  pose.rotations.row(16) << 0, 0.2, -0.8;
  return pose;
}

Eigen::VectorXd person() {
  Eigen::VectorXd shape(10);
  shape << 1, -0.5, 0.4, 0, 1.2, 0, -1, 0.3, 0, 0.5;
  return shape;
}

}  // namespace

TEST_CASE("A tight garment that is the body's own surface goes where the body goes", "[garment]") {
  const BodyModel& body = mannequin();
  const Garment garment{"skin", attached(body.skin.rest, body.skin.triangles, body, Fit::tight), {}, {}, {}};
  const Points cloth = skinned(garment, body, person(), bent()), skin = posed(body, person(), bent());
  CHECK((cloth - skin).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((rest_shape(garment, body, person()) - shaped(body.skin, person())).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("Weights of garments sum to 1, and loose ones are averages", "[garment]") {
  const BodyModel& body = mannequin();
  const Points x = around(body, 1.1);
  for (const Fit fit : {Fit::tight, Fit::loose}) {
    const SkinnedSurface skin = attached(x, body.skin.triangles, body, fit);
    for (int v = 0; v < x.rows(); ++v) CHECK(skin.weights.row(v).sum() == Approx(1).margin(1e-12));
  }
  // Halfway between the knees both legs count alike.
  Points between(1, 3);
  between << 0, body.skin.rest(0, 1), 0;
  between(0, 1) = joint_positions(body, {})(4, 1);
  const SkinnedSurface loose = attached(between, Triangles(0, 3), body, Fit::loose);
  const Eigen::RowVectorXd weights = loose.weights.row(0);
  CHECK(weights[1] == Approx(weights[2]).margin(1e-3));
  CHECK(weights[4] == Approx(weights[5]).margin(1e-3));
  CHECK(weights[1] + weights[4] > 0.3);
  const SkinnedSurface tight = attached(between, Triangles(0, 3), body, Fit::tight);
  const Eigen::RowVectorXd one_leg = tight.weights.row(0);
  CHECK(std::abs(one_leg[1] + one_leg[4] - one_leg[2] - one_leg[5]) > 0.9);
}

TEST_CASE("A garment made in another pose has its rest shape there", "[garment]") {
  const BodyModel& body = mannequin();
  Garment garment{"skin", attached(body.skin.rest, body.skin.triangles, body, Fit::tight), bent(), {}, {}};
  CHECK((rest_shape(garment, body, person()) - posed(body, person(), bent())).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("Attaching gives the same bits with any number of threads", "[garment]") {
  const BodyModel& body = mannequin();
  const Points x = around(body, 1.2);
  const SkinnedSurface two = attached(x, body.skin.triangles, body, Fit::loose);
  with_threads(1, [&] {
    const SkinnedSurface one = attached(x, body.skin.triangles, body, Fit::loose);
    CHECK(one.shape_directions == two.shape_directions);
    CHECK((one.weights - two.weights).norm() == 0);
  });
  CHECK_THROWS_AS(attached(Points(0, 3), Triangles(0, 3), body, Fit::tight), Error);
}

}  // namespace selvedge::test_garment
