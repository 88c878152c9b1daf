#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "physics/scene/make_scene.hpp"
#include "pipeline/measures/hood_measure.hpp"
#include "pipeline/measures/minimise.hpp"
#include "pipeline/measures/motion_measures.hpp"
#include "pipeline/measures/published_measures.hpp"
#include "pipeline/measures/run_measures.hpp"

namespace selvedge::test_run_measures {
namespace {

// One triangle of legs 1 m in the plane y = 0.
Points corner_points() {
  Points x(3, 3);
  x << 0, 0, 0, 1, 0, 0, 0, 0, 1;
  return x;
}

Points at_x(double x) {
  Points point = Points::Zero(1, 3);
  point(0, 0) = x;
  return point;
}

Scene one_triangle() {
  Scene scene;
  Triangles triangles(1, 3);
  triangles << 0, 2, 1;
  Material material;
  material.density = 6;  // a vertex has 1 kg
  material.lame_mu = 3;
  material.lame_lambda = 0;
  material.bending_model = BendingModel::hinge;
  add_cloth(scene, corner_points(), triangles, material, "sheet");
  return scene;
}

}  // namespace

TEST_CASE("measures: l2_mm and e3d of points by hand", "[measures]") {
  Points x(2, 3), reference(2, 3);
  reference << 3, 0, 0, 0, 4, 0;
  x << 3, 0, 0.003, 0, 4.001, 0;
  CHECK(l2_mm(x, reference) == Approx(2));                   // (3 mm + 1 mm) / 2
  CHECK(e3d(x, reference) == Approx(std::sqrt(10e-6) / 5));  // sqrt(9 + 1) mm over sqrt(9 + 16) m
}

TEST_CASE("measures: collision_percent counts by the nearest vertex of the body", "[measures]") {
  Triangles faces(1, 3);
  faces << 0, 2, 1;  // its normal is up
  const Surface body = make_surface(3, faces);
  Points x(4, 3);
  x << 0.1, 0.5, 0.1, 0.1, -0.5, 0.1, 0.9, -1e-6, 0, 5, -7, 0;  // above; below; just below; far away and below
  CHECK(collision_percent(body, corner_points(), x) == Approx(75));
  CHECK(collision_percent(Surface{}, Points(0, 3), x) == 0);
}

TEST_CASE("measures: static_share counts what moved by 0.3 mm at most", "[measures]") {
  const Points before = corner_points();
  Points x = before;
  x(0, 1) += 2e-4;
  x(1, 2) -= 4e-4;
  CHECK(static_share(before, x) == Approx(200.0 / 3));
}

TEST_CASE("measures: the strain of a triangle that is stretched in one direction", "[measures]") {
  const Scene scene = one_triangle();
  Points x = corner_points();
  x.col(0) *= 1.2;
  const StrainMeasure strain = strain_of(scene, x);
  CHECK(strain.mean == Approx(0.1));
  CHECK(strain.most == Approx(0.2));
  CHECK(percentile({1, 2, 3, 4, 5}, 0.5) == 3);
}

TEST_CASE("measures: jitter is the change of acceleration", "[measures]") {
  MotionTrace trace;
  double squared = 0;
  for (const double at : {0.0, 1.0, 4.0, 9.0}) squared = trace.add(at_x(at));
  CHECK(squared == 0);  // accelerated evenly
  squared = trace.add(at_x(17));
  CHECK(squared == Approx(1));  // 16 would go on so
}

TEST_CASE("measures: the spectrum of a vertex that swings has one line", "[measures]") {
  MotionSpectrum slow, fast;
  const auto add = [](MotionSpectrum& spectrum, int cycles) {
    double x = 0;
    spectrum.add(Points::Zero(1, 3));
    for (int f = 0; f < 32; ++f) {
      x += std::cos(2 * std::numbers::pi * cycles * f / 32);
      Points at = Points::Zero(1, 3);
      at(0, 1) = x;
      spectrum.add(at);
    }
  };
  add(slow, 4);
  add(fast, 12);
  const std::vector<double> power = slow.power();
  REQUIRE(power.size() == 17);
  CHECK(power[4] == Approx(0.5));  // mean square of a cosine
  for (std::size_t k = 0; k < power.size(); ++k)
    if (k != 4) CHECK(std::abs(power[k]) < 1e-12);
  CHECK(slow.high_share() == Approx(0).margin(1e-9));
  CHECK(fast.high_share() == Approx(1));
}

TEST_CASE("measures: the least of a quadratic function", "[measures]") {
  const Points aim = corner_points();
  const Minimised found = minimised(
      [&](const Points& x, Points& gradient) {
        gradient = 2 * (x - aim);
        gradient.row(0).setZero();
        return (x - aim).bottomRows(2).squaredNorm();
      },
      {1, 1, 1}, Points::Constant(3, 3, 2), 50);
  CHECK(found.value == Approx(0).margin(1e-12));
  CHECK((found.x.bottomRows(2) - aim.bottomRows(2)).norm() < 1e-6);
  CHECK(found.x.row(0) == Points::Constant(1, 3, 2));  // what has no gradient stays
}

TEST_CASE("measures: hood_losses of a triangle that falls are those of a kilogram a vertex", "[measures]") {
  const Scene scene = one_triangle();
  HoodJudge judge = make_hood_judge(scene);
  JudgedFrame frame;
  frame.before = frame.now = frame.next = corner_points();
  frame.next.col(1).array() += 0.1;
  frame.acceleration = Points::Zero(3, 3);
  frame.acceleration.col(1).setConstant(-10);
  const HoodLosses losses = hood_losses_of(judge, frame);
  CHECK(losses.terms.at("inertia") ==
        Approx(3 * 0.5 * 0.01 * 900).epsilon(1e-6));                        // m |d|^2 / (2 dt^2), three vertices
  CHECK(losses.terms.at("gravity") == Approx(3 * 10 * 0.1).epsilon(1e-6));  // m g h
  CHECK(losses.terms.at("stretching") == Approx(0).margin(1e-9));
  CHECK(losses.terms.at("bending") == 0);
  CHECK(losses.total == Approx(losses.terms.at("inertia") + losses.terms.at("gravity")));
  CHECK(losses.grad_norm == Approx(0.1 * 900 + 10).epsilon(1e-6));  // m d / dt^2 + m g

  // The optimum lies g dt^2 below the start: E - E* = m |d|^2 / (2 dt^2), d the distance to it.
  const Suboptimality found = suboptimality_of(judge, frame);
  const double d = 0.1 + 10.0 / 900;
  CHECK(found.excess == Approx(3 * 0.5 * d * d * 900).epsilon(1e-4));
  CHECK(found.residual == Approx(std::sqrt(3.0) * d * 900).epsilon(1e-6));
}

TEST_CASE("measures: a run is counted frame by frame, from its start", "[measures]") {
  const Scene scene = one_triangle();
  RunMeasures measures(scene, 3, 1);
  CHECK(measures.values().empty());
  measures.begin(corner_points(), Points(0, 3), 5);
  for (int f = 1; f <= 3; ++f) {
    MeasuredFrame frame;
    frame.x = corner_points();
    frame.x.col(1).array() += 0.01 * f;
    frame.acceleration = Points::Zero(3, 3);
    frame.pairs = 4 - f;
    frame.body_pairs = 2 * f;
    frame.meets_body = f == 1;
    frame.depth = f == 2 ? 0.002 : 0;
    frame.kinetic = f;
    measures.add(frame);
  }
  const std::map<std::string, double> values = measures.values();
  CHECK(measures.pairs_by_frame() == std::vector<int>{5, 3, 2, 1});
  CHECK(values.at("pairs_mean") == Approx(2));
  CHECK(values.at("body_pairs_mean") == Approx(4));
  CHECK(values.at("pairs_start") == 5);
  CHECK(values.at("pairs_end") == 1);
  CHECK(values.at("collision_free_frames") == Approx(200.0 / 3));
  CHECK(values.at("depth") == 0.002);
  CHECK(values.at("kinetic") == Approx(2));
  CHECK(values.at("static_share") == 0);
  CHECK(values.at("hood_total") == Approx(0).margin(1e-9));  // it goes on as it did
  CHECK(values.at("excess") == Approx(0).margin(1e-9));
  for (const auto& [name, value] : values) CHECK_FALSE(meaning_of(name).empty());
}

}  // namespace selvedge::test_run_measures
