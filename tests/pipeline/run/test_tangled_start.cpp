#include <catch2/catch.hpp>

#include "pipeline/scene/make_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_tangled_start {

// As a set of recorded motion begins: the arms lie on the body, and skinning leaves the shirt in itself and in them.
TEST_CASE("A T-shirt that is skinned into a tangle takes no more than ten clean frames' iterations",
          "[tangled_start]") {
  const fake::Folder folder("tangled_start");
  const Setup setup =
      read_setup(fake::write(folder, "scene.yaml",
                             "cloths: [{garment: {cut: tshirt, edge: 0.04}}]\n"
                             "obstacles: [{name: person, body: {model: mannequin, clip: arms_folded}}]\n"
                             "run: {frames: 8}\n"));
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  const double dt = 1 / setup.run.fps;
  State state = setup.initial;
  int most = 0, clean = 0, frames = 0, passes = 0;
  while (state.frame < 8) {
    State next;
    const StepReport report = testing::frame(setup.scene, *stepper, state, setup.drive_at(state.time + dt), dt, next);
    REQUIRE(report.status == StepStatus::accepted);
    passes += report.untangling;
    if (state.clean && !report.out_of_newton) {
      clean += report.iterations;
      ++frames;
    } else {
      most = std::max(most, report.iterations);
    }
    // Untangled, or the report says that something is left.
    CHECK((next.clean || report.collision.left_alone > 0 || report.out_of_untangling));
    state = next;
  }
  CHECK(passes > 0);
  REQUIRE(frames > 0);
  CHECK(most <= 10 * clean / frames);
  CHECK(state.clean);
}

}  // namespace selvedge::test_tangled_start
