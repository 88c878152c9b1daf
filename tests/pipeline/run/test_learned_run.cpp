#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"

// Runs of the stepper `learned`, as `selvedge simulate` makes them.
namespace selvedge::test_learned_run {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

const std::string sheet_on_ball =
    "cloths: [{name: sheet, rectangle: {size: [0.3, 0.3], resolution: 8}, translate: [0, 0.3, 0], pins: "
    "[{group: [top_left]}]}]\n"
    "obstacles: [{name: ball, sphere: {radius: 0.1, edge: 0.04}, motion: {keyframes: [{time: 0}, {time: "
    "1, translate: [0.3, 0, 0]}]}}]\n";

// An untrained network in the scene's folder.
void write_network(const Folder& folder, const std::string& name, const std::string& preset) {
  const fake::NarrowNetwork network = fake::narrow_network(preset);
  write_weight_file(folder.path / name, {network.architecture, network.weights, "", {}, ""});
}

Setup read(const Folder& folder, const std::string& run, const std::vector<std::string>& overrides = {}) {
  return read_setup(fake::write(folder, "scene.yaml", sheet_on_ball + "run: " + run + "\n"), overrides);
}

RunSummary run(const Setup& setup, const std::filesystem::path& out, bool resume = false, int stop = 100) {
  return fake::run(setup, *make_stepper(setup), out, resume, stop);
}

}  // namespace

TEST_CASE("A learned run that is stopped and resumed has the frames of one that is not, bit by bit", "[learned_run]") {
  for (const char* preset : {"hood", "contourcraft", "tiny"}) {
    INFO(preset);
    const Folder folder("learned_resume");
    write_network(folder, "w.h5", preset);
    const Setup setup = read(folder, "{frames: 7, stepper: learned, learned: {weights: w.h5}}");
    REQUIRE(run(setup, folder.path / "whole").frames == 7);
    REQUIRE(run(setup, folder.path / "parts", false, 3).frames == 3);
    REQUIRE(run(setup, folder.path / "parts", true).frames == 7);
    const TrajectoryReader whole(folder.path / "whole" / "run.h5"), parts(folder.path / "parts" / "run.h5");
    REQUIRE(parts.frame_count() == whole.frame_count());
    for (int f = 0; f < whole.frame_count(); ++f) {
      INFO(f);
      CHECK(parts.frame(f).x == whole.frame(f).x);
      CHECK(parts.frame(f).report.by == whole.frame(f).report.by);
    }
    CHECK(whole.frame(7).x != whole.frame(6).x);
  }
}

TEST_CASE("A learned run is not resumed with other weights under the same name", "[learned_run]") {
  const Folder folder("learned_other");
  for (const char* stepper : {"learned", "hybrid"}) {
    INFO(stepper);
    write_network(folder, "w.h5", "hood");
    const Setup setup = read(folder, std::string("{frames: 5, stepper: ") + stepper + ", learned: {weights: w.h5}}");
    REQUIRE(run(setup, folder.path / stepper, false, 2).frames == 2);
    std::filesystem::rename(folder.path / "w.h5", folder.path / "kept.h5");
    write_network(folder, "w.h5", "hood_cvpr");
    CHECK_THROWS_WITH(run(setup, folder.path / stepper, true), Contains("w.h5") && Contains("has changed"));
    std::filesystem::rename(folder.path / "kept.h5", folder.path / "w.h5");
    CHECK(run(setup, folder.path / stepper, true).frames == 5);
  }
}

TEST_CASE("The keys of run.learned: weights are seen from the scene file, settle adds a frame at rest",
          "[learned_run]") {
  const Folder folder("learned_keys");
  write_network(folder, "w.h5", "contourcraft");
  const Setup plain = read(folder, "{frames: 2, stepper: learned, learned: {weights: w.h5}}");
  CHECK(plain.run.learned.weights == "w.h5");
  CHECK_FALSE(plain.run.learned.settle);
  const Setup settled = read(folder, "{frames: 2, stepper: learned, learned: {weights: w.h5, settle: true}}");
  CHECK(settled.run.learned.settle);
  const auto first = [](const Setup& setup) {
    State to;
    REQUIRE(testing::frame(setup.scene, *make_stepper(setup), setup.initial, setup.drive_at(1.0 / 30), 1.0 / 30, to)
                .status == StepStatus::accepted);
    return to.x;
  };
  CHECK(first(plain) != first(settled));
  // What is written of a scene reads back.
  const Setup again = read_setup(fake::write(folder, "again.yaml", settled.config));
  CHECK(again.run.learned.settle);
  CHECK(first(again) == first(settled));

  const auto whole = (folder.path / "w.h5").string();
  CHECK(first(read(folder, "{stepper: learned}", {"run.learned.weights=" + whole})) == first(plain));
  CHECK_THROWS_WITH(make_stepper(read(folder, "{stepper: learned}")),
                    Contains("`learned` needs a weight file") && Contains("run.learned.weights"));
  CHECK_THROWS_WITH(make_stepper(read(folder, "{stepper: learned, learned: {weights: none.h5}}")), Contains("none.h5"));
  CHECK_THROWS_WITH(read(folder, "{stepper: learned, learned: {weight: w.h5}}"), Contains("did you mean `weights`"));
  CHECK_THROWS_WITH(read(folder, "{stepper: learned, learned: {settle: 3}}"), Contains("settle"));
}

}  // namespace selvedge::test_learned_run
