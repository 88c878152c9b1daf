#include <catch2/catch.hpp>

#include <cmath>
#include <ctime>
#include <iostream>

#include <fmt/format.h>

#include "learned/network/architecture.hpp"
#include "pipeline/host/peak_memory.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/training/trainer.hpp"

namespace selvedge::long_published_networks {

// What docs/results/networks.md has of them: `selvedge_tests "published networks*"` prints the lines.
TEST_CASE("published networks: ten steps of each, at the published size", "[training][.long]") {
  for (const char* name : {"hood", "contourcraft", "contourcraft_final", "senc"}) {
    TrainingOptions options = read_training(config_folder() / "training" / "published" / (std::string(name) + ".yaml"),
                                            {"samples.garments=[tshirt]", "samples.clips=[walk]", "samples.shapes=1",
                                             "samples.flesh=false", "optimiser.warm_up=2", "weights=null"});
    reset_peak_memory();
    auto trainer = make_trainer(options);
    double seconds = 0, of_processor = 0;
    while (trainer->counts.step < 10) {
      const Clock::time_point began = Clock::now();
      const std::clock_t before = std::clock();
      const StepRecord record = train_step(*trainer);
      seconds += seconds_since(began);
      of_processor += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
      CHECK(record.adam.taken);
      CHECK(std::isfinite(record.samples[0].sum));
    }
    CHECK(trainer->counts.bad == 0);
    std::cout << fmt::format(
                     "{:<20} {:>10} parameters, {:>5} vertices, {:.2f} s a step, {:.2f} s of processor time, {:.2f} "
                     "GiB, {:.0f} days for {} steps",
                     name, parameter_count(trainer->architecture),
                     trainer->pool[0].roll.scene->scene.surface.vertex_count, seconds / 10, of_processor / 10,
                     static_cast<double>(peak_memory()) / (1 << 30), seconds / 10 * options.steps / 86400,
                     options.steps)
              << std::endl;
  }
}

}  // namespace selvedge::long_published_networks
