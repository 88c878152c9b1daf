#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "collision/geometry/error.hpp"
#include "collision/geometry/floating_point.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/drapes/make_drapes.hpp"
#include "pipeline/garments/garment_hdf5.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/progress.hpp"

namespace selvedge {
namespace {

struct DatasetWork {
  std::filesystem::path config;
  DrapeOptions options;
  std::optional<DrapeWorld> world = {};  // made when it is needed
  int paths() const { return options.training + options.test; }
};

const DrapeWorld& world_of(DatasetWork& work) {
  if (!work.world) work.world = make_drape_world(work.options);
  return *work.world;
}

std::filesystem::path path_of_cell(const std::filesystem::path& folder) { return folder / "drapes.h5"; }

// Absent: stopped.
std::optional<CellResult> run_path(DatasetWork& work, std::size_t number, const std::filesystem::path& folder,
                                   const CellWatch& watch) {
  const std::optional<DrapePath> path = make_drape_path(world_of(work), number, watch.stop);
  if (!path) return {};
  write_drape_path(path_of_cell(folder), *path);
  std::uint64_t positions = hash_of("");
  for (const Points& x : path->x) positions = hash_of(bytes_of(x), positions);
  const Json row = {
      {"path", number}, {"drapes", path->x.size()}, {"dropped", path->dropped}, {"seconds", path->seconds}};
  return CellResult{json_text(row), true, positions};
}

// The folder of a set of these options, with its files that are of no path.
DatasetSummary open_dataset(DatasetWork& work, const std::filesystem::path& folder) {
  DatasetSummary summary;
  summary.folder = folder;
  const std::filesystem::path config = folder / "config.yaml";
  if (std::filesystem::exists(config) && drape_yaml(read_drape_options(config)) != drape_yaml(work.options))
    throw Error("the folder has drapes of other options", folder.string(), "choose another --out");
  write_file(config, drape_yaml(work.options));
  const DrapeWorld& world = world_of(work);
  write_garment(folder / "garment.h5", world.garment);
  summary.vertices = world.surface.vertex_count;
  summary.body_triangles = static_cast<int>(world.body_surface.triangles.rows());
  return summary;
}

std::string cell_of_path(int number) { return fmt::format("path_{:04d}", number); }

// The path's file in the set is its cell's, under another name where the file system has that; else a copy. It takes
// its place whole.
void put_into_set(const std::filesystem::path& folder, int number) {
  const std::filesystem::path file = path_of_cell(cell_folder(folder, cell_of_path(number)));
  const std::filesystem::path place = drape_path_file(folder, number), beside = path_beside(place);
  std::error_code trouble;
  if (std::filesystem::equivalent(file, place, trouble)) return;
  std::filesystem::create_hard_link(file, beside, trouble);
  if (trouble)
    write_file(place, read_file(file, "drape"));
  else
    rename_file(beside, place);
}

// Counts a path that is in the set. Returns its line of drapes.csv.
std::string add_path(DatasetWork& work, int number, DatasetSummary& summary, std::ostream* log) {
  const DrapeWorld& world = world_of(work);
  const DrapePath path = read_drape_path(drape_path_file(summary.folder, number),
                                         static_cast<int>(world.body.joints.size()), world.surface.vertex_count);
  int dropped = 0;
  for (const auto& [reason, count] : path.dropped) {
    summary.dropped[reason] += count;
    dropped += count;
  }
  const bool training = number < work.options.training;
  (training ? summary.training : summary.test) += static_cast<int>(path.x.size());
  summary.poses_redrawn += path.poses_redrawn;
  summary.seconds += path.seconds;
  if (log)
    *log << fmt::format("path {} of {}: {} drapes, {} dropped, {}\n", number + 1, work.paths(), path.x.size(), dropped,
                        duration_text(path.seconds))
         << std::flush;
  return fmt::format("{},{},{},{},{},{:.2f}\n", number, training ? "training" : "test", path.x.size(), dropped,
                     path.poses_redrawn, path.seconds);
}

constexpr const char* dataset_columns = "path,split,drapes,dropped,poses_redrawn,seconds\n";

CellTables gather_paths(DatasetWork& work, const std::vector<CellRecord>& records, const std::filesystem::path& out) {
  DatasetSummary summary = open_dataset(work, out);
  std::string table = dataset_columns;
  int there = 0;
  for (int k = 0; k < work.paths(); ++k) {
    if (std::ranges::find(records, cell_of_path(k), &CellRecord::cell) != records.end()) put_into_set(out, k);
    if (!std::filesystem::exists(drape_path_file(out, k))) continue;
    table += add_path(work, k, summary, nullptr);
    ++there;
  }
  summary.finished = there == work.paths();
  write_file(out / "drapes.csv", table);
  return {dataset_text(summary), dataset_json(summary), true};
}

CellList list_of(const std::shared_ptr<DatasetWork>& work) {
  CellList list;
  list.kind = "dataset";
  list.program = program_key();
  for (int k = 0; k < work->paths(); ++k) list.names.push_back(cell_of_path(k));
  list.describe = [work, names = list.names](std::size_t k) {
    const DrapeOptions& options = work->options;
    constexpr int vertices = 1000;  // of most garments at most edge lengths
    const double frames = 1.0 * options.poses * (options.move_frames + options.settle_frames);
    return WorkCell{names[k], {work->config}, rough_seconds(vertices, frames)};
  };
  list.key = [work](std::size_t) { return fmt::format("{:016x}", hash_of(drape_yaml(work->options))); };
  list.run = [work](std::size_t k, const std::filesystem::path& folder, const CellWatch& watch) {
    return run_path(*work, k, folder, watch);
  };
  list.gather = [work](const std::vector<CellRecord>& records, const std::filesystem::path& out) {
    return gather_paths(*work, records, out);
  };
  return list;
}

std::shared_ptr<DatasetWork> read_dataset(const DatasetRequest& request) {
  restore_standard_arithmetic();
  return std::make_shared<DatasetWork>(
      DatasetWork{request.config, read_drape_options(request.config, request.overrides)});
}

}  // namespace

CellList dataset_cells(const DatasetRequest& request) { return list_of(read_dataset(request)); }

DatasetSummary make_dataset(const DatasetRequest& request) {
  const std::shared_ptr<DatasetWork> work = read_dataset(request);
  const std::filesystem::path folder =
      request.out.empty() ? std::filesystem::path("out") / "data" / work->options.name : request.out;
  make_folder(folder);
  const FolderLock lock(folder);
  DatasetSummary summary = open_dataset(*work, folder);
  const CellList list = list_of(work);
  std::string table = dataset_columns;
  for (int k = 0; k < work->paths(); ++k) {
    const auto number = static_cast<std::size_t>(k);
    if (!std::filesystem::exists(drape_path_file(folder, k))) {
      if (!do_cell(list, number, folder, {request.log, request.stop})) return summary;
      put_into_set(folder, k);
    }
    table += add_path(*work, k, summary, request.log);
  }
  write_file(folder / "drapes.csv", table);
  summary.finished = true;
  return summary;
}

std::string dataset_text(const DatasetSummary& s) {
  std::string text = fmt::format(
      "{:<20}{}\n{:<20}{} vertices; body of {} triangles\n{:<20}{} to train on, {} to measure on\n{:<20}{}\n",
      s.finished ? "made" : "stopped", s.folder.string(), "garment", s.vertices, s.body_triangles, "drapes", s.training,
      s.test, "time", duration_text(s.seconds));
  for (const auto& [reason, count] : s.dropped) text += fmt::format("{:<20}{}: {}\n", "dropped", reason, count);
  return text + fmt::format("{:<20}{}\n", "poses drawn anew", s.poses_redrawn);
}

std::string dataset_json(const DatasetSummary& s) {
  const Json json = {{"folder", s.folder.string()},      {"finished", s.finished}, {"vertices", s.vertices},
                     {"training", s.training},           {"test", s.test},         {"dropped", s.dropped},
                     {"poses_redrawn", s.poses_redrawn}, {"seconds", s.seconds}};
  return json_text(json);
}

}  // namespace selvedge
