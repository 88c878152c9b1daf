#include <catch2/catch.hpp>

#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_step_counts {

using testing::make_world;
using testing::World;

namespace {

World hanging() {
  World w = make_world(testing::sheet(14, 0.5, 1));
  w.scene.pins = {0, 14};
  w.drive = at_rest(w.scene, w.state);
  return w;
}

World dropped() {
  World w = make_world(testing::sheet(14, 0.5, 0.01));
  testing::add_obstacle(w, testing::sheet(4, 0.2, 0));
  return w;
}

World sliding() {
  World w = make_world(testing::tilted(testing::sheet(14, 0.5, 0.003), 0.5));
  testing::add_obstacle(w, testing::tilted(testing::sheet(2, 4, 0), 0.5));
  return w;
}

struct Counted {
  int iterations = 0;
  StepCounts counts;
};

Counted counted(const World& w, int frames) {
  Counted sum;
  const auto stepper = testing::conventional(w.scene);
  State state = w.state, to;
  for (int f = 0; f < frames; ++f) {
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.collision.pairs_after == 0);
    sum.iterations += report.iterations;
    sum.counts += report.counts;
    std::swap(state, to);
  }
  return sum;
}

// Rounding differs a little between instruction sets, so counts are held to a tenth.
void stays(const char* what, double count, double known) {
  CAPTURE(what, count);
  CHECK(count <= 1.1 * known + 1);
  CHECK(count >= 0.9 * known - 1);
}

void stays(const Counted& found, const Counted& known) {
  stays("iterations", found.iterations, known.iterations);
  stays("solves", found.counts.solves, known.counts.solves);
  stays("coarse builds", found.counts.coarse_builds, known.counts.coarse_builds);
  stays("searches", found.counts.searches, known.counts.searches);
  stays("candidates", static_cast<double>(found.counts.candidates), static_cast<double>(known.counts.candidates));
  stays("audits", found.counts.audits, known.counts.audits);
}

}  // namespace

// Whoever makes the stepper cheaper, or dearer, says so here.
TEST_CASE("Counts of work stay what they are in three small scenes", "[conventional_stepper]") {
  stays(counted(hanging(), 8), {67, {16, 34, 17, 28000, 24}});
  stays(counted(dropped(), 8), {161, {49, 90, 66, 51874, 24}});  // pairs with obstacles are a search of their own
  stays(counted(sliding(), 8), {82, {46, 45, 18, 51621, 24}});
}

}  // namespace selvedge::test_step_counts
