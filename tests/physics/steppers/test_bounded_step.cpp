#include "collision/audit/audit_motion.hpp"
#include "collision/contact/path_pairs.hpp"
#include "collision/contour/segments.hpp"
#include "collision/search/intersections.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_bounded_step {

using testing::Sheet;
using testing::World;

namespace {

// Triangles of one size in planes x + y + z = constant, each with corners of its own. Crowded: boxes of all overlap,
// though nothing meets.
Sheet triangles(int count, bool crowded) {
  Sheet s{Points(3 * count, 3), Triangles(count, 3)};
  for (int t = 0; t < count; ++t) {
    const Vec3 at =
        crowded ? Vec3(Vec3::Constant(2e-5 * t)) : Vec3(2.0 * (t % 20), 2.0 * (t / 20 % 20), 2.0 * (t / 400));
    for (int k = 0; k < 3; ++k) {
      const Vec3 corner(k == 0   ? 0.6
                        : k == 1 ? -0.2
                                 : 0.1,
                        k == 1   ? 0.6
                        : k == 2 ? -0.2
                                 : 0.1,
                        k == 2   ? 0.6
                        : k == 0 ? -0.2
                                 : 0.1);
      s.x.row(3 * t + k) = (at + corner).transpose();
      s.triangles(t, k) = 3 * t + k;
    }
  }
  return s;
}

constexpr int too_many = 4000, all_near_all = 1000;

}  // namespace

TEST_CASE("a search that meets more pairs than it may look at throws, and lists nothing", "[bounded_step]") {
  const Sheet soup = triangles(too_many, true);
  const Surface surface = soup.surface();
  const ContactWorld world = make_contact_world(surface, {}, true);
  PairSearch search(world);
  std::vector<NodePair> pairs(1);
  CHECK_THROWS_AS(search.find(soup.x, soup.x, 1e-6, pairs), TooManyPairs);
  CHECK(pairs.empty());
  PathPairs path;
  CHECK_THROWS_AS(update_pairs(search, 1e-6, soup.x, soup.x, path), TooManyPairs);
  CHECK(path.end.rows() == 0);  // holds for no motion
  IntersectionCache cache;
  CHECK_THROWS_AS(intersecting_pairs(surface, soup.x, cache), TooManyPairs);
  const SheetView view{&surface, &soup.x};
  CHECK_THROWS_AS(find_segments({&view, 1}), TooManyPairs);
}

TEST_CASE("an audit that meets more pairs than it may look at says so", "[bounded_step]") {
  const Sheet soup = triangles(too_many, true);
  const Surface surface = soup.surface();
  CHECK_THROWS_AS(audit(surface, soup.x, {}), TooManyPairs);
  CHECK_THROWS_AS(audit_motion(surface, soup.x, soup.x, {}), TooManyPairs);
}

TEST_CASE("where all of a small scene is near all, everything is looked at", "[bounded_step]") {
  const Sheet soup = triangles(all_near_all, true);
  const Surface surface = soup.surface();
  const ContactWorld world = make_contact_world(surface, {}, true);
  PairSearch search(world);
  std::vector<NodePair> pairs;
  search.find(soup.x, soup.x, 1e-6, pairs);
  CHECK(pairs.size() > 500 * all_near_all);
  CHECK(audit(surface, soup.x, {}).intersecting_pairs() == 0);
}

TEST_CASE("a step of a crowd that cannot be searched is rejected, and leaves nothing behind", "[bounded_step]") {
  const Sheet soup = triangles(too_many, true), apart = triangles(too_many, false);
  World w = testing::make_world(apart);
  State crowded = w.state;
  crowded.x = soup.x;
  const auto step = [&](Stepper& stepper, const State& from) {
    std::pair<StepReport, State> done;
    done.first = testing::frame(w.scene, stepper, from, w.drive, 1.0 / 30, done.second);
    return done;
  };
  for (const bool recovers : {false, true}) {
    INFO("recovers: " << recovers);
    const auto make = [&] {
      return recovers ? testing::conventional(w.scene) : make_conventional_stepper(w.scene, {});
    };
    const auto stepper = make();
    const StepReport refused = step(*stepper, crowded).first;
    CHECK(refused.status == StepStatus::rejected);
    CHECK(refused.reason == Reason::too_many_pairs);
    const auto [report, after] = step(*stepper, w.state);
    CHECK(report.status == StepStatus::accepted);
    CHECK(after.x == step(*make(), w.state).second.x);
  }
}

}  // namespace selvedge::test_bounded_step
