#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "collision/geometry/error.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/commands/command_output.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/suites/work_file.hpp"

namespace selvedge {
namespace {

struct CellsArguments {
  std::filesystem::path file;
  bool names = false;
};

struct CellArguments {
  std::filesystem::path file;
  std::vector<std::string> names;
  std::filesystem::path out;
  std::string program;
};

constexpr const char* about_file = "work file, comparison, stability suite or data set (docs/cells.md)";

int list_cells(const CellsArguments& arguments, bool json) {
  const CellList list = read_cells(arguments.file);
  if (arguments.names) {
    if (json) std::cout << cell_names_json(list);
    for (const std::string& name : list.names) people(json) << name << "\n";
    return 0;
  }
  std::vector<WorkCell> cells;
  for (std::size_t k = 0; k < list.names.size(); ++k) cells.push_back(list.describe(k));
  std::cout << (json ? cells_json(list, cells) : cells_table(cells));
  return 0;
}

void refuse_other_program(const CellList& list, const std::string& wanted) {
  if (wanted.empty() || wanted == list.program) return;
  throw Error("is asked for of the program " + wanted + ", and this one is " + list.program, list.file.string(),
              "give every worker the same program");
}

int do_named_cells(const CellArguments& arguments, bool json) {
  const CellList list = read_cells(arguments.file);
  refuse_other_program(list, arguments.program);
  std::vector<std::size_t> numbers;
  for (const std::string& name : arguments.names) numbers.push_back(number_of(list, name));
  warn_of_training();
  const InterruptWatch watch;
  bool passed = true;
  std::vector<DoneCell> all;
  for (const std::size_t number : numbers) {
    const auto done = do_cell(list, number, arguments.out, {&std::cerr, InterruptWatch::interrupted});
    if (!done)
      throw Error("was stopped, and leaves no result", list.names[number], "the same command does what is missing");
    passed = passed && done->record.result.passed;
    people(json) << fmt::format("{}: {}{}, {}\n", done->record.cell, done->record.result.passed ? "passed" : "FAILED",
                                done->kept ? " (kept from before)" : "",
                                cell_folder(arguments.out, done->record.cell).string())
                 << std::flush;
    all.push_back(*done);
  }
  return end_command(json, "", done_cells_json(all), passed);
}

int gather(const CellArguments& arguments, bool json) {
  const CellList list = read_cells(arguments.file);
  const GatheredCells gathered = gather_cells(list, arguments.out);
  return end_command(json, gathered_text(gathered), gathered_json(list, gathered),
                     gathered.complete() && gathered.tables.passed);
}

}  // namespace

RunCommand cells_command(CLI::App& command) {
  const auto arguments = std::make_shared<CellsArguments>();
  command.add_option("file", arguments->file, about_file)->required();
  command.add_flag("--names", arguments->names, "print the names alone, one a line, without reading the scenes");
  return [arguments](bool json) { return list_cells(*arguments, json); };
}

RunCommand cell_command(CLI::App& command) {
  const auto arguments = std::make_shared<CellArguments>();
  command.add_option("file", arguments->file, about_file)->required();
  command.add_option("names", arguments->names, "names of cells to do, one after the other")->required();
  command.add_option("--out", arguments->out, "folder for the results of all cells")->required();
  command.add_option("--program", arguments->program,
                     "hash that this program must have; the command fails if it has another");
  return [arguments](bool json) { return do_named_cells(*arguments, json); };
}

RunCommand gather_command(CLI::App& command) {
  const auto arguments = std::make_shared<CellArguments>();
  command.add_option("file", arguments->file, about_file)->required();
  command.add_option("--out", arguments->out, "folder for the results of all cells")->required();
  return [arguments](bool json) { return gather(*arguments, json); };
}

}  // namespace selvedge
