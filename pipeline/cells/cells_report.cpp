#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/counted.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/host/numbers_json.hpp"

namespace selvedge {
namespace {

// "3 are missing: a, b and 1 more"; empty where there are none.
std::string named_cells(const std::vector<std::string>& names, const std::string& what) {
  constexpr std::size_t most_named = 5;
  if (names.empty()) return {};
  std::string text = fmt::format("{} {}{}: ", names.size(), names.size() == 1 ? "cell " : "cells ", what);
  for (std::size_t k = 0; k < std::min(names.size(), most_named); ++k) text += (k > 0 ? ", " : "") + names[k];
  return text + (names.size() > most_named ? fmt::format(" and {} more\n", names.size() - most_named) : "\n");
}

}  // namespace

std::string cells_table(const std::vector<WorkCell>& cells) {
  std::string text = fmt::format("{:<40} {:>8} {:>6}\n", "cell", "s", "files");
  double sum = 0;
  for (const WorkCell& cell : cells) {
    text += fmt::format("{:<40} {:>8.0f} {:>6}\n", cell.name, cell.seconds, cell.needs.size());
    sum += cell.seconds;
  }
  return text + fmt::format("{}, {:.1f} h of one core, roughly\n", counted(std::ssize(cells), "cell"), sum / 3600);
}

std::string cell_names_json(const CellList& list) {
  return json_text(
      {{"file", list.file.string()}, {"kind", list.kind}, {"program", list.program}, {"names", list.names}});
}

std::string cells_json(const CellList& list, const std::vector<WorkCell>& cells) {
  return json_text({{"file", list.file.string()},
                    {"kind", list.kind},
                    {"program", list.program},
                    {"cells", json_list(cells, [](const WorkCell& cell) {
                       const Json needs = json_list(cell.needs, [](const auto& path) { return Json(path.string()); });
                       return Json{{"name", cell.name}, {"needs", needs}, {"cost", cell.seconds}};
                     })}});
}

std::string done_cells_json(const std::vector<DoneCell>& cells) {
  return json_text({{"cells", json_list(cells, [](const DoneCell& cell) {
                       return Json{{"name", cell.record.cell},
                                   {"passed", cell.record.result.passed},
                                   {"kept", cell.kept},
                                   {"row", parse_json(cell.record.result.row)}};
                     })}});
}

std::string gathered_text(const GatheredCells& gathered) {
  const std::size_t all = gathered.records.size() + gathered.missing.size() + gathered.of_other_program.size() +
                          gathered.of_other_settings.size();
  std::string text = gathered.tables.text + fmt::format("gathered {} of {} cells\n", gathered.records.size(), all) +
                     named_cells(gathered.missing, "missing") +
                     named_cells(gathered.of_other_program, "of another program, not gathered") +
                     named_cells(gathered.of_other_settings, "of other settings, not gathered");
  if (gathered.machines.size() > 1) {
    text += fmt::format("made on {} machines, whose times are not to be compared:\n", gathered.machines.size());
    for (const std::string& machine : gathered.machines) text += "    " + machine + "\n";
  }
  return text;
}

std::string gathered_json(const CellList& list, const GatheredCells& gathered) {
  const bool passed = gathered.complete() && gathered.tables.passed;
  return json_text({{"file", list.file.string()},
                    {"kind", list.kind},
                    {"program", list.program},
                    {"passed", passed},
                    {"gathered", gathered.records.size()},
                    {"missing", gathered.missing},
                    {"of_other_program", gathered.of_other_program},
                    {"of_other_settings", gathered.of_other_settings},
                    {"machines", gathered.machines},
                    {"result", parse_json(gathered.tables.json)}});
}

}  // namespace selvedge
