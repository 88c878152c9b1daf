#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace selvedge {

// Runs a command with the options that were given, and prints its result. Returns the exit status: 0 if all is well, 1
// if the result is not clean. Bad input throws Error, which main turns into 2. With `json` one object goes to standard
// output, and text for people to standard error.
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
AddCommand cells_command, cell_command, gather_command;    // cell_commands.cpp
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
    {"Use", "simulate", "simulate a scene file; every frame is audited", simulate_command},
    {"Prepare", "plan", "say what a scene needs, what is left out, and why", plan_command},
    {"Use", "check", "audit a mesh or a trajectory", check_command},
    {"Prepare", "untangle", "move a mesh of cloth until it intersects neither itself nor bodies", untangle_command},
    {"Prepare", "push", "push a garment out of a body, and measure it before and after", push_command},
    {"Prepare", "dress", "make a garment for scenes of a mesh that lies on a body", dress_command},
    {"Prepare", "pattern", "sew a pattern of GarmentCode round a body and drape it", pattern_command},
    {"Prepare", "body", "make a rigged body for scenes of other programs' files", body_command},
    {"Measure", "ccd", "test continuous collision detection on queries with known answers", ccd_command},
    {"Use", "fit", "measure ease, strain and pressure by region of the body", fit_command},
    {"Use", "export", "write a trajectory as meshes, point caches, glTF or USD", export_command},
    {"Use", "view", "make a page that plays trajectories in a browser", view_command},
    {"Measure", "bench", "time frames of benchmark scenes, and parts of a frame", bench_command},
    {"Measure", "stress", "run scenes of hard contact, each from ten random starts", stress_command},
    {"Measure", "compare", "measure error and run time of steppers and settings", compare_command},
    {"Measure", "validate", "compare simulated physics with known answers", validate_command},
    {"Measure", "stability", "run stiff and extreme cases, and say which pass", stability_command},
    {"Measure", "wardrobe", "run every garment of the program in every procedural clip", wardrobe_command},
    {"Long works", "cells", "list the cells of a long work", cells_command},
    {"Long works", "cell", "do cells of a long work", cell_command},
    {"Long works", "gather", "make the tables of the cells that are done", gather_command},
    {"Prepare", "dataset", "make drapes of a garment at rest, to train a network on", dataset_command},
    {"Prepare", "train", "train a network for the stepper `learned`, or one for drapes", train_command},
    {"Prepare", "teach", "fit coefficients of the carried guess to the solver's frames", teach_command},
    {"Prepare", "weights", "import, describe, compress and check weight files", nullptr},
    {"Subcommands", "weights import", "make a weight file of a published checkpoint", weights_import_command},
    {"Subcommands", "weights info", "say what is in a weight file", weights_info_command},
    {"Subcommands", "weights halve", "store a weight file as 16-bit floats", weights_halve_command},
    {"Subcommands", "weights parity", "compare a step with one that the authors' code recorded",
     weights_parity_command},
    {"Use", "info", "print versions, packages and threads, or the keys of scene files", info_command}};

}  // namespace selvedge
