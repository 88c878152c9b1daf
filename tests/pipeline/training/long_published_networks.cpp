#include <catch2/catch.hpp>

#include <cmath>
#include <iostream>

#include <fmt/format.h>

#include "learned/network/architecture.hpp"
#include "pipeline/meshes/setup_paths.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/training/trainer.hpp"

namespace selvedge::long_published_networks {

// What docs/training.md has of them: `selvedge_tests "published networks*"` prints the lines.
TEST_CASE("published networks: ten steps of each, at the published size", "[training][.long]") {
  for (const char* name : {"hood", "contourcraft", "contourcraft_final", "senc"}) {
    TrainingOptions options = read_training(config_folder() / "training" / "published" / (std::string(name) + ".yaml"),
                                            {"samples.garments=[tshirt]", "samples.clips=[walk]", "samples.shapes=1",
                                             "samples.flesh=false", "optimiser.warm_up=2", "weights=null"});
    auto trainer = make_trainer(options);
    double seconds = 0;
    while (trainer->counts.step < 10) {
      const Clock::time_point began = Clock::now();
      const StepRecord record = train_step(*trainer);
      seconds += seconds_since(began);
      CHECK(record.bad.empty());
      CHECK(std::isfinite(record.sum));
    }
    CHECK(trainer->counts.bad == 0);
    std::cout << fmt::format("{:<20} {:>10} parameters, {:>5} vertices, {:.2f} s a step, {:.0f} days for {} steps\n",
                             name, parameter_count(trainer->architecture),
                             trainer->pool[0].roll.scene->scene.surface.vertex_count, seconds / 10,
                             seconds / 10 * options.steps / 86400, options.steps);
  }
}

}  // namespace selvedge::long_published_networks
