#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace selvedge {

// A cell is a piece of a long work that depends on no other piece: a row of a suite, a scene of a comparison, a path of
// a data set, a shot. Cells may be done in any order, on any machine and by any number of processes; what they leave is
// gathered into the tables of the whole.
struct WorkCell {
  std::string name;                               // one of the list's
  std::vector<std::filesystem::path> needs = {};  // files that it reads, beside the program's own `configs`
  double seconds = 0;                             // rough cost on one core [s]
};

struct CellWatch {
  std::ostream* log = nullptr;  // gets progress messages of the cell; null: none
  std::function<bool()> stop;   // asked after every frame; true ends the cell, which then leaves no result
  bool times_here = false;      // results of other machines (machine_name.hpp) do not count
};

// The result of a cell, beside the files in its folder.
struct CellResult {
  std::string row;              // a JSON object with what the tables are made of
  bool passed = true;           // its row
  std::uint64_t positions = 0;  // hash of the positions of all its frames; 0: it has none of its own
};

// A cell's result as it is kept, in cell.json of its folder.
struct CellRecord {
  std::string cell, kind, program, key, machine;
  CellResult result;
};

// The tables of gathered cells: for people, and as a JSON object.
struct CellTables {
  std::string text, json;
  bool passed = true;  // every row
};

// A work as its cells. Each kind of work makes its list; functions take the number of a name. Making a list reads no
// scenes: what is wrong with a scene is said where the cell is described or done.
struct CellList {
  std::string kind;                // as work files name it: "wardrobe"
  std::filesystem::path file;      // that the list was read from; empty: none
  std::string program;             // hash of this program (program_key)
  std::vector<std::string> names;  // each one once, in the order in which one process does them best
  std::function<WorkCell(std::size_t)> describe;
  // Everything that the result depends on, but the program.
  std::function<std::string(std::size_t)> key;
  // Does a cell and leaves its files in the folder, which is empty. Absent: stopped.
  std::function<std::optional<CellResult>(std::size_t, const std::filesystem::path& folder, const CellWatch&)> run;
  // Writes tables and pages of these results, in the list's order, into the folder of all cells.
  std::function<CellTables(const std::vector<CellRecord>&, const std::filesystem::path& out)> gather;
  // True: a cell keeps parts of its result, each with a key of its own. The folder then has the files of a stopped try
  // on this machine, or of an earlier result.
  bool keeps_parts = false;
  // Whether a folder holds all that `gather` reads of a finished cell; parts may be lost or cut off where folders are
  // copied. Absent: `gather` reads records alone.
  std::function<bool(std::size_t, const std::filesystem::path& folder, const CellRecord&)> is_whole;
};

// A text as the name of a cell: letters, digits, `.`, `_` and `-`, with a letter or a digit in front. What else it has
// becomes `_`.
std::string cell_name(const std::string& text);

// Gives each further one of the same names a number.
void number_equal_names(std::vector<std::string>& names);

// The number of a name. Throws Error, with the nearest names, where the list has none of that name.
std::size_t number_of(const CellList&, const std::string& name);

// Time that frames of so many vertices take, roughly, on one core [s].
double rough_seconds(int vertices, double frames);

std::string cell_record_json(const CellRecord&);
// Absent if the text is not a record.
std::optional<CellRecord> read_cell_record(const std::string& json);

}  // namespace selvedge
