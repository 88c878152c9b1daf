#pragma once

#include <functional>
#include <utility>

#include "pipeline/cells/cell_list.hpp"

namespace selvedge {

// Results of cells lie in OUT/cells/NAME, each whole or not there: a cell works in a folder of another name, which is
// renamed when it has ended. A result counts where its program and its key are those of the list.

std::filesystem::path cell_folder(const std::filesystem::path& out, const std::string& name);

enum class CellState { missing, there, of_other_program, of_other_settings };
struct FoundCell {
  CellState state = CellState::missing;
  CellRecord record;  // of a cell that is there
};
FoundCell find_cell(const CellList&, std::size_t number, const std::filesystem::path& out);

struct DoneCell {
  CellRecord record;
  bool kept = false;  // it was there
};

// Does one cell, unless its result is there. A result of another program or of other settings is replaced. Absent:
// stopped. Throws Error, also where another process of this machine is doing the cell. Two machines may do it at the
// same time: the first result stays.
std::optional<DoneCell> do_cell(const CellList&, std::size_t number, const std::filesystem::path& out,
                                const CellWatch&);

// Does all cells that are not there, in the list's order, and shows every one. False: stopped.
bool do_cells(const CellList&, const std::filesystem::path& out, const CellWatch&,
              const std::function<void(const DoneCell&)>& show);

struct GatheredCells {
  std::vector<CellRecord> records;  // in the list's order
  std::vector<std::string> missing, of_other_program, of_other_settings, machines;
  CellTables tables;
  bool complete() const { return missing.empty() && of_other_program.empty() && of_other_settings.empty(); }
};

// Makes the tables of the results that are there.
GatheredCells gather_cells(const CellList&, const std::filesystem::path& out);

// The rows of results as `read` makes them of their JSON; what it cannot read is left out. show(row, cell) is called
// for each.
template <class Read, class Show>
auto cell_rows(const std::vector<CellRecord>& records, const Read& read, const Show& show) {
  std::vector<typename decltype(read(std::string()))::value_type> rows;
  for (const CellRecord& record : records)
    if (auto row = read(record.result.row)) {
      show(*row, record.cell);
      rows.push_back(std::move(*row));
    }
  return rows;
}

// Does all cells, and adds to `rows` what `read` makes of each result, as cell_rows; `kept` of a row is set. show(row,
// cell) is called after each. False: stopped.
template <class Row, class Read, class Show>
bool do_rows(const CellList& list, const std::filesystem::path& out, const CellWatch& watch, const Read& read,
             const Show& show, std::vector<Row>& rows) {
  return do_cells(list, out, watch, [&](const DoneCell& done) {
    std::optional<Row> row = read(done.record.result.row);
    if (!row) return;
    row->kept = done.kept;
    rows.push_back(std::move(*row));
    show(rows.back(), done.record.cell);
  });
}

// Lets a folder of a cell's result be found under another name too, by a relative link, where the file system has
// links. What has that name, a run of an earlier program, is removed.
void show_result(const std::filesystem::path& result, const std::filesystem::path& shown);

std::string cells_table(const std::vector<WorkCell>&);  // for people
std::string cell_names_json(const CellList&);
std::string cells_json(const CellList&, const std::vector<WorkCell>&);
std::string done_cells_json(const std::vector<DoneCell>&);
std::string gathered_text(const GatheredCells&);
std::string gathered_json(const CellList&, const GatheredCells&);

}  // namespace selvedge
