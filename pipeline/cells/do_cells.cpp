#include "pipeline/cells/do_cells.hpp"

#include <algorithm>
#include <optional>
#include <system_error>

#include "collision/geometry/error.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/machine_name.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

namespace fs = std::filesystem;

constexpr const char* record_file = "cell.json";

// Where this machine works on a cell, which is locked meanwhile. Other machines have other folders: not every file
// system that they share knows locks. Names of cells never begin with a dot.
class WorkFolder {
 public:
  WorkFolder(const fs::path& out, const std::string& name, bool keeps_parts)
      : path_(out / "cells" / ("." + name + "." + cell_name(host_name()))), keeps_parts_(keeps_parts) {
    make_folder(path_);
    lock_.emplace(path_);
  }
  // Parts of a cell stay for the next try. Nothing else of a cell that is stopped or fails is of any use.
  ~WorkFolder() {
    std::error_code ignored;  // what cannot be removed counts for nothing
    if (!keeps_parts_) fs::remove_all(result(), ignored);
    lock_.reset();
    fs::remove(path_, ignored);  // it stays where it has parts, or where another process has begun to work
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  fs::path result() const { return path_ / "result"; }

 private:
  fs::path path_;
  bool keeps_parts_;
  std::optional<FolderLock> lock_;
};

// An empty folder to work in; for a list whose cells keep parts, with what there is of them.
void begin_work(const CellList& list, const fs::path& result, const fs::path& folder) {
  if (!list.keeps_parts) fs::remove_all(folder);
  std::error_code none;  // there is no earlier result, or it cannot be moved: then the work begins anew
  if (list.keeps_parts && !fs::exists(folder)) fs::rename(result, folder, none);
  make_folder(folder);
  remove_file(folder / record_file);
}

// The result, if it counts.
std::optional<CellRecord> result_of(const CellList& list, std::size_t number, const fs::path& out,
                                    const CellWatch& watch) {
  FoundCell found = find_cell(list, number, out);
  if (found.state != CellState::there) return {};
  if (watch.times_here && found.record.machine != machine_name()) return {};
  return std::move(found.record);
}

// Renames a finished folder to its place. Returns the result that another machine has put there before, if it counts;
// the folder then stays where it is.
std::optional<CellRecord> put_in_place(const CellList& list, std::size_t number, const fs::path& out,
                                       const fs::path& folder, const CellWatch& watch) {
  const fs::path place = cell_folder(out, list.names[number]);
  constexpr int most_tries = 10;  // each time another machine may be quicker
  for (int k = 0; k < most_tries; ++k) {
    std::error_code trouble;
    fs::rename(folder, place, trouble);
    if (!trouble) return {};
    if (auto record = result_of(list, number, out, watch)) return record;
    const fs::path old = folder.parent_path() / "old";
    fs::remove_all(old);
    fs::rename(place, old, trouble);
    fs::remove_all(old);
  }
  throw Error("cannot be put in its place", place.string(), write_cure);
}

}  // namespace

fs::path cell_folder(const fs::path& out, const std::string& name) { return out / "cells" / name; }

FoundCell find_cell(const CellList& list, std::size_t number, const fs::path& out) {
  const std::string& name = list.names[number];
  auto record = read_cell_record(whole_file(cell_folder(out, name) / record_file));
  if (!record || record->cell != name || record->kind != list.kind) return {};
  if (record->program != list.program) return {CellState::of_other_program, {}};
  if (record->key != list.key(number)) return {CellState::of_other_settings, {}};
  if (list.is_whole && !list.is_whole(number, cell_folder(out, name), *record)) return {};
  return {CellState::there, std::move(*record)};
}

std::optional<DoneCell> do_cell(const CellList& list, std::size_t number, const fs::path& out, const CellWatch& watch) {
  if (auto record = result_of(list, number, out, watch)) return DoneCell{std::move(*record), true};
  const std::string& name = list.names[number];
  const WorkFolder work(out, name, list.keeps_parts);
  if (auto record = result_of(list, number, out, watch))  // it was done meanwhile
    return DoneCell{std::move(*record), true};
  begin_work(list, cell_folder(out, name), work.result());
  // The key is of the files as they are now: who changes one in the course of the work gets a result of other settings.
  DoneCell done{{name, list.kind, list.program, list.key(number), machine_name(), {}}};
  std::optional<CellResult> result = list.run(number, work.result(), watch);
  if (!result) return {};
  done.record.result = std::move(*result);
  write_file(work.result() / record_file, cell_record_json(done.record));
  if (auto record = put_in_place(list, number, out, work.result(), watch)) {
    fs::remove_all(work.result());
    return DoneCell{std::move(*record), true};
  }
  return done;
}

bool do_cells(const CellList& list, const fs::path& out, const CellWatch& watch,
              const std::function<void(const DoneCell&)>& show) {
  make_folder(out);
  for (std::size_t k = 0; k < list.names.size(); ++k) {
    const std::optional<DoneCell> done = do_cell(list, k, out, watch);
    if (!done) return false;
    show(*done);
  }
  return true;
}

GatheredCells gather_cells(const CellList& list, const fs::path& out) {
  GatheredCells all;
  for (std::size_t k = 0; k < list.names.size(); ++k) {
    FoundCell found = find_cell(list, k, out);
    switch (found.state) {
      case CellState::missing:
        all.missing.push_back(list.names[k]);
        break;
      case CellState::of_other_program:
        all.of_other_program.push_back(list.names[k]);
        break;
      case CellState::of_other_settings:
        all.of_other_settings.push_back(list.names[k]);
        break;
      case CellState::there:
        if (std::ranges::find(all.machines, found.record.machine) == all.machines.end())
          all.machines.push_back(found.record.machine);
        all.records.push_back(std::move(found.record));
    }
  }
  make_folder(out);
  all.tables = list.gather(all.records, out);
  return all;
}

void show_result(const fs::path& result, const fs::path& shown) {
  make_folder(shown.parent_path());
  fs::remove_all(shown);
  std::error_code unlinked;  // the result itself is there
  if (fs::is_directory(result, unlinked))
    fs::create_directory_symlink(result.lexically_relative(shown.parent_path()), shown, unlinked);
}

}  // namespace selvedge
