#include "pipeline/suites/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/cells/scene_cells.hpp"
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

std::filesystem::path file_of_scene(const StressRequest& request, const std::string& name) {
  std::filesystem::path file = request.configs / (name + ".yaml");
  if (!std::filesystem::exists(file))
    throw Error("there is no scene `" + name + "`", request.configs.string(),
                "scenes: " + joined(scene_names(request.configs)));
  return file;
}

Setup read_scene(const StressRequest& request, const std::string& name) {
  const std::filesystem::path file = file_of_scene(request, name);
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
  std::string name() const { return fmt::format("{}.repeat_{}", cell_name(scene), index); }
};

struct StressWork {
  StressRequest request;
  std::vector<Repeat> repeats;
  LastSetup last;
  // Repeats of a scene are neighbours, and it is read once for all of them.
  const Setup& setup_of(std::size_t k) {
    const std::string& scene = repeats[k].scene;
    const auto first = std::ranges::find(repeats, scene, &Repeat::scene) - repeats.begin();
    return last.get(static_cast<std::size_t>(first), [&] { return read_scene(request, scene); });
  }
};

// Absent: stopped before its end.
std::optional<CellResult> run_repeat(const StressRequest& request, const Repeat& repeat, const Setup& setup,
                                     const std::filesystem::path& folder, const CellWatch& cell_watch) {
  const Clock::time_point started = Clock::now();
  StressRow row;
  row.scene = repeat.scene;
  row.repeat = repeat.index;
  row.seed = request.seed + static_cast<std::uint64_t>(repeat.index);
  std::optional<Start> start = prepare(setup, cell_watch.stop);
  if (!start) return {};
  row.jitter = jitter_start(setup, request.jitter, row.seed, start->state);
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  StressWatch watch;
  RunRequest run;
  run.out = folder / "run";
  run.checkpoint_seconds = 1e9;
  run.observe = std::ref(watch);
  run.stop = cell_watch.stop;
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
  keep_or_remove(run.out, repeat.index == 0 || !row.passed(), cell_watch.log);
  return CellResult{stress_row_json(row), row.passed(), summary.positions_hash};
}

CellTables write_tables(const std::filesystem::path& out, const std::vector<StressRow>& rows) {
  const CellTables tables{stress_table(rows), stress_json(rows), std::ranges::all_of(rows, &StressRow::passed)};
  write_file(out / "stress.json", tables.json);
  write_file(out / "stress.csv", stress_csv(rows));
  write_file(out / "stress.txt", tables.text);
  return tables;
}

void show_run(const std::filesystem::path& out, const StressRow& row, const std::string& cell) {
  show_result(cell_folder(out, cell) / "run", out / cell_name(row.scene) / fmt::format("repeat_{}", row.repeat));
}

CellTables gather_stress(const std::vector<CellRecord>& records, const std::filesystem::path& out) {
  const auto show = [&](const StressRow& row, const std::string& cell) { show_run(out, row, cell); };
  return write_tables(out, cell_rows(records, read_stress_row, show));
}

std::string log_line(const StressRow& row, int repeats) {
  std::string line =
      fmt::format("{} {} of {}: {}, {}{}\n", row.scene, row.repeat + 1, repeats, row.passed() ? "passed" : "FAILED",
                  duration_text(row.seconds), row.kept ? " (kept from before)" : "");
  for (const std::string& why : row.failures) line += "  " + why + "\n";
  return line;
}

StressWork read_work(const StressRequest& request) {
  StressWork work{request, {}, {}};
  std::vector<std::string> scenes;  // each once
  for (const std::string& scene : request.scenes.empty() ? scene_names(request.configs) : request.scenes)
    if (std::ranges::find(scenes, scene) == scenes.end()) scenes.push_back(scene);
  for (const std::string& scene : scenes) {
    file_of_scene(request, scene);
    for (int k = 0; k < request.repeats; ++k) work.repeats.push_back({scene, k});
  }
  return work;
}

}  // namespace

CellList stress_cells(const StressRequest& request) {
  const auto work = std::make_shared<StressWork>(read_work(request));
  CellList list;
  list.kind = "stress";
  list.program = program_key();
  for (const Repeat& repeat : work->repeats) list.names.push_back(repeat.name());
  number_equal_names(list.names);
  list.describe = [work, names = list.names](std::size_t k) {
    const Setup& setup = work->setup_of(k);
    return WorkCell{names[k], needs_of(setup), rough_seconds(setup.scene.surface.vertex_count, setup.run.frames)};
  };
  list.key = [work](std::size_t k) {
    const StressRequest& asked = work->request;
    return fmt::format("{} {} {}", inputs_key(work->setup_of(k)), asked.seed, asked.jitter);
  };
  list.run = [work](std::size_t k, const std::filesystem::path& folder, const CellWatch& watch) {
    return run_repeat(work->request, work->repeats[k], work->setup_of(k), folder, watch);
  };
  list.gather = gather_stress;
  return list;
}

std::vector<StressRow> stress(const StressRequest& request) {
  const CellList list = stress_cells(request);
  for (std::size_t k = 0; k < list.names.size(); ++k) list.describe(k);  // errors before hours of work
  std::vector<StressRow> rows;
  const auto show = [&](const StressRow& row, const std::string& cell) {
    show_run(request.out, row, cell);
    if (request.log) *request.log << log_line(row, request.repeats) << std::flush;
    write_tables(request.out, rows);
  };
  do_rows(list, request.out, {request.log, request.stop}, read_stress_row, show, rows);
  return rows;
}

}  // namespace selvedge
