#include "pipeline/suites/bench.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/compare/compare_run.hpp"
#include "pipeline/host/peak_memory.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

// Keeps the states before a few steps that met no contact, early and late in the run.
struct StateSampler {
  int every = 1;
  State before;
  std::vector<std::pair<State, double>> samples;  // state and the substep that the stepper took from it [s]
  double dt = 0;

  void operator()(const FrameEvent& event) {
    const CollisionReport& collision = event.report.collision;
    const bool free = collision.contacts + collision.impulses + collision.zones == 0;
    if (free && event.state.frame % every == 0 && event.report.substeps > 0)
      samples.emplace_back(before, dt / event.report.substeps);
    before = event.state;
  }
};

std::optional<AlgebraicError> worst_error(const Setup& setup, const StateSampler& sampler) {
  std::optional<AlgebraicError> worst;
  for (const auto& [state, dt] : sampler.samples)
    if (const auto found = algebraic_error(setup, state, dt); found && (!worst || found->error > worst->error))
      worst = found;
  return worst;
}

// Energy lost in a run to `end` over what the same steps, each solved to its minimiser, lose.
std::optional<double> energy_decay(const State& start, const State& end, const Setup& converged) {
  const auto reference = timed_run(converged, *prepare(converged), {.measured = false}, {});
  if (!reference || !reference->trouble.empty() || !(reference->lost > 0)) return {};
  return (energy_of(converged, start) - energy_of(converged, end)) / reference->lost;
}

std::filesystem::path scene_file(const BenchRequest& request, const std::string& scene) {
  return request.configs / (scene + ".yaml");
}

BenchMember run_member(const BenchRequest& request, const std::string& scene, int size) {
  std::vector<std::string> overrides{
      fmt::format("cloths.0.{}.resolution={}", scene == "tube" ? "tube" : "rectangle", size)};
  if (request.frames) overrides.push_back(fmt::format("run.frames={}", *request.frames));
  const std::filesystem::path file = scene_file(request, scene);
  const Setup setup = read_setup(file, overrides);
  const Start start = *prepare(setup);
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);

  StateSampler sampler;
  sampler.before = start.state;
  sampler.dt = 1 / setup.run.fps;
  sampler.every = std::max(1, setup.run.frames / 4);
  RunRequest run;
  run.out = request.out / fmt::format("{}_{}", scene, size);
  run.checkpoint_seconds = 1e9;
  if (scene == "hang") run.observe = std::ref(sampler);
  reset_peak_memory();
  BenchMember member{scene, size, run_scene(setup, start, *stepper, run), {}, {}};
  member.algebraic = worst_error(setup, sampler);
  if (scene == "hang") {
    overrides.insert(overrides.end(), {"solver.relative_tolerance=0", "solver.velocity_tolerance=1e-5",
                                       "solver.max_newton=40", "solver.linear_tolerance=0.01"});
    member.decay = energy_decay(start.state, sampler.before, read_setup(file, overrides));
  }
  return member;
}

bool has_part(const BenchRequest& request, const std::string& part) {
  return std::ranges::find(request.only, part) != request.only.end();
}

void write_results(const BenchRequest& request, const BenchResult& result, const std::string& news) {
  if (request.log) *request.log << news << std::flush;
  write_file(request.out / "bench.json", bench_json(result));
  write_file(request.out / "bench.csv", bench_csv(result.members));
  write_file(request.out / "bench.txt", bench_table(result));
}

}  // namespace

BenchResult bench(const BenchRequest& request) {
  for (const std::string& scene : request.scenes)
    if (has_part(request, "scenes") && !std::filesystem::exists(scene_file(request, scene)))
      throw Error("there is no such scene", scene_file(request, scene).string(),
                  "scenes are files of configs/bench; run from the repository's root, or give --configs");
  make_folder(request.out);
  BenchResult result;
  if (has_part(request, "detection")) {
    result.detection = time_detection();
    write_results(request, result, detection_table(result.detection));
  }
  if (has_part(request, "engine")) {
    result.engine = time_engine();
    write_results(request, result, engine_table(*result.engine));
  }
  if (has_part(request, "training")) {
    for (const int threads : {1, 2}) result.training.push_back(time_training("small", 29, threads, 25));
    write_results(request, result, training_table(result.training));
  }
  if (!has_part(request, "scenes")) return result;
  for (const std::string& scene : request.scenes)
    for (const int size : request.sizes) {
      const BenchMember& member = result.members.emplace_back(run_member(request, scene, size));
      write_results(request, result,
                    fmt::format("{} {}: {:.1f} ms a frame, {} pairs in the worst frame\n", scene, size,
                                mean_milliseconds(member.summary), member.summary.worst_pairs));
    }
  return result;
}

}  // namespace selvedge
