#include "pipeline/cells/do_cells.hpp"

#include <algorithm>
#include <memory>
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

// Where this machine works on a cell. Other machines have other folders: not every file system that they share knows
// locks. Names of cells never begin with a dot.
fs::path work_folder(const fs::path& out, const std::string& name) {
  return out / "cells" / ("." + name + "." + cell_name(host_name()));
}

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

// Renames a finished folder to its place. Returns false where another machine has put the same result there before.
bool put_in_place(const CellList& list, std::size_t number, const fs::path& out, const fs::path& folder,
                  const CellWatch& watch) {
  const fs::path place = cell_folder(out, list.names[number]);
  constexpr int most_tries = 10;  // each time another machine may be quicker
  for (int k = 0; k < most_tries; ++k) {
    std::error_code trouble;
    fs::rename(folder, place, trouble);
    if (!trouble) return true;
    if (result_of(list, number, out, watch)) return false;
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
  return {CellState::there, std::move(*record)};
}

std::optional<DoneCell> do_cell(const CellList& list, std::size_t number, const fs::path& out, const CellWatch& watch) {
  if (auto record = result_of(list, number, out, watch)) return DoneCell{std::move(*record), true};
  const std::string& name = list.names[number];
  const fs::path work = work_folder(out, name), folder = work / "result";
  make_folder(work);
  auto lock = std::make_unique<FolderLock>(work);
  if (auto record = result_of(list, number, out, watch))  // it was done meanwhile
    return DoneCell{std::move(*record), true};
  begin_work(list, cell_folder(out, name), folder);
  std::optional<CellResult> result = list.run(number, folder, watch);
  if (!result) return {};
  DoneCell done{{name, list.kind, list.program, list.key(number), machine_name(), std::move(*result)}};
  write_file(folder / record_file, cell_record_json(done.record));
  if (!put_in_place(list, number, out, folder, watch)) {
    fs::remove_all(folder);
    done = {find_cell(list, number, out).record, true};
  }
  lock.reset();
  std::error_code in_use;  // another process has begun to work there
  fs::remove(work, in_use);
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
  if (!fs::is_directory(result)) return;
  fs::create_directory_symlink(result.lexically_relative(shown.parent_path()), shown);
}

}  // namespace selvedge
