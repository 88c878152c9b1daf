#include <catch2/catch.hpp>

#include "collision/penetration/penetration_loss.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"

namespace selvedge::test_penetration_loss {

using namespace closed;

namespace {

struct Query {
  ClosedSurface closed;
  Points cloth;

  explicit Query(const Solid& solid) : closed(close_surface(solid.surface())), cloth(solid.x) {}
  double value(const Points& x, const PenetrationLossOptions& options = {}) const {
    const Points at = closed_positions(closed, x);
    return penetration_loss(closed, at, find_penetration(closed, at), options);
  }
  Points gradient(const PenetrationLossOptions& options = {}) const {
    const Points at = closed_positions(closed, cloth);
    Points by_closed;
    penetration_loss(closed, at, find_penetration(closed, at), options, &by_closed);
    return by_cloth_positions(closed, by_closed);
  }
};

Points random_direction(const Points& like, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Points direction = like;
  for (double& d : direction.reshaped()) d = normal(random);
  return direction / direction.norm();
}

Solid crossing_stars(unsigned seed) {
  std::mt19937 random(seed);
  const Solid a = star(1, 0.7, random), b = star(1, 0.7, random);
  return both(a, moved(b, Vec3(1.1, 0.2, 0.3)));
}

// Of a curved tube whose front hem has gone through the back.
Solid pinched_tube() {
  return rings(24, 12, [](int j, double angle) {
    const double z = 0.09 * j,
                 in = 1.15 * std::exp(-8 * z * z - 1.5 * std::pow(std::remainder(angle - 0.03, 6.2831853), 2));
    return Vec3(0.5 * std::cos(angle) - in, 0.35 * std::sin(angle) + 0.013 * j,
                z + 0.02 * std::sin(3 * angle + 0.4) + 0.01 * std::cos(7.3 * angle));
  });
}

// Net force along x on the vertices [0, first) of two balls that overlap along x.
double separating_force(int times, double distance, CrossingMotion motion) {
  const Solid one = turned(ball(times), Vec3(1, 2, 3), 0.3), two = turned(ball(times), Vec3(3, 1, 2), 0.7);
  const Query query(both(one, moved(two, Vec3(distance, 0, 0))));
  return -query.gradient({PenetrationMeasure::volume, motion, 1}).topRows(one.x.rows()).col(0).sum();
}

}  // namespace

TEST_CASE("penetration loss: the exact gradient is that of the value", "[penetration]") {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Query query(seed < 5 ? crossing_stars(seed) : pinched_tube());
    REQUIRE(query.value(query.cloth) > 0);
    const Points gradient = query.gradient();
    for (unsigned d = 0; d < 3; ++d) {
      const Points direction = random_direction(query.cloth, 10 * seed + d);
      const double h = 2e-5;
      const double slope =
          (query.value(query.cloth + h * direction) - query.value(query.cloth - h * direction)) / (2 * h);
      CHECK(gradient.cwiseProduct(direction).sum() == Approx(slope).epsilon(1e-6).margin(1e-7 * gradient.norm()));
    }
  }
}

TEST_CASE("penetration loss: frozen and area gradients are those of their surrogates", "[penetration]") {
  const Query query(crossing_stars(1));
  const Points at = closed_positions(query.closed, query.cloth);
  const Penetration found = find_penetration(query.closed, at);
  for (const PenetrationMeasure measure : {PenetrationMeasure::volume, PenetrationMeasure::area})
    for (const CrossingMotion motion : {CrossingMotion::frozen_on_edge, CrossingMotion::frozen_on_face}) {
      const PenetrationLossOptions options{measure, motion, 1};
      Points gradient;
      const double value = penetration_loss(query.closed, at, found, options, &gradient);
      double expected = 0;
      for (const PenetrationRegion& region : found.regions)
        expected += measure == PenetrationMeasure::volume ? 6 * std::abs(region.volume) : region.area;
      CHECK(value == Approx(expected).epsilon(1e-12));
      for (unsigned d = 0; d < 3; ++d) {
        const Points direction = random_direction(at, d);
        const auto there = [&](double h) { return penetration_loss(query.closed, at + h * direction, found, options); };
        const double slope = (there(1e-5) - there(-1e-5)) / 2e-5;
        CHECK(gradient.cwiseProduct(direction).sum() == Approx(slope).epsilon(1e-6).margin(1e-8 * gradient.norm()));
      }
    }
}

TEST_CASE("penetration loss: beyond the saturation a region's pressure falls as one over its volume", "[penetration]") {
  CHECK(saturated_volume(3, 0) == 3);
  CHECK(saturated_volume(3, 3) == 3);
  CHECK(saturated_volume(3 * std::exp(1.0), 3) == Approx(6));
  const Query query(crossing_stars(3));
  const Points at = closed_positions(query.closed, query.cloth);
  const Penetration found = find_penetration(query.closed, at);
  REQUIRE(found.regions.size() == 1);
  const double volume = std::abs(found.regions[0].volume);
  for (const CrossingMotion motion : {CrossingMotion::exact, CrossingMotion::frozen_on_edge}) {
    const PenetrationLossOptions published{PenetrationMeasure::volume, motion, 1};
    PenetrationLossOptions bounded = published;
    bounded.saturation = 1.01 * volume;
    CHECK(query.value(query.cloth, bounded) == query.value(query.cloth, published));
    CHECK(query.gradient(bounded) == query.gradient(published));
    bounded.saturation = volume / 4;
    CHECK(query.value(query.cloth, bounded) == Approx(1.5 * volume * (1 + std::log(4.0))));
    const Points gradient = query.gradient(bounded);
    CHECK((4 * gradient - query.gradient(published)).norm() < 1e-12 * gradient.norm());
    if (motion == CrossingMotion::exact) {
      const Points along = random_direction(query.cloth, 7);
      const auto there = [&](double h) { return query.value(query.cloth + h * along, bounded); };
      CHECK(gradient.cwiseProduct(along).sum() == Approx((there(2e-5) - there(-2e-5)) / 4e-5).epsilon(1e-6));
    } else {
      const Points along = random_direction(at, 7), far = at + 0.01 * along;
      Points by_closed;
      penetration_loss(query.closed, far, found, bounded, &by_closed);
      const auto there = [&](double h) { return penetration_loss(query.closed, far + h * along, found, bounded); };
      CHECK(by_closed.cwiseProduct(along).sum() == Approx((there(1e-5) - there(-1e-5)) / 2e-5).epsilon(1e-6));
    }
  }
}

TEST_CASE("penetration loss: no gradient depends on the origin, and none turns the whole", "[penetration]") {
  for (const CrossingMotion motion :
       {CrossingMotion::exact, CrossingMotion::frozen_on_edge, CrossingMotion::frozen_on_face}) {
    const PenetrationLossOptions options{PenetrationMeasure::volume, motion, 1};
    const Solid solid = crossing_stars(2);
    const Points here = Query(solid).gradient(options),
                 there = Query(moved(solid, Vec3(30, -20, 10))).gradient(options);
    CHECK((here - there).norm() < 1e-9 * here.norm());
    CHECK(here.colwise().sum().norm() < 1e-12 * here.norm());
    Vec3 moment = Vec3::Zero();
    for (int v = 0; v < solid.x.rows(); ++v) moment += row(solid.x, v).cross(row(here, v));
    CHECK(moment.norm() < 1e-10 * here.norm());
  }
}

TEST_CASE("penetration loss: frozen crossings push balls apart less than they should", "[penetration]") {
  for (const auto& [times, distance] : {std::pair{2, 1.85}, std::pair{0, 1.65}}) {
    const double exact = separating_force(times, distance, CrossingMotion::exact);
    const double edge = separating_force(times, distance, CrossingMotion::frozen_on_edge) / exact;
    const double face = separating_force(times, distance, CrossingMotion::frozen_on_face) / exact;
    INFO("faces " << 20 * (1 << 2 * times) << ": edge " << edge << ", face " << face);
    CHECK(exact < 0);  // the first ball is pushed back
    CHECK(edge < 0.99);
    CHECK(face < edge);
    if (times == 0) CHECK(edge < 0.7);
  }
}

}  // namespace selvedge::test_penetration_loss
