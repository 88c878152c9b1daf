#include "pipeline/suites/wardrobe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/search/intersections.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/cells/scene_cells.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/motions/clip_split.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/suites/kept_run.hpp"

namespace selvedge {
namespace {

constexpr double least_body_lag = 1e-9;  // below it the body is where it was wanted, but for rounding [m]
constexpr double most_depth = 1e-3;
constexpr int frames_after = 10;  // that are excused after the body has passed through itself

// A garment or an outfit.
struct Wear {
  std::string name;
  bool outfit = false, validation = false;
};

std::vector<Wear> everything(const Wardrobe& wardrobe) {
  std::vector<Wear> all;
  for (const std::string& name : garment_names())
    all.push_back({name, false, std::ranges::find(wardrobe.validation, name) != wardrobe.validation.end()});
  for (const Outfit& outfit : wardrobe.outfits) all.push_back({outfit.name, true, outfit.validation});
  return all;
}

// Those with the names, in the order of the list; all where no name is given.
template <class Item>
std::vector<Item> chosen(const std::vector<Item>& all, const std::vector<std::string>& names, const char* what) {
  refuse_unknown(names, names_of(all), what, "wardrobe", "known");
  std::vector<Item> found;
  for (const Item& item : all)
    if (names.empty() || std::ranges::find(names, item.name) != names.end()) found.push_back(item);
  return found;
}

Setup read_row(const WardrobeRequest& request, const Wear& wear, const ClipEntry& clip) {
  const std::filesystem::path file = request.configs / "wardrobe" / (wear.outfit ? "outfit.yaml" : "garment.yaml");
  std::vector<std::string> overrides{"obstacles.0.body.clip=" + clip.name,
                                     std::string("cloths.0.garment.") + (wear.outfit ? "outfit=" : "cut=") + wear.name};
  Setup setup = read_setup(file, overrides);
  // The blend into the clip comes before it.
  const int before = setup.run.frames - 180;
  setup.run.frames = before + (request.most_frames > 0 ? std::min(request.most_frames, clip.frames) : clip.frames);
  return setup;
}

// All outfits of as many garments share this in a clip, because the body's room depends on that number: the body's
// positions at the frames, and in which frames it passes through itself or did so a few frames before.
struct ClipBody {
  PosedBodies known{.at = {}, .keeps_all = true, .skin = {}, .store = {}};
  std::vector<char> excused;
};
using ClipBodies = std::map<std::size_t, ClipBody>;  // by the number of garments

// In which frames of the setup its body, its first obstacle, passes through itself.
void find_excused(const Setup& setup, ClipBody& body) {
  if (!body.excused.empty()) return;
  IntersectionCache cache;
  int left = 0;
  double time = setup.initial.time;
  for (int frame = 0; frame <= setup.run.frames; ++frame, time += 1 / setup.run.fps) {
    if (!intersecting_pairs(setup.scene.obstacles[0].surface, setup.drive_at(time).obstacles[0], cache).empty())
      left = frames_after + 1;
    body.excused.push_back(left > 0);
    left = std::max(0, left - 1);
  }
}

// Adds a frame to its row.
struct WardrobeWatch {
  const std::vector<char>& excused;
  WardrobeRow& row;

  void operator()(const FrameEvent& event) {
    if (event.report.audit) row.cloth_pairs += static_cast<long>(event.report.audit->self_pairs.size());
    if (excused[static_cast<std::size_t>(event.state.frame)]) return;
    const CollisionReport& collision = event.report.collision;
    if (event.report.audit) row.body_pairs += static_cast<long>(event.report.audit->obstacle_pairs.size());
    row.lag = std::max(row.lag, collision.obstacle_lag);
    row.depth = std::max(row.depth, collision.depth_wanted);
  }
};

std::vector<std::string> failures_of(const WardrobeRow& row, const RunSummary& summary,
                                     const std::vector<char>& excused) {
  std::vector<std::string> all;
  const auto fail_if = [&](bool bad, std::string why) {
    if (bad) all.push_back(std::move(why));
  };
  const bool rejected = summary.end != RunEnd::finished;
  const bool for_the_body = rejected && excused[static_cast<std::size_t>(std::min(row.frames, row.frames_wanted))];
  fail_if(rejected, fmt::format("rejected in frame {}: {}{}", row.frames, summary.reason,
                                for_the_body ? ", where the body passes through itself" : ""));
  fail_if(row.cloth_pairs > 0, counted(row.cloth_pairs, "pair") + " of cloth with cloth");
  fail_if(row.body_pairs > 0, counted(row.body_pairs, "pair") + " of cloth with the body");
  fail_if(row.lag > least_body_lag, fmt::format("the body lags by {:.2g} m", row.lag));
  fail_if(row.depth > most_depth, fmt::format("a vertex is {:.2g} m deep in the body", row.depth));
  for (const WornWatch& one : summary.slid_off) all.push_back(slid_off_text(one));
  return all;
}

// A cell: a row's garment or outfit and its clip.
struct WardrobeCell {
  Wear wear;
  ClipEntry clip;
  bool shown = false;  // its run is kept though it passes
  std::string name() const { return wear.name + "." + clip.name; }
};

struct WardrobeWork {
  WardrobeRequest request;
  std::vector<WardrobeCell> cells;
  std::vector<std::filesystem::path> files;  // that all rows depend on
  std::string key;
  std::string clip;   // of `bodies`
  ClipBodies bodies;  // that the rows of a clip share
};

WardrobeWork read_work(const WardrobeRequest& request) {
  WardrobeWork work{request, {}, {}, {}, {}, {}};
  const std::filesystem::path outfits = request.configs / "outfits.yaml", clips = request.configs / "clips.yaml";
  if (!std::filesystem::exists(outfits))
    throw Error("there is no such file", outfits.string(), "run from the repository's root, or give --configs");
  const std::vector<Wear> wears = chosen(everything(read_wardrobe(outfits)), request.wear, "garment or outfit");
  const std::vector<ClipEntry> all_clips = chosen(read_clip_split(clips), request.clips, "clip");
  for (const ClipEntry& clip : all_clips)
    for (const Wear& wear : wears) work.cells.push_back({wear, clip, clip.name == all_clips.front().name});
  work.files = {outfits, clips, request.configs / "wardrobe" / "garment.yaml",
                request.configs / "wardrobe" / "outfit.yaml"};
  for (const std::filesystem::path& file : config_files_near(request.configs / "wardrobe"))
    if (!std::filesystem::equivalent(file, outfits)) work.files.push_back(file);
  std::string settings;
  for (const std::filesystem::path& file : work.files) settings += whole_file(file);
  work.key = fmt::format("{:016x} {}", hash_of(settings), request.most_frames);
  return work;
}

// Soft tissue comes from the rows of this clip before, or from the store on disk where another process left it.
void share_body(const Setup& setup, PosedBodies& known, ClipBody& body) {
  if (!body.known.store) {
    read_tissue(cache_folder(), setup.bodies);
    body.known.performance = known.performance;
    body.known.store = known.store;
  }
  std::swap(known, body.known);
}

// Absent: stopped before its end.
std::optional<CellResult> run_row(WardrobeWork& work, const WardrobeCell& cell, const std::filesystem::path& folder,
                                  const CellWatch& watch) {
  Stopwatch time;
  if (work.clip != cell.clip.name) work.bodies.clear();
  work.clip = cell.clip.name;
  const Setup setup = read_row(work.request, cell.wear, cell.clip);
  ClipBody& body = work.bodies[setup.scene.cloths.size()];
  PosedBodies& known = *setup.bodies.front();
  share_body(setup, known, body);
  find_excused(setup, body);
  const std::vector<char>& excused = body.excused;
  WardrobeRow row;
  row.wear = cell.wear.name;
  row.clip = cell.clip.name;
  row.validation = cell.wear.validation || cell.clip.validation;
  row.excused_frames = static_cast<int>(std::count(excused.begin(), excused.end(), 1));
  RunRequest run;
  run.out = folder / "run";
  run.checkpoint_seconds = 1e9;
  run.observe = WardrobeWatch{excused, row};
  run.stop = watch.stop;
  const std::optional<Start> start = prepare(setup, watch.stop);
  if (!start) return {};
  const RunSummary summary = run_scene(setup, *start, *make_stepper(setup), run);
  keep_tissue(setup, watch.log);
  std::swap(known, body.known);
  if (summary.end == RunEnd::interrupted) return {};
  row.vertices = summary.vertices;
  row.frames = summary.frames;
  row.frames_wanted = summary.frames_wanted;
  row.milliseconds = median_milliseconds(summary);
  row.max_stretch = summary.max_stretch;
  row.failures = failures_of(row, summary, excused);
  row.seconds = time.lap();
  keep_or_remove(run.out, !row.passed() || cell.shown, watch.log);
  return CellResult{wardrobe_row_json(row), row.passed(), summary.positions_hash};
}

std::string log_line(const WardrobeRow& row) {
  std::string line =
      fmt::format("{} {}: {}, {} frames, {:.0f} ms each{}\n", row.wear, row.clip, row.passed() ? "passed" : "FAILED",
                  row.frames, row.milliseconds, row.kept ? " (kept from before)" : "");
  for (const std::string& why : row.failures) line += "  " + why + "\n";
  return line;
}

// Rows come clip by clip; tables have them by what is worn.
CellTables write_tables(const WardrobeWork& work, const std::filesystem::path& out, std::vector<WardrobeRow>& rows) {
  std::ranges::stable_sort(rows, {}, [&](const WardrobeRow& row) {
    return std::ranges::find(work.cells, row.wear, [](const WardrobeCell& cell) { return cell.wear.name; });
  });
  const CellTables tables{wardrobe_table(rows), wardrobe_json(rows), std::ranges::all_of(rows, &WardrobeRow::passed)};
  write_file(out / "wardrobe.json", tables.json);
  write_file(out / "wardrobe.csv", wardrobe_csv(rows));
  write_file(out / "wardrobe.txt", tables.text);
  return tables;
}

void show_run(const std::filesystem::path& out, const WardrobeRow& row, const std::string& cell) {
  show_result(cell_folder(out, cell) / "run", out / row.wear / row.clip);
}

CellTables gather_rows(const WardrobeWork& work, const std::vector<CellRecord>& records,
                       const std::filesystem::path& out) {
  const auto show = [&](const WardrobeRow& row, const std::string& cell) { show_run(out, row, cell); };
  std::vector<WardrobeRow> rows = cell_rows(records, read_wardrobe_row, show);
  return write_tables(work, out, rows);
}

CellList list_of(const std::shared_ptr<WardrobeWork>& work) {
  CellList list;
  list.kind = "wardrobe";
  list.program = program_key();
  for (const WardrobeCell& cell : work->cells) list.names.push_back(cell.name());
  list.describe = [work](std::size_t k) {
    const WardrobeCell& cell = work->cells[k];
    constexpr double frame = 0.11;  // mean of docs/garments/wardrobe.csv [s]
    const int frames = work->request.most_frames > 0 ? work->request.most_frames : cell.clip.frames;
    return WorkCell{cell.name(), work->files, frame * (30 + frames)};
  };
  list.key = [work](std::size_t) { return work->key; };
  list.run = [work](std::size_t k, const std::filesystem::path& folder, const CellWatch& watch) {
    return run_row(*work, work->cells[k], folder, watch);
  };
  list.gather = [work](const std::vector<CellRecord>& records, const std::filesystem::path& out) {
    return gather_rows(*work, records, out);
  };
  return list;
}

}  // namespace

CellList wardrobe_cells(const WardrobeRequest& request) {
  return list_of(std::make_shared<WardrobeWork>(read_work(request)));
}

std::vector<WardrobeRow> wardrobe(const WardrobeRequest& request) {
  const auto work = std::make_shared<WardrobeWork>(read_work(request));
  std::vector<WardrobeRow> rows;
  const auto show = [&](const WardrobeRow& row, const std::string& cell) {
    show_run(request.out, row, cell);
    if (request.log) *request.log << log_line(row) << std::flush;
  };
  const bool finished = do_rows(list_of(work), request.out, {request.log, request.stop}, read_wardrobe_row, show, rows);
  if (finished) write_tables(*work, request.out, rows);
  return rows;
}

}  // namespace selvedge
