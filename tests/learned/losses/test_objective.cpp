#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "learned/losses/force_input.hpp"
#include "tests/learned/loss_scenes.hpp"

namespace selvedge::test_objective {

using testing::all_losses;
using testing::contourcraft_final_losses;
using testing::contourcraft_losses;
using testing::LossScene;

namespace {

std::vector<LossRamp> ramps_of(const LossOptions& o) {
  return {o.stretching,       o.bending,         o.gravity,          o.inertia,
          o.collision.weight, o.friction.weight, o.repulsion.weight, o.contours.weight};
}

std::vector<std::string> names_of(const std::vector<LossTerm>& terms) {
  std::vector<std::string> names;
  for (const LossTerm& term : terms) names.push_back(term.name);
  return names;
}

}  // namespace

TEST_CASE("objective: ramps are linear between fractions of the run", "[losses]") {
  const LossRamp ramp{1, 5, 0.25, 0.75};
  CHECK(weight_at(ramp, 0) == 1);
  CHECK(weight_at(ramp, 0.25) == 1);
  CHECK(weight_at(ramp, 0.5) == 3);
  CHECK(weight_at(ramp, 0.75) == 5);
  CHECK(weight_at(ramp, 1) == 5);
  CHECK(weight_at({0, 2, 0.5, 0.5}, 0.49) == 0);  // a jump
  CHECK(weight_at({0, 2, 0.5, 0.5}, 0.5) == 2);
  CHECK(weight_at({}, 0) == 1);
}

TEST_CASE("objective: the end of the run has the full weight of every loss", "[losses]") {
  for (const LossOptions& options :
       {hood_losses(), contourcraft_losses(), contourcraft_final_losses(), fast_losses(), LossOptions{}})
    for (const LossRamp& ramp : ramps_of(options)) {
      CHECK((ramp.begin >= 0 && ramp.begin <= ramp.end && ramp.end <= 1));
      CHECK(weight_at(ramp, 1) == ramp.to);
    }
  CHECK(weight_at(hood_losses().collision.weight, 0.1) == 5e3);
  CHECK(contourcraft_final_losses().contours.weight.to == 1e7);
  CHECK(contourcraft_losses().repulsion.weight.from == 0);
}

TEST_CASE("objective: terms by name, only those with a weight now, and their sum", "[losses]") {
  const LossScene scene;
  LossInputs in = scene.inputs();
  LossSearch search;
  LossOptions options = all_losses();
  Points gradient = Points::Zero(scene.x.rows(), 3);
  const std::vector<LossTerm> terms = add_losses(in, options, search, &gradient);
  CHECK(names_of(terms) == std::vector<std::string>{"stretching", "bending", "gravity", "inertia", "collision",
                                                    "friction", "repulsion", "contours"});
  CHECK(terms[4].weight == 5e5);
  in.progress = 0;
  CHECK(add_losses(in, options, search, nullptr)[4].weight == 5e3);
  options.repulsion.weight = {0, 1, 0.5, 1};
  in.contours = false;
  in.body = nullptr;
  CHECK(names_of(add_losses(in, options, search, nullptr)) ==
        std::vector<std::string>{"stretching", "bending", "gravity", "inertia"});

  // Values without a gradient are the same, and what is there already stays.
  in = scene.inputs();
  options = all_losses();
  const std::vector<LossTerm> bare = add_losses(in, options, search, nullptr);
  for (std::size_t i = 0; i < terms.size(); ++i) CHECK(bare[i].value == Approx(terms[i].value).epsilon(1e-12));
  Points twice = gradient;
  add_losses(in, options, search, &twice);
  CHECK((twice - 2 * gradient).norm() < 1e-12 * gradient.norm());
}

TEST_CASE("objective: searching again from what was found changes no bit", "[losses]") {
  LossScene scene;
  LossSearch kept;
  for (int frame = 0; frame < 4; ++frame) {
    LossSearch fresh;
    Points a = Points::Zero(scene.x.rows(), 3), b = a;
    add_losses(scene.inputs(), all_losses(), kept, &a);
    add_losses(scene.inputs(), all_losses(), fresh, &b);
    CHECK(a == b);
    scene.x = scene.predicted;
    scene.predicted.array() += 1e-3;
    scene.body_previous = scene.body_now;
    scene.body_now = scene.body_next;
  }
}

TEST_CASE("objective: along a line", "[losses]") {
  const LossScene scene;
  LossSearch search;
  const std::vector<double> t{0, 0.3, 1};
  const std::vector<double> sums = losses_along(scene.inputs(), all_losses(), scene.x, t, search);
  for (std::size_t i = 0; i < t.size(); ++i) {
    LossInputs in = scene.inputs();
    const Points there = scene.x + t[i] * (scene.predicted - scene.x);
    in.predicted = &there;
    LossSearch fresh;
    CHECK(sums[i] == Approx(sum_of(add_losses(in, all_losses(), fresh, nullptr))).epsilon(1e-12));
  }
}

TEST_CASE("objective: a material for each vertex", "[losses]") {
  LossScene scene;
  const auto value = [&](const LossGarment& garment) {
    LossInputs in = scene.inputs();
    in.garment = &garment;
    in.body = nullptr;
    LossSearch search;
    return sum_of(add_losses(in, hood_losses(), search, nullptr));
  };
  VertexMaterial stiff;
  stiff.lame_mu *= 2;
  stiff.bending *= 3;
  stiff.density *= 1.5;
  LossGarment each = scene.garment, all = scene.garment;
  set_materials(each, std::vector<VertexMaterial>(static_cast<std::size_t>(each.surface.vertex_count), stiff));
  set_material(all, stiff);
  CHECK(value(all) > 1.2 * value(scene.garment));
  CHECK(value(each) == Approx(value(all)));
  CHECK(value(make_loss_garment(scene.cloth, scene.rest, scene.garment.pinned, stiff)) == Approx(value(all)));
  stiff.bending = -1;
  CHECK_THROWS_AS(set_material(all, stiff), Error);
  CHECK_THROWS_AS(set_materials(all, std::vector<VertexMaterial>(2)), Error);
}

TEST_CASE("objective: what does not fit is an error", "[losses]") {
  const LossScene scene;
  LossSearch search;
  const Points short_by_one = scene.x.topRows(scene.x.rows() - 1);
  LossInputs in = scene.inputs();
  in.velocity = &short_by_one;
  CHECK_THROWS_AS(add_losses(in, hood_losses(), search, nullptr), Error);
  in = scene.inputs();
  in.body_next = &short_by_one;
  CHECK_THROWS_AS(add_losses(in, hood_losses(), search, nullptr), Error);
  in = scene.inputs();
  Points gradient = short_by_one;
  CHECK_THROWS_AS(add_losses(in, hood_losses(), search, &gradient), Error);
  CHECK_THROWS_AS(add_losses(in, hood_losses(), LossMatches{}, nullptr), Error);
  CHECK_THROWS_AS(add_losses({}, hood_losses(), search, nullptr), Error);
}

TEST_CASE("force input: a hanging triangle, by hand", "[losses]") {
  Points rest(3, 3);
  rest << 0, 0, 0, 1, 0, 0, 0, 0, 1;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  VertexMaterial material;
  material.density = 6;  // 1 kg a vertex
  material.lame_mu = 3;
  material.lame_lambda = 5;
  const LossGarment garment = make_loss_garment(make_surface(3, triangles), rest, {1, 0, 0}, material);
  const std::vector<double> diagonal = jacobi_diagonal(garment, 0.1);
  CHECK(diagonal[0] == Approx(100 + 11 * 0.5 * 2));  // grad phi = (-1, -1)
  CHECK(diagonal[1] == Approx(100 + 11 * 0.5));
  const Points still = Points::Zero(3, 3);
  LossInputs in;
  in.garment = &garment;
  in.x = in.predicted = &rest;
  in.velocity = &still;
  in.timestep = 0.1;
  LossSearch search;
  const Points force = force_input(in, hood_losses(), {}, search);
  CHECK(force.row(0).norm() == 0);
  CHECK(force(1, 1) == Approx(-9.81 / 105.5));
  CHECK(force(1, 0) == Approx(0).margin(1e-15));
}

TEST_CASE("force input: a soft body, contours and inertia join where they are asked for", "[losses]") {
  const LossScene scene;
  LossSearch search;
  const auto input = [&](const ForceOptions& force) {
    return force_input(scene.inputs(), all_losses(), force, search);
  };
  ForceOptions none;
  none.contact_stiffness = 0;
  ForceOptions contours = none, inertia = none;
  contours.contour_weight = 30;
  inertia.inertia = true;
  const Points bare = input(none);
  CHECK(bare.allFinite());
  const double least = 1e-3 * bare.norm();
  CHECK(least > 0);
  CHECK((input({}) - bare).norm() > least);
  CHECK((input(contours) - bare).norm() > least);
  CHECK((input(inertia) - bare).norm() > least);
  Points far = scene.predicted;
  far(5, 0) = std::numeric_limits<double>::infinity();
  LossInputs in = scene.inputs();
  in.predicted = &far;
  CHECK(force_input(in, all_losses(), contours, search).allFinite());
}

TEST_CASE("objective: the norm that a sample's gradient is divided by", "[losses]") {
  Points rest(4, 3), gradient(4, 3);
  rest << 0, 0, 0, 1, 0, 0, 0, 0, 1, 5, 5, 5;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  VertexMaterial material;
  material.density = 24;  // 4 kg a vertex
  const LossGarment garment = make_loss_garment(make_surface(4, triangles), rest, {0, 1, 0, 0}, material);
  gradient << 3, 0, 0, 100, 0, 0, 0, 4, 0, 100, 0, 0;
  CHECK(inverse_mass_norm(garment, gradient) == Approx(2.5));
}

}  // namespace selvedge::test_objective
