#include "pipeline/suites/wardrobe.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/search/intersections.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/motions/clip_split.hpp"
#include "pipeline/obstacles/setup_body.hpp"
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

struct RowPlace {
  std::filesystem::path folder, file;
  std::string key;  // of the program and its settings
};

// Absent: stopped before its end.
std::optional<WardrobeRow> run_row(const WardrobeRequest& request, const Wear& wear, const ClipEntry& clip,
                                   const RowPlace& place, ClipBodies& bodies) {
  Stopwatch watch;
  const Setup setup = read_row(request, wear, clip);
  ClipBody& body = bodies[setup.scene.cloths.size()];
  PosedBodies& known = *setup.bodies.front();
  std::swap(known, body.known);
  find_excused(setup, body);
  const std::vector<char>& excused = body.excused;
  WardrobeRow row;
  row.wear = wear.name;
  row.clip = clip.name;
  row.validation = wear.validation || clip.validation;
  row.excused_frames = static_cast<int>(std::count(excused.begin(), excused.end(), 1));
  RunRequest run;
  run.out = place.folder;
  run.checkpoint_seconds = 1e9;
  run.observe = WardrobeWatch{excused, row};
  run.stop = request.stop;
  const std::optional<Start> start = prepare(setup, request.stop);
  if (!start) return {};
  const RunSummary summary = run_scene(setup, *start, *make_stepper(setup), run);
  std::swap(known, body.known);
  if (summary.end == RunEnd::interrupted) return {};
  row.vertices = summary.vertices;
  row.frames = summary.frames;
  row.frames_wanted = summary.frames_wanted;
  row.milliseconds = median_milliseconds(summary);
  row.max_stretch = summary.max_stretch;
  row.failures = failures_of(row, summary, excused);
  row.seconds = watch.lap();
  return row;
}

std::string log_line(const WardrobeRow& row) {
  std::string line =
      fmt::format("{} {}: {}, {} frames, {:.0f} ms each{}\n", row.wear, row.clip, row.passed() ? "passed" : "FAILED",
                  row.frames, row.milliseconds, row.kept ? " (kept from before)" : "");
  for (const std::string& why : row.failures) line += "  " + why + "\n";
  return line;
}

}  // namespace

std::vector<WardrobeRow> wardrobe(const WardrobeRequest& request) {
  const std::filesystem::path outfits = request.configs / "outfits.yaml", clips = request.configs / "clips.yaml";
  const std::vector<Wear> wears = chosen(everything(read_wardrobe(outfits)), request.wear, "garment or outfit");
  const std::vector<ClipEntry> all_clips = chosen(read_clip_split(clips), request.clips, "clip");
  make_folder(request.out);
  const std::string settings = whole_file(outfits) + whole_file(clips) +
                               whole_file(request.configs / "wardrobe" / "garment.yaml") +
                               whole_file(request.configs / "wardrobe" / "outfit.yaml");
  const std::string key = fmt::format("{} {:016x} {}", program_key(), hash_of(settings), request.most_frames);
  std::vector<WardrobeRow> rows;
  for (std::size_t c = 0; c < all_clips.size(); ++c) {
    if (static_cast<int>(c) % request.share[1] != request.share[0] - 1) continue;
    const ClipEntry& clip = all_clips[c];
    ClipBodies bodies;
    for (const Wear& wear : wears) {
      const RowPlace place{request.out / wear.name / clip.name, request.out / wear.name / (clip.name + ".json"), key};
      make_folder(place.folder.parent_path());
      std::optional<WardrobeRow> row = read_wardrobe_row(whole_file(place.file), key);
      if (!row) {
        row = run_row(request, wear, clip, place, bodies);
        if (!row) return rows;
        keep_or_remove(place.folder, !row->passed() || clip.name == all_clips.front().name, request.log);
        write_file(place.file, wardrobe_row_json(*row, key));
      }
      rows.push_back(*row);
      if (request.log) *request.log << log_line(*row) << std::flush;
    }
  }
  const auto order = [&](const WardrobeRow& row) { return std::ranges::find(wears, row.wear, &Wear::name); };
  std::ranges::stable_sort(rows, {}, order);
  write_file(request.out / "wardrobe.json", wardrobe_json(rows));
  write_file(request.out / "wardrobe.csv", wardrobe_csv(rows));
  write_file(request.out / "wardrobe.txt", wardrobe_table(rows));
  return rows;
}

}  // namespace selvedge
