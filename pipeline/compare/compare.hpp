#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "pipeline/cells/cell_list.hpp"
#include "pipeline/compare/compare_result.hpp"
#include "pipeline/compare/comparison.hpp"

namespace selvedge {

struct CompareRequest {
  std::filesystem::path file;
  bool short_form = false;
  std::vector<std::string> overrides = {};  // key=value, of the comparison file
  Kinds kinds = known_kinds();              // of steppers
  std::filesystem::path out = "out/compare";
  std::ostream* log = nullptr;  // a line as each part ends
  std::function<bool()> stop;   // asked after every frame; true ends it, unfinished parts are not kept
};

// Runs every setting on every scene `repeats` times, in turn, and holds it against two references from common states:
// its own time step solved to the end (algebraic), and steps of a 16th of a frame (temporal). A scene is a cell; what
// is finished is kept in the folder and not done again by the same program and settings. Leaves compare.txt, .csv,
// .json, .h5, .html and plots, and of an evaluation (evaluation.hpp) evaluation.txt and .json.
CompareResult compare(const CompareRequest&);

// The scenes as cells: the floor, errors and timed runs of a scene belong together, on one machine, in turn. Gathering
// measures the trainings of drapes. `out`, `log` and `stop` of the request have no part in them.
CellList compare_cells(const CompareRequest&);

// Sets ranked and front of the rows of one scene or several. A hybrid row is neither where less than 30 % of its frames
// were made of proposals.
void rank(std::vector<CompareRow>&);

// The result as tables for people, as CSV (a row a scene and setting) and as JSON with everything.
std::string compare_table(const CompareResult&);
// One page that needs no other file: for each scene error against run time with the front and the floor, the table
// behind it, what was left out, and an evaluation's tables.
std::string compare_page(const Comparison&, const CompareResult&);
std::string compare_csv(const CompareResult&);
std::string compare_json(const CompareResult&);
void write_compare_hdf5(const std::filesystem::path&, const CompareResult&);

}  // namespace selvedge
