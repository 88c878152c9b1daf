#include "pipeline/cells/shot_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "pipeline/cells/do_cells.hpp"
#include "pipeline/cells/scene_cells.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

ShotRow row_of_run(const Shot& shot, const RunSummary& summary) {
  ShotRow row;
  row.shot = shot.name;
  row.scene = shot.scene.filename().string();
  row.passed = is_clean(summary);
  row.vertices = summary.vertices;
  row.frames = summary.frames;
  row.frames_wanted = summary.frames_wanted;
  row.pairs = summary.pairs;
  row.milliseconds = median_milliseconds(summary);
  row.max_stretch = summary.max_stretch;
  row.reason = summary.reason;
  row.positions_hash = fmt::format("{:016x}", summary.positions_hash);
  return row;
}

// Absent: stopped before its end.
std::optional<CellResult> run_shot(const Shot& shot, const Setup& setup, const std::filesystem::path& folder, bool page,
                                   const CellWatch& watch) {
  const Clock::time_point started = Clock::now();
  read_tissue(cache_folder(), setup.bodies);
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  const std::optional<Start> start = prepare(setup, watch.stop);
  if (!start) return {};
  RunRequest run;
  run.out = folder;
  run.stop = watch.stop;
  const RunSummary summary = run_scene(setup, *start, *stepper, run);
  keep_tissue(setup, watch.log);
  if (summary.end == RunEnd::interrupted) return {};
  if (page)
    if (const auto trouble = write_page(folder); trouble && watch.log) *watch.log << "no page: " << *trouble << "\n";
  ShotRow row = row_of_run(shot, summary);
  row.seconds = seconds_since(started);
  return CellResult{shot_row_json(row), row.passed, summary.positions_hash};
}

CellTables gather_shots(const std::vector<CellRecord>& records, const std::filesystem::path& out) {
  const std::vector<ShotRow> rows = cell_rows(records, read_shot_row, [](const ShotRow&, const std::string&) {});
  const CellTables tables{shots_table(rows), shots_json(rows), std::ranges::all_of(rows, &ShotRow::passed)};
  write_file(out / "shots.json", tables.json);
  write_file(out / "shots.csv", shots_csv(rows));
  write_file(out / "shots.txt", tables.text);
  return tables;
}

}  // namespace

CellList shot_cells(const ShotRequest& request) {
  CellList list;
  list.kind = "shots";
  list.program = program_key();
  for (const Shot& shot : request.shots) list.names.push_back(shot.name);
  const auto last = std::make_shared<LastSetup>();
  const auto setup_of = [request, last](std::size_t k) -> const Setup& {
    const Shot& shot = request.shots[k];
    return last->get(k, [&] { return read_setup(shot.scene, shot.overrides); });
  };
  list.describe = [request, setup_of](std::size_t k) {
    const Setup& setup = setup_of(k);
    return WorkCell{request.shots[k].name, needs_of(setup),
                    rough_seconds(setup.scene.surface.vertex_count, setup.run.frames)};
  };
  list.key = [request, setup_of](std::size_t k) {
    return inputs_key(setup_of(k)) + (request.pages ? "" : " without page");
  };
  list.run = [request, setup_of](std::size_t k, const std::filesystem::path& folder, const CellWatch& watch) {
    return run_shot(request.shots[k], setup_of(k), folder, request.pages, watch);
  };
  list.gather = gather_shots;
  return list;
}

}  // namespace selvedge
