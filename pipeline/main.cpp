#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <optional>

#include "collision/geometry/error.hpp"
#include "collision/geometry/path_beside.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/hdf5/hdf5_at_exit.hpp"
#include "pipeline/host/freed_memory.hpp"
#include "pipeline/host/interrupt.hpp"
#include "pipeline/host/library_message.hpp"
#include "pipeline/host/process_threads.hpp"
#include "pipeline/host/version.hpp"

using namespace selvedge;

namespace {

// A script whose variable is not set gives an empty text, which stands for nothing.
void refuse_empty(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (const std::vector<std::string>& given = option->results(); std::ranges::find(given, "") != given.end())
      throw Error("is given an empty text", option->get_name(),
                  option->get_positional() ? "name what it stands for" : "give a value, or leave the option out");
}

// Adds all commands; `chosen` becomes the one that is parsed.
void add_commands(CLI::App& app, std::function<int()>& chosen) {
  for (const Command& row : commands) {
    const std::string name = row.name;
    const std::size_t space = name.find(' ');
    const bool is_inner = space != std::string::npos;
    CLI::App& above = is_inner ? *app.get_subcommand(name.substr(0, space)) : app;
    CLI::App& command = *above.add_subcommand(is_inner ? name.substr(space + 1) : name, row.about);
    command.group(row.heading);
    if (!row.add) {
      command.require_subcommand(1);
      continue;
    }
    const RunCommand run = row.add(command);
    const auto json = std::make_shared<bool>(false);
    command.add_flag("--json", *json,
                     "print one JSON object to standard output, and text for people to standard error");
    command.callback([&chosen, &command, json, run] {
      refuse_empty(command);
      chosen = [=] { return run(*json); };
    });
  }
}

// What is wrong with the command line, in the form of every other error.
std::string refusal(const CLI::App& app, const CLI::ParseError& problem, int argc, char** argv) {
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  const bool is_command = std::ranges::find(known, word) != known.end();
  const Error error = is_command ? Error(problem.what(), word, "`selvedge " + word + " --help` lists what it takes")
                      : word.empty() || word[0] == '-'
                          ? Error(problem.what(), "the command line", "`selvedge --help` lists the commands")
                          : Error("there is no command `" + word + "`" + suggestion(word, known), "the command line",
                                  "`selvedge --help` lists the commands");
  return "selvedge: " + std::string(error.what()) + "\n";
}

// What ended a command, in the form of every other error. `word`: the command.
Error error_of(const std::exception& problem, const std::string& word) {
  if (const auto* error = dynamic_cast<const Error*>(&problem)) return *error;
  if (dynamic_cast<const std::bad_alloc*>(&problem))
    return {"needs more memory than there is", word,
            "give it fewer vertices or smaller files at a time, or more memory"};
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&problem))
    return {"cannot be used (" + file->code().message() + ")", file->path1().string(), write_cure};
  return {library_message(problem.what()), word, "see whether its files are what docs/commands.md asks for"};
}

// The status, unless what the command has printed could not be written.
int status_of_output(int status) {
  if (std::cout.flush()) return status;
  std::cerr << "selvedge: " << Error("cannot be written in full", "standard output", write_cure).what() << "\n";
  return 2;
}

}  // namespace

// Exit status: 0 well, 1 the result is not clean, 2 bad input or a missing package.
int main(int argc, char** argv) {
  const std::optional<std::string> limited = limit_threads();
  if (limited) std::cerr << "warning: " << *limited << "\n";
  set_up_threads(argv, limited.has_value());
  keep_freed_memory();
  ignore_file_limit_signal();
  h5::do_nothing_at_exit();
  CLI::App app{"selvedge: a garment simulator with audited contact", "selvedge"};
  app.set_version_flag("--version", std::string(program_version()));
  app.require_subcommand(1);
  std::function<int()> chosen;
  add_commands(app, chosen);
  try {
    app.parse(argc, argv);
    return status_of_output(chosen());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return status_of_output(app.exit(error));  // help or version
    std::cerr << refusal(app, error, argc, argv);
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "selvedge: " << error_of(error, argc > 1 ? argv[1] : "the command line").what() << "\n";
    return 2;
  }
}
