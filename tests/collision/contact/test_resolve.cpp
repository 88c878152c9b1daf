#include <catch2/catch.hpp>

#include <random>

#include "collision/audit/audit.hpp"
#include "collision/contact/proximity.hpp"
#include "collision/contact/resolve.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_resolve {

using testing::join;
using testing::sheet;

namespace {

struct Case {
  Surface cloth;
  std::vector<Surface> obstacles;
  Points x0, x1;
  Eigen::VectorXd inverse_mass;
};

ResolveReport run(const Case& c, Points& x1, PathPairs& candidates, const ResolveOptions& options = {}) {
  std::vector<const Surface*> obstacles;
  for (const Surface& s : c.obstacles) obstacles.push_back(&s);
  const ContactWorld world = make_contact_world(c.cloth, obstacles, true);
  PairSearch search(world);
  return resolve(search, world, c.inverse_mass, options, c.x0, x1, candidates);
}

// Audits the motion at many times, obstacles included.
int pairs_on_the_way(const Case& c, const Points& x1) {
  int pairs = 0;
  const int n = c.cloth.vertex_count;
  for (int k = 0; k <= 20; ++k) {
    const Points x = c.x0 + k / 20.0 * (x1 - c.x0);
    std::vector<Points> positions;
    int first = n;
    for (const Surface& s : c.obstacles) {
      positions.push_back(x.middleRows(first, s.vertex_count));
      first += s.vertex_count;
    }
    std::vector<AuditBody> bodies;
    for (std::size_t i = 0; i < positions.size(); ++i) bodies.push_back({&c.obstacles[i], &positions[i]});
    pairs += audit(c.cloth, x.topRows(n), bodies).intersecting_pairs();
  }
  return pairs;
}

// Two sheets that fly through each other, crumpled by noise.
Case crossing(double speed) {
  auto both = join(sheet(8, 0.3, 0.0), sheet(7, 0.3, 0.01));
  Case c{make_surface(static_cast<int>(both.x.rows()), both.triangles), {}, both.x, both.x, {}};
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.01);
  for (int v = 0; v < c.x1.rows(); ++v) {
    c.x1(v, 1) += v < 81 ? speed : -speed;
    for (int k = 0; k < 3; ++k) c.x1(v, k) += normal(random);
  }
  c.inverse_mass = Eigen::VectorXd::Constant(c.x0.rows(), 1e4);
  return c;
}

}  // namespace

TEST_CASE("resolve: asks once a zone whether to stop, and ends soon, not clean", "[resolve]") {
  const Case c = crossing(0.3);
  int polls = 0, until = 1 << 30;
  ResolveOptions options;
  options.impulse_rounds = 0;
  options.stop = [&] { return ++polls >= until; };
  Points x1 = c.x1;
  PathPairs candidates;
  const ResolveReport whole = run(c, x1, candidates, options);
  CHECK(whole.clean);
  CHECK_FALSE(whole.stopped);
  REQUIRE(whole.zones > 1);
  CHECK(polls >= whole.zones);
  for (until = 1; until <= whole.zones; ++until) {
    polls = 0;
    x1 = c.x1;
    const ResolveReport report = run(c, x1, candidates, options);
    CHECK(report.stopped);
    CHECK_FALSE(report.clean);
    CHECK(report.zones <= 2 * until);
  }
}

TEST_CASE("resolve: sheets flung through each other end clean, the whole way", "[resolve]") {
  for (const double speed : {0.01, 0.05, 0.3}) {
    const Case c = crossing(speed);
    REQUIRE(pairs_on_the_way(c, c.x1) > 0);
    Points x1 = c.x1;
    PathPairs candidates;
    const ResolveReport report = run(c, x1, candidates);
    CHECK(report.clean);
    CHECK(report.impulses > 0);
    CHECK(pairs_on_the_way(c, x1) == 0);
    const Vec3 drift = (x1 - c.x1).colwise().sum().transpose();
    if (report.shortened == 0) CHECK(drift.norm() < 1e-10);  // equal masses: momentum kept
  }
}

TEST_CASE("resolve: nothing near, nothing changed", "[resolve]") {
  Case c = crossing(0);
  c.x1 = c.x0;
  c.x1.array() += 0.5;
  Points x1 = c.x1;
  PathPairs candidates;
  const ResolveReport report = run(c, x1, candidates);
  CHECK(report.clean);
  CHECK(report.impulses == 0);
  CHECK(x1 == c.x1);
}

// Cloth in the middle between two plates 4 cm apart, which go up by so much [m].
Case between_plates(double low_rises, double high_rises) {
  const auto cloth = sheet(4, 0.1, 0), plate = sheet(2, 0.3, 0);
  const Surface surface = make_surface(9, plate.triangles);
  Case c{make_surface(25, cloth.triangles), {surface, surface}, {}, {}, {}};
  Points low = plate.x, high = plate.x;
  low.col(1).array() -= 0.02;
  high.col(1).array() += 0.02;
  c.x0 = gather_nodes(cloth.x, {low, high});
  low.col(1).array() += low_rises;
  high.col(1).array() += high_rises;
  c.x1 = gather_nodes(cloth.x, {low, high});
  c.inverse_mass = Eigen::VectorXd::Zero(c.x0.rows());
  c.inverse_mass.head(25).setConstant(1e4);
  return c;
}

TEST_CASE("resolve: plates that close on cloth give way to it, and the cloth goes on moving", "[resolve]") {
  const Case c = between_plates(0.04, -0.04);
  Points x1 = c.x1;
  PathPairs candidates;
  const ResolveReport report = run(c, x1, candidates);
  CHECK(report.clean);
  CHECK(report.held == 0);
  CHECK(pairs_on_the_way(c, x1) == 0);
  CHECK((x1 - c.x1).bottomRows(18).rowwise().norm().maxCoeff() > 0.01);
}

TEST_CASE("resolve: a plate that stands still does not give way, and one that closes on it does", "[resolve]") {
  const Case c = between_plates(0, -0.05);
  Points x1 = c.x1;
  PathPairs candidates;
  CHECK(run(c, x1, candidates).clean);
  CHECK(pairs_on_the_way(c, x1) == 0);
  CHECK(x1.middleRows(25, 9) == c.x0.middleRows(25, 9));
  CHECK((x1 - c.x1).bottomRows(9).rowwise().norm().maxCoeff() > 0.01);
}

TEST_CASE("resolve: where its work is done what still meets is held, clean, and it says so", "[resolve]") {
  const Case c = crossing(0.3);
  ResolveOptions options;
  options.impulse_rounds = 0;
  Points x1 = c.x1;
  PathPairs whole_path;
  const ResolveReport whole = run(c, x1, whole_path, options);
  CHECK_FALSE(whole.out_of_work);
  REQUIRE(whole.work.swept > 1000);
  REQUIRE(whole.work.projected > 10000);
  for (const ResponseWork& most : {ResponseWork{0, 0}, ResponseWork{whole.work.swept / 3, unbounded_work.projected},
                                   ResponseWork{unbounded_work.swept, whole.work.projected / 3}}) {
    options.budget = most;
    x1 = c.x1;
    PathPairs path;
    const ResolveReport report = run(c, x1, path, options);
    CHECK(report.out_of_work);
    CHECK(report.clean);
    CHECK(report.held > 0);
    CHECK(report.work.projected < whole.work.projected);
    CHECK(pairs_on_the_way(c, x1) == 0);
    if (most.projected == 0) CHECK(report.work.projected == 0);
  }
}

TEST_CASE("resolve: plates that leave room do not lag", "[resolve]") {
  const auto cloth = sheet(4, 0.1, 0), plate = sheet(2, 0.3, 0);
  Case c{make_surface(25, cloth.triangles), {make_surface(9, plate.triangles)}, {}, {}, {}};
  Points low = plate.x;
  low.col(1).array() -= 0.02;
  c.x0 = gather_nodes(cloth.x, {low});
  low.col(1).array() += 0.06;
  c.x1 = gather_nodes(cloth.x, {low});
  c.inverse_mass = Eigen::VectorXd::Zero(c.x0.rows());
  c.inverse_mass.head(25).setConstant(1e4);
  for (const bool last_resort : {false, true}) {
    Points x1 = c.x1;
    PathPairs candidates;
    ResolveOptions options;
    options.last_resort = last_resort;
    const ContactWorld world = make_contact_world(c.cloth, {&c.obstacles[0]}, true);
    PairSearch search(world);
    const ResolveReport report = resolve(search, world, c.inverse_mass, options, c.x0, x1, candidates);
    CHECK(report.clean);
    CHECK(report.held == 0);
    CHECK(x1.bottomRows(9) == c.x1.bottomRows(9));
    CHECK(pairs_on_the_way(c, x1) == 0);
  }
}

TEST_CASE("resolve: rigid zones end clean too", "[resolve]") {
  const Case c = crossing(0.05);
  Points x1 = c.x1;
  PathPairs candidates;
  ResolveOptions options;
  options.rigid_zones = true;
  options.impulse_rounds = 0;
  const ContactWorld world = make_contact_world(c.cloth, {}, true);
  PairSearch search(world);
  const ResolveReport report = resolve(search, world, c.inverse_mass, options, c.x0, x1, candidates);
  CHECK(report.clean);
  CHECK(report.zones > 0);
  CHECK(pairs_on_the_way(c, x1) == 0);
}

TEST_CASE("resolve: slivers that rest closer than the thickness may be to each other as layers are at it",
          "[resolve]") {
  const auto strip = sheet(4, 0.1, 0);
  const Surface cloth = make_surface(25, strip.triangles);
  Points rest = strip.x;
  rest.col(2) *= 1e-2;  // rows a quarter of a millimetre apart
  const Points x0 = rest;
  Points squeezed = rest, folded = rest;
  squeezed.col(2) *= 0.4;
  folded.col(2) *= -0.4;
  const Eigen::VectorXd inverse_mass = Eigen::VectorXd::Constant(25, 1e4);
  const auto impulses = [&](const Points* known_rest, const Points& end) {
    const ContactWorld world = make_contact_world(cloth, {}, true, known_rest);
    PairSearch search(world);
    PathPairs path;
    Points x1 = end;
    const ResolveReport report = resolve(search, world, inverse_mass, {}, x0, x1, path);
    CHECK(report.clean);
    return report.impulses;
  };
  CHECK(impulses(&rest, squeezed) == 0);
  CHECK(impulses(nullptr, squeezed) > 0);
  CHECK(impulses(&rest, folded) > 0);
}

TEST_CASE("resolve: candidates hold every pair within the thickness at the end", "[resolve]") {
  const Case c = crossing(0.05);
  Points x1 = c.x1;
  PathPairs kept;
  std::vector<NodePair> fresh;
  run(c, x1, kept);
  const ContactWorld world = make_contact_world(c.cloth, {}, true);
  PairSearch search(world);
  search.find(x1, x1, ResolveOptions{}.thickness, fresh);
  const auto a = find_proximities(world, kept.pairs, x1, ResolveOptions{}.thickness);
  const auto b = find_proximities(world, fresh, x1, ResolveOptions{}.thickness);
  CHECK(a.size() > 0);
  CHECK(a.size() == b.size());
}

TEST_CASE("resolve: a list of pairs is kept while nothing leaves its budget, and misses nothing then", "[resolve]") {
  const Case c = crossing(0.05);
  const ContactWorld world = make_contact_world(c.cloth, {}, true);
  const ResolveOptions options;
  PairSearch search(world);
  PathPairs path;
  ResolveReport times;
  find_impacts(search, c.inverse_mass, options, c.x0, c.x0, path, times);
  const std::vector<NodePair> first = path.pairs;
  Points near = c.x0, far = c.x0;
  near.topRows(81).col(1).array() += 0.4 * options.thickness;
  far.topRows(81).col(1).array() += 0.6 * options.thickness;
  find_impacts(search, c.inverse_mass, options, c.x0, near, path, times);
  CHECK(path.end == c.x0);
  CHECK(path.pairs == first);
  find_impacts(search, c.inverse_mass, options, near, c.x1, path, times);
  CHECK(path.end == c.x1);
  // From a start near the end of a known motion, along a path that leaves it: the pairs of the new path.
  const auto impacts = find_impacts(search, c.inverse_mass, options, near, far, path, times);
  PathPairs fresh;
  CHECK(impacts.size() == find_impacts(search, c.inverse_mass, options, near, far, fresh, times).size());
}

TEST_CASE("proximity: a sheet between two others meets one partner on each side", "[proximity]") {
  const double gap = 1e-3;
  const auto all = join(join(sheet(4, 0.4, 0), sheet(4, 0.4, gap)), sheet(4, 0.4, 2.5 * gap));
  const Surface cloth = make_surface(75, all.triangles);
  const ContactWorld world = make_contact_world(cloth, {}, true);
  Points x = all.x;
  x.middleRows(25, 25).col(0).array() += 0.013;  // so that vertices lie over the insides of triangles
  x.middleRows(25, 25).col(2).array() += 0.029;
  std::vector<NodePair> candidates;
  PairSearch search(world);
  search.find(x, x, 2e-3, candidates);
  const auto proximities = find_proximities(world, candidates, x, 2e-3);
  int below = 0, above = 0;
  for (const Proximity& p : proximities) {
    CHECK(p.gap < p.rest_gap);
    CHECK(std::abs(p.normal.y()) == Approx(1));
    CHECK(p.weights.sum() == Approx(0).margin(1e-12));
    if (p.pair.kind == PairKind::vertex_face && p.pair.nodes[0] == 25 + 12) (p.normal.y() > 0 ? below : above)++;
  }
  CHECK(below == 1);
  CHECK(above == 1);
}

}  // namespace selvedge::test_resolve
