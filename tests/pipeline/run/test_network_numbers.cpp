#include <catch2/catch.hpp>

#include "learned/network/engine_kernels.hpp"
#include "learned/steppers/network_device.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/simulate.hpp"
#include "tests/frame.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

// A network that multiplies integers of 16 bits, beside the same one with floats of 32.
namespace selvedge::test_network_numbers {

using fake::Folder;

namespace {

constexpr double dt = 1.0 / 30;

Setup dressed(const Folder& folder, const std::string& weights, const std::string& numbers) {
  return read_setup(fake::write(folder, numbers + ".yaml",
                                "cloths: [{name: worn, garment: {outfit: summer, form: small}, material: hood}]\n"
                                "obstacles: [{name: person, body: {model: mannequin, clip: walk}}]\n"
                                "run: {stepper: learned, learned: {weights: " +
                                    (source_root() / "configs/weights" / weights).string() + ", numbers: " + numbers +
                                    "}}\n"));
}

double rms(const Points& d) { return std::sqrt(d.rowwise().squaredNorm().mean()); }

}  // namespace

TEST_CASE("16-bit integers change a network's step by a thousandth of its motion", "[learned]") {
  if (!is_supported(InstructionSet::vnni)) {
    WARN("left out: this processor has no kernels for int16");
    return;
  }
  const Folder folder("network_numbers");
  for (const char* weights : {"contourcraft_shown.h5", "hood.h5", "senc_layers.h5"}) {
    const Setup exact = dressed(folder, weights, "float32"), rounded = dressed(folder, weights, "int16");
    const auto stepper = make_stepper(exact), rough = make_stepper(rounded);
    State from = prepare(exact)->state;
    double motion = 0, difference = 0;
    for (int frame = 0; frame < 12; ++frame) {
      const Drive drive = exact.drive_at(from.time + dt);
      State to, other;
      REQUIRE(testing::frame(exact.scene, *stepper, from, drive, dt, to).status == StepStatus::accepted);
      REQUIRE(testing::frame(rounded.scene, *rough, from, drive, dt, other).status == StepStatus::accepted);
      if (frame > 0) {  // the first has HOOD's settling pass
        motion += rms(to.x - from.x);
        difference += rms(other.x - to.x);
      }
      from = std::move(to);
    }
    INFO(weights);
    CHECK(difference > 0);
    CHECK(difference < 1e-3 * motion);
  }
}

TEST_CASE("Where the processor has no kernels for int16, `auto` takes float32 and int16 is an error with a cure",
          "[learned]") {
  CHECK(kernels_of(NetworkNumbers::float32) == best_instruction_set());
  if (is_supported(InstructionSet::vnni)) {
    CHECK(kernels_of(NetworkNumbers::automatic) == InstructionSet::vnni);
    CHECK(kernels_of(NetworkNumbers::int16) == InstructionSet::vnni);
  } else {
    CHECK(kernels_of(NetworkNumbers::automatic) == best_instruction_set());
    CHECK_THROWS_WITH(kernels_of(NetworkNumbers::int16),
                      Catch::Contains("run.learned.numbers") && Catch::Contains("float32"));
  }
}

}  // namespace selvedge::test_network_numbers
