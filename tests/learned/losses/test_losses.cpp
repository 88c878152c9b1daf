#include <catch2/catch.hpp>

#include "learned/losses/body_losses.hpp"
#include "learned/losses/cloth_losses.hpp"
#include "tests/learned/loss_scenes.hpp"

namespace selvedge::test_losses {

using testing::all_losses;
using testing::LossScene;

namespace {

constexpr double pi = 3.14159265358979323846;

// A right triangle with legs of 1 m and, if asked for, its mirror image over the hypotenuse's leg on x.
LossGarment triangle_garment(const VertexMaterial& material, bool with_wing = false) {
  Points rest(with_wing ? 4 : 3, 3);
  Triangles triangles(with_wing ? 2 : 1, 3);
  rest.topRows(3) << 0, 0, 0, 1, 0, 0, 0, 0, 1;
  triangles.row(0) << 0, 1, 2;
  if (with_wing) {
    rest.row(3) << 0, 0, -1;
    triangles.row(1) << 1, 0, 3;
  }
  return make_loss_garment(make_surface(static_cast<int>(rest.rows()), triangles), rest, {}, material);
}

Points legs(double u, double w) {
  Points x(3, 3);
  x << 0, 0, 0, u, 0, 0, 0, 0, w;
  return x;
}

// A face in the plane y = 0, its normal up, with the centroid in the origin.
Surface floor_surface() {
  Triangles face(1, 3);
  face << 0, 1, 2;
  return make_surface(3, face);
}
Points floor_points() {
  Points x(3, 3);
  x << -1, 0, -1, 0, 0, 2, 1, 0, -1;
  return x;
}

// Central differences of `value`.
template <class Value>
Points differences(const Points& x, const Value& value) {
  constexpr double h = 1e-7;
  Points slope(x.rows(), 3);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Points up = x, down = x;
    up.data()[i] += h;
    down.data()[i] -= h;
    slope.data()[i] = (value(up) - value(down)) / (2 * h);
  }
  return slope;
}

double apart(const Points& a, const Points& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(a.cwiseAbs().maxCoeff(), 1e-300);
}

}  // namespace

TEST_CASE("losses: a stretched triangle, by hand", "[losses]") {
  VertexMaterial material;
  material.lame_mu = 3;
  material.lame_lambda = 5;
  const LossGarment garment = triangle_garment(material);
  const double g = 0.5 * (1.2 * 1.2 - 1), energy = 0.5 * (3 * g * g + 2.5 * g * g);
  Points gradient = Points::Zero(3, 3);
  CHECK(stretching_loss(garment, legs(1.2, 1), &gradient) == Approx(energy));
  CHECK(gradient(1, 0) == Approx(0.5 * (2 * 3 + 5) * g * 1.2));
  CHECK(gradient(0, 0) == Approx(-gradient(1, 0)));
  CHECK(stretching_loss(garment, legs(1, 1), nullptr) == Approx(0).margin(1e-20));
}

TEST_CASE("losses: a folded hinge weighs with its current length, or with that at rest", "[losses]") {
  VertexMaterial material;
  material.bending = 0.3;
  const LossGarment garment = triangle_garment(material, true);
  Points x(4, 3);
  x << 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, -1, 0;  // the common edge twice as long, a right angle
  const double angle = pi / 2, areas = 1;
  CHECK(bending_loss(garment, x, nullptr) == Approx(0.3 * 4 / (4 * areas) * angle * angle / 2));
  Points gradient = Points::Zero(4, 3);
  bending_loss(garment, x, &gradient);
  CHECK(gradient(1, 0) == Approx(0.3 * 2 / (4 * areas) * angle * angle));  // the energy is quadratic in the length
  Points rest(4, 3);
  rest << 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1;
  const LossGarment at_rest = make_loss_garment(garment.surface, rest, {}, material, HingeLength::rest);
  CHECK(bending_loss(at_rest, x, nullptr) == Approx(0.3 / (4 * areas) * angle * angle / 2));
  CHECK(triangle_garment(material).hinges.empty());
}

TEST_CASE("losses: gravity and inertia, by hand", "[losses]") {
  VertexMaterial material;
  material.density = 6;  // 1 kg a vertex
  const LossGarment garment = triangle_garment(material);
  Points x = legs(1, 1), now = legs(1, 1), velocity = Points::Zero(3, 3), gradient = Points::Zero(3, 3);
  x.col(1).setConstant(0.5);
  CHECK(gravity_loss(garment, 9.81, x, &gradient) == Approx(3 * 9.81 * 0.5));
  CHECK(gradient(2, 1) == Approx(9.81));
  velocity(0, 1) = 0.2;
  gradient.setZero();
  CHECK(inertia_loss(garment, now, velocity, 0.1, x, &gradient) == Approx((0.3 * 0.3 + 2 * 0.5 * 0.5) / (2 * 0.01)));
  CHECK(gradient(0, 1) == Approx(0.3 / 0.01));
}

TEST_CASE("losses: inertia takes the relaxation frame's time step", "[losses]") {
  const LossScene scene;
  LossInputs in = scene.inputs();
  LossOptions options = hood_losses();
  LossSearch search;
  const auto inertia = [&] {
    for (const LossTerm& term : add_losses(in, options, search, nullptr))
      if (term.name == "inertia") return term.value;
    return -1.0;
  };
  const double frame = inertia();
  in.is_initial = true;
  CHECK(inertia() == Approx(frame / 100));
}

TEST_CASE("losses: a vertex in and above a body, by hand", "[losses]") {
  const LossGarment garment = triangle_garment({});
  CollisionLoss options;
  Points x = legs(0.1, 0.1), gradient = Points::Zero(3, 3);
  x(0, 1) = -1e-3;  // 3 mm short of the margin
  x(1, 1) = 5e-3;   // clear
  x(2, 1) = 1e-3;   // 1 mm short, but without a face
  const Surface floor = floor_surface();
  const std::vector<int> faces{0, 0, -1};
  CHECK(collision_loss(garment, options, faces, floor, floor_points(), x, &gradient) == Approx(27e-9));
  CHECK(gradient(0, 1) == Approx(-3 * 9e-6));
  CHECK(gradient.bottomRows(2).norm() == 0);
  options.penalty = DepthPenalty::quadratic;
  gradient.setZero();
  CHECK(collision_loss(garment, options, faces, floor, floor_points(), x, &gradient) == Approx(4.5e-6));
  CHECK(gradient(0, 1) == Approx(-3e-3));
}

TEST_CASE("losses: an edge whose ends are outside of the body is kept out in its middle", "[losses]") {
  const LossGarment garment = triangle_garment({});
  CollisionLoss options;
  options.thickness = 0;
  Points x = legs(0.1, 0.1), gradient = Points::Zero(3, 3);
  x.col(1) << 4e-3, -10e-3, 8e-3;  // the middles of edges 01 and 12 are 3 and 1 mm deep, that of 02 is outside
  const std::vector<std::array<int, 3>> samples = cloth_samples(garment, ClothSamples::faces);
  REQUIRE(samples.size() == 7);
  CHECK(samples[3] == std::array<int, 3>{0, 1, -1});
  CHECK(sample_points(samples, x)(6, 1) == Approx(2e-3 / 3));
  const std::vector<int> faces{0, -1, 0, 0, 0, 0};  // vertex 1 has none
  options.samples = ClothSamples::edges;
  options.penalty = DepthPenalty::quadratic;
  CHECK(collision_loss(garment, options, faces, floor_surface(), floor_points(), x, &gradient) ==
        Approx(0.5 * (9e-6 + 1e-6)));
  CHECK(gradient(0, 1) == Approx(-1.5e-3));
  CHECK(gradient(1, 1) == Approx(-2e-3));
  CHECK(gradient(2, 1) == Approx(-0.5e-3));
}

TEST_CASE("losses: sliding on a body that moves, by hand", "[losses]") {
  VertexMaterial material;
  material.density = 6;
  const LossGarment garment = triangle_garment(material);
  const FrictionLoss options;
  const Surface floor = floor_surface();
  Points now = Points::Zero(3, 3), moved_floor = floor_points();
  now(1, 1) = 0.06;  // farther than 5.5 cm
  now(2, 1) = 0.05;
  moved_floor.col(0).array() += 0.02;
  Points x = now, gradient = Points::Zero(3, 3);
  x.row(0) << 0.02, 0.01, 0.003;  // with the body, 1 cm up, 3 mm across along z
  x.row(1) << 0.05, 0.06, 0;
  x.row(2) << 0.025, 0.05, 0;  // 5 mm beside the body along x
  const std::vector<int> faces{0, 0, 0};
  const double along_z = std::sqrt(1e-4) * 3e-3, along_x = std::sqrt(1 + 1e-4) * 5e-3;
  CHECK(friction_loss(garment, options, 9.81, faces, faces, floor, floor_points(), moved_floor, now, x, &gradient) ==
        Approx(0.5 * 9.81 * (along_z + along_x)));
  CHECK(gradient(2, 0) == Approx(0.5 * 9.81 * std::sqrt(1 + 1e-4)));
  CHECK(gradient(0, 1) == Approx(0).margin(1e-12));
  CHECK(gradient.row(1).norm() == 0);
}

TEST_CASE("losses: repulsion knows on which side a vertex was", "[losses]") {
  Points rest(4, 3), now(4, 3);
  rest << -1, 0, -1, 0, 0, 2, 1, 0, -1, 0, 5, 0;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  const LossGarment garment = make_loss_garment(make_surface(4, triangles), rest, {}, {});
  const std::vector<ClothPair> pairs{{3, 0}};
  const RepulsionLoss options;
  const auto value = [&](double was, double is, Points* gradient = nullptr) {
    Points x = rest;
    now = rest;
    now(3, 1) = was;
    x(3, 1) = is;
    return repulsion_loss(garment, options, pairs, now, x, gradient);
  };
  CHECK(value(5e-3, 1e-3) == Approx(8e-9));
  CHECK(value(5e-3, -1e-3) == Approx(64e-9));  // it has gone through
  CHECK(value(-5e-3, -1e-3) == Approx(8e-9));  // from below
  CHECK(value(2e-2, 1e-3) == 0);               // too far away to correspond
  CHECK(value(5e-3, 4e-3) == 0);
  Points gradient = Points::Zero(4, 3);
  value(5e-3, 1e-3, &gradient);
  CHECK(gradient(3, 1) == Approx(-3 * 4e-6));
  CHECK(gradient.col(1).head(3).sum() == Approx(3 * 4e-6));
  LossGarment pinned = make_loss_garment(garment.surface, rest, {1, 0, 0, 0}, {});
  Points x = rest;
  x(3, 1) = 1e-3;
  now(3, 1) = 5e-3;
  CHECK(repulsion_loss(pinned, options, pairs, now, x, nullptr) == Approx(8e-9 * 1e6));
}

TEST_CASE("losses: gradients are those of the values", "[losses]") {
  const LossScene scene;
  LossInputs in = scene.inputs();
  LossOptions options = all_losses();
  options.contours.gradient = ContourGradient::full;
  options.contours.normal = ContourNormal::turning;
  for (const SlopeAxis axis : {SlopeAxis::x, SlopeAxis::y, SlopeAxis::z})
    for (const DepthPenalty penalty : {DepthPenalty::cubic, DepthPenalty::quadratic}) {
      options.friction.slope = axis;
      options.collision.penalty = penalty;
      options.collision.samples = axis == SlopeAxis::x   ? ClothSamples::faces
                                  : axis == SlopeAxis::y ? ClothSamples::edges
                                                         : ClothSamples::vertices;
      LossSearch search;
      find_matches(in, options, search);
      REQUIRE(search.matches.crossings.segments.size() > 3);
      const std::vector<LossTerm> terms = add_losses(in, options, search.matches, nullptr);
      REQUIRE(terms.size() == 8);
      for (const LossTerm& term : terms) {
        INFO(term.name);
        CHECK(term.value != 0);
        LossOptions one = all_losses();
        one = options;
        for (LossRamp* ramp : {&one.stretching, &one.bending, &one.gravity, &one.inertia, &one.collision.weight,
                               &one.friction.weight, &one.repulsion.weight, &one.contours.weight})
          *ramp = {0, 0};
        const std::map<std::string, LossRamp*> ramps{{"stretching", &one.stretching},
                                                     {"bending", &one.bending},
                                                     {"gravity", &one.gravity},
                                                     {"inertia", &one.inertia},
                                                     {"collision", &one.collision.weight},
                                                     {"friction", &one.friction.weight},
                                                     {"repulsion", &one.repulsion.weight},
                                                     {"contours", &one.contours.weight}};
        *ramps.at(term.name) = {3, 3};
        Points gradient = Points::Zero(scene.x.rows(), 3);
        const double norm = add_losses(in, one, search.matches, &gradient)[0].gradient_norm;
        const Points numeric = differences(scene.predicted, [&](const Points& x) {
          LossInputs there = in;
          there.predicted = &x;
          return sum_of(add_losses(there, one, search.matches, nullptr));
        });
        CHECK(apart(numeric, gradient) < 2e-6);
        CHECK(norm == Approx(gradient.bottomRows(gradient.rows() - 1).norm()));  // the first vertex is pinned
      }
    }
}

TEST_CASE("losses: the distance from a target is in mm and counts masses of free vertices alone", "[losses]") {
  VertexMaterial material;
  material.density = 6;
  LossGarment garment = triangle_garment(material, true);
  const Points target = Points::Random(4, 3);
  Points x = target;
  x.row(0) += Eigen::RowVector3d(0, 3e-3, 0);
  x.row(2) += Eigen::RowVector3d(4e-3, 0, 0);
  const double m0 = garment.mass[0], m2 = garment.mass[2];
  const double all = garment.mass[0] + garment.mass[1] + garment.mass[2] + garment.mass[3];
  CHECK(target_loss(garment, target, x, nullptr) == Approx(std::sqrt((9 * m0 + 16 * m2) / all)));
  garment.pinned[2] = 1;
  CHECK(target_loss(garment, target, x, nullptr) == Approx(3 * std::sqrt(m0 / (all - m2))));

  Points gradient = Points::Zero(4, 3);
  x += 1e-3 * Points::Random(4, 3);
  target_loss(garment, target, x, &gradient);
  const Points numeric =
      differences(x, [&](const Points& moved) { return target_loss(garment, target, moved, nullptr); });
  CHECK(apart(gradient, numeric) < 1e-6);
  CHECK(gradient.row(2).isZero(0));
  Points none = Points::Zero(4, 3);
  CHECK(target_loss(garment, target, target, &none) == 0);
  CHECK(none.isZero(0));
}

TEST_CASE("losses: contours have the share of the gradient that is asked for, whatever their weight", "[losses]") {
  const LossScene scene;
  LossInputs in = scene.inputs();
  LossOptions options = all_losses();
  LossSearch search;
  LossOptions without = options;
  without.contours.weight = {0, 0};
  Points others = Points::Zero(scene.x.rows(), 3), plain = others, first = others, second = others;
  add_losses(in, without, search, &others);
  const std::vector<LossTerm> as_weighted = add_losses_with_share(in, options, search, plain);
  Points expected = Points::Zero(scene.x.rows(), 3);
  add_losses(in, options, search, &expected);
  CHECK(plain == expected);
  options.contours.share = 0.3;
  const std::vector<LossTerm> held = add_losses_with_share(in, options, search, first);
  options.contours.weight = {1e-3, 1e-3};
  add_losses_with_share(in, options, search, second);
  CHECK((first - second).norm() < 1e-6 * first.norm());  // the contours are the difference of two sums
  CHECK(inverse_mass_norm(*in.garment, first - others) / inverse_mass_norm(*in.garment, others) ==
        Approx(0.3 / 0.7).epsilon(1e-6));
  REQUIRE(held.back().name == "contours");
  CHECK(held.back().value / as_weighted.back().value == Approx(held.back().weight / as_weighted.back().weight));
  CHECK(add_losses_with_share(in, without, search, second).back().name != "contours");
}

TEST_CASE("losses: the appendix' plane case: a triangle through a plane that stands still", "[losses]") {
  // Edges AB and BC of the triangle go through the plane x = 0 at s = 0.4 each; the contour lies along y, 0.6 m long.
  Points x(6, 3);
  x << -2, 0, 0, 3, 0, 0, -2, 1, 0,  // A, B, C
      0, -5, -5, 0, 5, -5, 0, 0, 9;  // the plane
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 3, 4, 5;
  const LossGarment garment = make_loss_garment(make_surface(6, triangles), x, {}, {});
  const SheetView sheet{&garment.surface, &x};
  const Segments found = find_segments({&sheet, 1});
  REQUIRE(found.segments.size() == 1);
  std::vector<Points> part, whole;
  const auto energy = [&](ContourGradient kind, std::vector<Points>& gradient) {
    return contour_energy({&sheet, 1}, found, ContourMeasure::squared_length, &gradient, kind, ContourNormal::frozen);
  };
  CHECK(energy(ContourGradient::translational, part) == Approx(0.36));
  energy(ContourGradient::full, whole);
  // p0 = (0, 0, 0) lies on AB with s = 0.4, p1 = (0, 0.6, 0) on CB with s = 0.4. The pull at p0 is 2 (p0 - p1) =
  // (0, -1.2, 0), without a part along AB; at p1 it is the opposite. ds/dC = -(1 - s) n / n.(B - C), ds/dB = -s n / ...
  const Vec3 n(1, 0, 0), from_c_to_b(5, -1, 0);
  const double slide = 1.2 * from_c_to_b.y() / from_c_to_b.x();  // pull . (B - C) / n . (B - C)
  CHECK((row(part[0], 0)).norm() == Approx(0).margin(1e-15));
  CHECK((row(part[0], 1) + 0.4 * slide * n).norm() == Approx(0).margin(1e-14));
  CHECK((row(part[0], 2) + 0.6 * slide * n).norm() == Approx(0).margin(1e-14));
  for (int v = 3; v < 6; ++v) CHECK((row(part[0], v) - slide / 3 * n).norm() == Approx(0).margin(1e-14));
  // The distortional part, equation 18: (1 - s) I at A and C, s I at B. Together they are the full gradient.
  Points distortional = Points::Zero(6, 3);
  distortional.row(0) << 0, -1.2 * 0.6, 0;
  distortional.row(1) << 0, (-1.2 + 1.2) * 0.4, 0;
  distortional.row(2) << 0, 1.2 * 0.6, 0;
  CHECK((whole[0] - part[0] - distortional).norm() == Approx(0).margin(1e-14));
  // While the plane stands still its normal does too, so that this is the derivative of the value by A, B and C.
  const Points numeric = differences(x, [&](const Points& moved) {
    const SheetView there{&garment.surface, &moved};
    return contour_energy({&there, 1}, found);
  });
  CHECK((whole[0] - numeric).topRows(3).norm() < 1e-7);
}

TEST_CASE("losses: numbers that are not finite, and nothing at all", "[losses]") {
  LossScene scene;
  LossSearch search;
  scene.predicted(3, 1) = std::numeric_limits<double>::quiet_NaN();
  scene.body_next(2, 0) = std::numeric_limits<double>::infinity();
  Points gradient = Points::Constant(scene.x.rows(), 3, 0.25);
  const std::vector<LossTerm> terms = add_losses(scene.inputs(), all_losses(), search, &gradient);
  CHECK(std::isnan(terms[0].value));
  CHECK(gradient.allFinite());

  const Surface none = make_surface(0, Triangles(0, 3));
  const Points nowhere(0, 3);
  const LossGarment empty = make_loss_garment(none, nowhere, {}, {});
  LossInputs in;
  in.garment = &empty;
  in.x = in.velocity = in.predicted = &nowhere;
  Points no_gradient(0, 3);
  for (const bool body : {false, true}) {
    in.body = body ? &none : nullptr;
    in.body_previous = in.body_now = in.body_next = body ? &nowhere : nullptr;
    CHECK(sum_of(add_losses(in, all_losses(), search, &no_gradient)) == 0);
  }

  // A vertex that no triangle has counts nothing, even where it lies in a body.
  Points rest(4, 3);
  rest << 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, -1, 0;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  const LossGarment loose = make_loss_garment(make_surface(4, triangles), rest, {}, {});
  CHECK(collision_loss(loose, {}, {0, 0, 0, 0}, floor_surface(), floor_points(), rest, nullptr) == 0);
}

}  // namespace selvedge::test_losses
