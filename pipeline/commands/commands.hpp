#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace selvedge {

// Runs a command as its options were given. It prints; what it returns is the exit status: 0 well, 1 the result is not
// clean. Bad input throws Error, which main turns into 2. With `json` one object goes to standard output and people's
// text to standard error.
using RunCommand = std::function<int(bool json)>;

// Adds the options of a command.
using AddCommand = RunCommand(CLI::App&);

// The option `--set`, whose values stand in place of those of a file, such as "the scene's".
void add_overrides(CLI::App&, std::vector<std::string>& overrides, const std::string& whose);

AddCommand simulate_command, plan_command, info_command;  // commands.cpp
// tool_commands.cpp
AddCommand check_command, untangle_command, push_command, dress_command, pattern_command, body_command, ccd_command,
    fit_command, export_command, view_command;
// suite_commands.cpp
AddCommand bench_command, stress_command, compare_command, validate_command, stability_command, wardrobe_command;
AddCommand cells_command, cell_command, gather_command;  // cell_commands.cpp
AddCommand dataset_command, train_command, teach_command;  // training_commands.cpp
AddCommand weights_import_command, weights_info_command, weights_halve_command, weights_parity_command;

struct Command {
  const char* heading;  // in `selvedge --help`
  const char* name;     // two words: a command of the first one
  const char* about;
  AddCommand* add;  // null: it has commands of its own
};

// All commands, as `selvedge --help` lists them. docs/commands.md has a chapter for each. How to add one:
// docs/extending.md.
inline constexpr Command commands[]{
    {"Use", "simulate", "a scene in, an audited trajectory out", simulate_command},
    {"Prepare", "plan", "what a scene needs, what is left out, and why", plan_command},
    {"Use", "check", "audit a mesh or a trajectory", check_command},
    {"Prepare", "untangle", "part a cloth from itself and from bodies", untangle_command},
    {"Prepare", "push", "push a garment out of a body and measure both", push_command},
    {"Prepare", "dress", "a garment for scenes from a mesh that a body wears", dress_command},
    {"Prepare", "pattern", "a sewing pattern, sewn and draped on a body", pattern_command},
    {"Prepare", "body", "a rigged body from other programs' files, for scenes", body_command},
    {"Measure", "ccd", "continuous detection against queries with known answers", ccd_command},
    {"Use", "fit", "ease, strain and pressure by region of the body", fit_command},
    {"Use", "export", "a trajectory as meshes, point caches, glTF or USD", export_command},
    {"Use", "view", "one page that plays trajectories in a browser", view_command},
    {"Measure", "bench", "the benchmark family", bench_command},
    {"Measure", "stress", "scenes that must end clean and come out as they say", stress_command},
    {"Measure", "compare", "settings against references: error against run time", compare_command},
    {"Measure", "validate", "physics with known answers", validate_command},
    {"Measure", "stability", "stiff and extreme cases, pass or fail each", stability_command},
    {"Measure", "wardrobe", "every garment by code through every procedural clip", wardrobe_command},
    {"Use", "cells", "a long work as the cells that any machine may do", cells_command},
    {"Use", "cell", "one cell of a work", cell_command},
    {"Use", "gather", "the tables of a work's cells that are there", gather_command},
    {"Prepare", "dataset", "drapes at rest to train a network on", dataset_command},
    {"Prepare", "train", "a network of the stepper `learned`, or one of drapes", train_command},
    {"Prepare", "teach", "coefficients for one outfit, fitted to the solver's frames", teach_command},
    {"Prepare", "weights", "weight files of learned steppers", nullptr},
    {"Subcommands", "weights import", "a weight file from a published checkpoint", weights_import_command},
    {"Subcommands", "weights info", "what is in a weight file", weights_info_command},
    {"Subcommands", "weights halve", "a weight file stored as 16-bit floats", weights_halve_command},
    {"Subcommands", "weights parity", "our step beside one that the authors' code took", weights_parity_command},
    {"Use", "info", "versions, packages, threads; keys of scene files", info_command}};

}  // namespace selvedge
