#include "pipeline/tools/plan.hpp"

#include <catch2/catch.hpp>

#include "learned/network/weights_hdf5.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_plan {
using Catch::Matchers::Contains;
using fake::Folder;

namespace {

std::string plan_of(const Folder& folder, const std::string& preset, const std::vector<std::string>& overrides) {
  const fake::NarrowNetwork network = fake::narrow_network(preset);
  write_weight_file(folder.path / "w.h5", {network.architecture, network.weights, "", {}, ""});
  return plan_text(read_setup(fake::write(folder, "scene.yaml",
                                          "cloths: [{rectangle: {size: [1, 1], resolution: 4}}]\n"
                                          "run: {stepper: learned, learned: {weights: w.h5}}\n"),
                              overrides));
}

}  // namespace

TEST_CASE("plan: keys are named whole, so that they can be given", "[plan]") {
  const Folder folder("plan_keys");
  CHECK_THAT(plan_of(folder, "contourcraft", {}), Contains("not asked for by run.learned.settle"));
  CHECK_THAT(plan_of(folder, "contourcraft", {"run.learned.settle=true"}), Contains("as run.learned.settle asks"));
  CHECK_THAT(plan_of(folder, "hood", {"run.learned.device=libtorch"}), Contains("as run.learned.device asks"));
  CHECK_THAT(plan_of(folder, "hood", {"run.stepper=hybrid"}), Contains("by run.hybrid.stop_when_slow"));
}

TEST_CASE("plan: a frame rate that a network does not make is the error of a run", "[plan]") {
  const Folder folder("plan_rate");
  for (const char* stepper : {"run.stepper=learned", "run.stepper=hybrid"})
    CHECK_THROWS_WITH(plan_of(folder, "hood", {stepper, "run.fps=24"}),
                      Contains("does not make 24 frames") && Contains("fps: 30"));
  CHECK_NOTHROW(plan_of(folder, "hood", {"run.stepper=icm", "run.fps=24"}));
}

TEST_CASE("plan: says of every stepper whether a repulsive layer stands behind it", "[plan]") {
  const Folder folder("plan_layer");
  for (const char* stepper : {"run.stepper=learned", "run.stepper=hybrid", "run.stepper=conventional"}) {
    CHECK_THAT(plan_of(folder, "hood", {stepper}), Contains("not asked for by run.refu.on"));
    CHECK_THAT(plan_of(folder, "hood", {stepper, "run.refu.on=true"}), Contains("in   repulsive layer"));
  }
}

TEST_CASE("plan: weights of the repulsive layer that a run would not find are its error", "[plan]") {
  const Folder folder("plan_layer_weights");
  const std::string missing = "run.refu.weights=missing.h5";
  CHECK_THROWS_WITH(plan_of(folder, "hood", {"run.stepper=icm", "run.refu.on=true", missing}), Contains("missing.h5"));
  CHECK_NOTHROW(plan_of(folder, "hood", {"run.stepper=icm", missing}));
}

TEST_CASE("plan: a push that no body is deep enough for is one clear error", "[plan]") {
  const Folder folder("plan_layer_alpha");
  CHECK_THROWS_WITH(plan_of(folder, "hood", {"run.refu.alpha=1e308"}), Contains("alpha") && Contains("0 to 1000"));
}

TEST_CASE("plan: a small network sees the body without edges", "[plan]") {
  const Folder folder("plan_body");
  CHECK_THAT(plan_of(folder, "small", {}), Contains("the body's nearest face"));
}

}  // namespace selvedge::test_plan
