#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "pipeline/cells/cell_list.hpp"
#include "pipeline/scene/kinds.hpp"
#include "pipeline/suites/stability_row.hpp"

namespace selvedge {

struct StabilityRequest {
  std::filesystem::path suite = "configs/stability.yaml";
  std::vector<std::string> cases;                // by name; none: all
  std::optional<std::string> stepper;            // in place of the scenes' own
  std::optional<std::filesystem::path> weights;  // of the network of the steppers `learned` and `hybrid`
  Kinds kinds = known_kinds();                   // of steppers
  bool short_form = false;
  std::filesystem::path out = "out/stability";
  std::ostream* log = nullptr;  // a line as each run ends
  std::function<bool()> stop;   // asked after every frame; true ends the suite
};

// Runs a suite of stiff and extreme cases. A run passes if
// * no step is rejected and all numbers are finite;
// * the energy never grows by more than the work of pins, obstacles, wind and the response (physics/solve/work.hpp);
// * it comes to rest;
// * the numbers of iterations are bounded;
// * it stays clean if it started clean, or is clean in the end if an obstacle jumped.
// A bare network must only stay finite or reject a step; other findings are noted. A run that the stepper does not take
// fails with the reason. A run is a cell, and one that has ended is not run again by the same program and settings.
// Leaves stability.txt, stability.csv, stability.json and stability.md in `out`, the cells, and as CASE_K the
// trajectory and page of each failed run.
std::vector<StabilityRow> stability(const StabilityRequest&);

// The cells CASE_K, where K counts the runs of a case from 0. `out`, `log` and `stop` of the request have no part in
// them.
CellList stability_cells(const StabilityRequest&);

// Whether every run passed.
bool passed(const std::vector<StabilityRow>&);

// The rows for people, for docs/results/stability.md, and for programs; the two for programs have all fields.
std::string stability_table(const std::vector<StabilityRow>&);
std::string stability_markdown(const std::vector<StabilityRow>&);
std::string stability_csv(const std::vector<StabilityRow>&);
std::string stability_json(const std::vector<StabilityRow>&);

std::string stability_row_json(const StabilityRow&);
std::optional<StabilityRow> read_stability_row(const std::string& json);

}  // namespace selvedge
