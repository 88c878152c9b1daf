#include "pipeline/suites/stress.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/jitter.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/suites/kept_run.hpp"

namespace selvedge {
namespace {

constexpr double least_obstacle_lag = 1e-9;  // below it an obstacle is where it was wanted, but for rounding [m]
constexpr double most_held = 0.01;           // share of vertex-steps: frozen cloth is not clean cloth

// What the frames of a run show beyond its summary.
struct StressWatch {
  int wanted_frames = 0;

  void operator()(const FrameEvent& event) {
    const CollisionReport& collision = event.report.collision;
    wanted_frames += collision.pairs_wanted > 0 || collision.depth_wanted > 0;
  }
};

std::vector<std::string> scene_names(const std::filesystem::path& configs) {
  if (!std::filesystem::is_directory(configs))
    throw Error("there is no such folder", configs.string(), "run from the repository's root, or give --configs");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(configs))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

Setup read_scene(const StressRequest& request, const std::string& name) {
  const std::filesystem::path file = request.configs / (name + ".yaml");
  if (!std::filesystem::exists(file))
    throw Error("there is no scene `" + name + "`", request.configs.string(),
                "scenes: " + joined(scene_names(request.configs)));
  Setup setup = read_setup(file);
  if (setup.outcomes.empty())
    throw Error("the scene states no `outcome`", file.string(), "say what must come true of it");
  return request.short_form && !setup.short_form.empty() ? read_setup(file, setup.short_form) : setup;
}

// Whether the scene says that obstacles must wait for want of room.
bool obstacles_must_lag(const Setup& setup) {
  return std::ranges::any_of(setup.outcomes, [](const Outcome& outcome) {
    return std::holds_alternative<Lag>(outcome.measure) && outcome.once && outcome.least > 0;
  });
}

std::vector<std::string> failures_of(const StressRow& row, const RunSummary& summary, const Setup& setup) {
  std::vector<std::string> all;
  const auto fail_if = [&](bool bad, std::string why) {
    if (bad) all.push_back(std::move(why));
  };
  fail_if(summary.end != RunEnd::finished, fmt::format("ended in frame {} {}", summary.frames, summary.reason));
  fail_if(row.nonfinite > 0, counted(row.nonfinite, "vertex", "vertices") + " not finite");
  fail_if(row.pairs > 0, fmt::format("{}, most in frame {}", counted(row.pairs, "intersecting pair"), row.worst_frame));
  fail_if(row.vertex_pairs > 0,
          counted(row.vertex_pairs, "pair that shares a vertex crosses", "pairs that share a vertex cross"));
  fail_if(row.worst_inside > 0, counted(row.worst_inside, "vertex", "vertices") + " inside an obstacle");
  const auto cut_out = static_cast<long>(total_of(summary.fields, "cut_out").at_end);
  fail_if(cut_out > 0, counted(cut_out, "triangle") + " still cut out");
  fail_if(row.passed_through > 0, fmt::format("{} passed through", row.passed_through));
  fail_if(row.held_share >= most_held, fmt::format("{:.2f} % of vertex-steps held back", 100 * row.held_share));
  if (!obstacles_must_lag(setup)) {
    fail_if(row.obstacle_lag > least_obstacle_lag,
            fmt::format("obstacles lag {:.2g} m where there is room", row.obstacle_lag));
    fail_if(row.wanted_frames > 0,
            counted(row.wanted_frames, "frame touches", "frames touch") + " the wanted positions");
  }
  for (std::size_t k = 0; k < summary.outcomes.size(); ++k)
    fail_if(!summary.outcomes[k].came_true, summary.outcome_lines[k]);
  return all;
}

struct Repeat {
  std::string scene;
  int index = 0;
  std::filesystem::path folder;  // of the scene
  std::string key;               // of the program and its settings
  std::filesystem::path row_file() const { return folder / fmt::format("repeat_{}.json", index); }
  std::filesystem::path run_folder() const { return folder / fmt::format("repeat_{}", index); }
};

// Absent: stopped before its end.
std::optional<StressRow> run_repeat(const StressRequest& request, const Repeat& repeat) {
  const Clock::time_point started = Clock::now();
  StressRow row;
  row.scene = repeat.scene;
  row.repeat = repeat.index;
  row.seed = request.seed + static_cast<std::uint64_t>(repeat.index);
  const Setup setup = read_scene(request, repeat.scene);
  std::optional<Start> start = prepare(setup, request.stop);
  if (!start) return {};
  row.jitter = jitter_start(setup, request.jitter, row.seed, start->state);
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  StressWatch watch;
  RunRequest run;
  run.out = repeat.run_folder();
  run.checkpoint_seconds = 1e9;
  run.observe = std::ref(watch);
  run.stop = request.stop;
  const RunSummary summary = run_scene(setup, *start, *stepper, run);
  if (summary.end == RunEnd::interrupted) return {};

  row.vertices = summary.vertices;
  row.frames = summary.frames;
  row.frames_wanted = summary.frames_wanted;
  row.pairs = summary.pairs;
  row.vertex_pairs = summary.vertex_pairs;
  row.nonfinite = summary.nonfinite;
  row.worst_frame = summary.worst_frame;
  row.worst_inside = summary.worst_inside;
  row.wanted_frames = watch.wanted_frames;
  row.passed_through = static_cast<long>(total_of(summary.fields, "passed_through").sum);
  row.impulses = static_cast<long>(total_of(summary.fields, "impulses").sum);
  row.zones = static_cast<long>(total_of(summary.fields, "zones").sum);
  row.shortened = static_cast<long>(total_of(summary.fields, "shortened").sum);
  row.held_share = held_fraction(summary);
  row.obstacle_lag = total_of(summary.fields, "obstacle_lag").largest;
  row.max_stretch = summary.max_stretch;
  row.outcome = summary.outcome_lines;
  row.failures = failures_of(row, summary, setup);
  row.seconds = seconds_since(started);
  return row;
}

void write_tables(const StressRequest& request, const std::vector<StressRow>& rows) {
  write_file(request.out / "stress.json", stress_json(rows));
  write_file(request.out / "stress.csv", stress_csv(rows));
  write_file(request.out / "stress.txt", stress_table(rows));
}

std::string log_line(const StressRow& row, int repeats) {
  std::string line =
      fmt::format("{} {} of {}: {}, {}{}\n", row.scene, row.repeat + 1, repeats, row.passed() ? "passed" : "FAILED",
                  duration_text(row.seconds), row.kept ? " (kept from before)" : "");
  for (const std::string& why : row.failures) line += "  " + why + "\n";
  return line;
}

}  // namespace

std::vector<StressRow> stress(const StressRequest& request) {
  make_folder(request.out);
  const std::vector<std::string> scenes = request.scenes.empty() ? scene_names(request.configs) : request.scenes;
  for (const std::string& scene : scenes) read_scene(request, scene);  // errors before hours of work
  const std::string program = program_key();
  std::vector<StressRow> rows;
  for (const std::string& scene : scenes) {
    const std::filesystem::path folder = request.out / scene;
    make_folder(folder);
    const std::string config = whole_file(request.configs / (scene + ".yaml"));
    bool failed_before = false;
    for (int k = 0; k < request.repeats; ++k) {
      const Repeat repeat{scene, k, folder,
                          fmt::format("{} {:016x} {} {} {}", program, hash_of(config), request.seed, request.jitter,
                                      request.short_form ? "short" : "full")};
      std::optional<StressRow> row = read_stress_row(whole_file(repeat.row_file()), repeat.key);
      if (!row) {
        row = run_repeat(request, repeat);
        if (!row) return rows;
        // The first run of a scene, and its first that failed.
        keep_or_remove(repeat.run_folder(), k == 0 || (!row->passed() && !failed_before), request.log);
        write_file(repeat.row_file(), stress_row_json(*row, repeat.key));
      }
      failed_before = failed_before || !row->passed();
      rows.push_back(*row);
      write_tables(request, rows);
      if (request.log) *request.log << log_line(*row, request.repeats) << std::flush;
    }
  }
  return rows;
}

}  // namespace selvedge
