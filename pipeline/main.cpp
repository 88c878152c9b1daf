#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>

#include "collision/geometry/error.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/process_threads.hpp"
#include "pipeline/host/version.hpp"

using namespace selvedge;

namespace {

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
    command.add_flag("--json", *json, "one JSON object on standard output, people's text on standard error");
    command.callback([&chosen, json, run] { chosen = [=] { return run(*json); }; });
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

}  // namespace

// Exit status: 0 well, 1 the result is not clean, 2 bad input or a missing package.
int main(int argc, char** argv) {
  set_up_threads(argv);
  CLI::App app{"selvedge: a garment simulator with audited contact", "selvedge"};
  app.set_version_flag("--version", std::string(program_version()));
  app.require_subcommand(1);
  std::function<int()> chosen;
  add_commands(app, chosen);
  try {
    app.parse(argc, argv);
    return chosen();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help or version, which it prints
    std::cerr << refusal(app, error, argc, argv);
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "selvedge: " << error.what() << "\n";
    return 2;
  }
}
