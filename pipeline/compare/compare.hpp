#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace selvedge {

struct CompareScene {
  std::string name;
  std::filesystem::path file;
  std::vector<std::string> overrides;  // key=value
  int states = 4;                      // common states, spread over the run
  int horizon = 6;                     // frames from each of them
};

struct CompareSetting {
  std::string name;
  std::vector<std::string> overrides;
};

// A comparison file, read.
struct Comparison {
  std::filesystem::path file;
  std::vector<CompareScene> scenes;
  std::vector<CompareSetting> settings;
  std::vector<std::string> reference;  // overrides of the temporal reference, beside its time step
  int repeats = 3;
  double jitter = 1e-3;  // of the common states for the floor, in mean edge lengths
};

// Throws Error with file, line and key. short_form: with the file's own `short_form` and that of every scene.
Comparison read_comparison(const std::filesystem::path&, bool short_form);

struct CompareRequest {
  std::filesystem::path file;
  bool short_form = false;
  std::filesystem::path out = "out/compare";
  std::ostream* log = nullptr;  // a line as each part ends
  std::function<bool()> stop;   // asked after every frame; true ends it, unfinished parts are not kept
};

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// How well the temporal reference of a scene is known, and what there is to be known: RMS over vertices and states.
struct CompareFloor {
  std::string scene;
  int vertices = 0, frames = 0, states = 0, horizon = 0;
  double motion = 0;     // of the reference from a common state to the horizon [m]
  double steps = 0;      // difference of dt/8 and dt/16 [m]
  double jittered = 0;   // difference of two references from jittered states [m]
  double lost = 0;       // energy in the whole reference run [J]; below zero where the world drives it
  double floor() const;  // the larger of the two differences: what is below is not ranked
};

// A setting on a scene.
struct CompareRow {
  std::string scene, setting;
  std::string trouble;                                      // why it was left out or what went wrong; empty: nothing
  double dt = unknown;                                      // mean substep of the run [s]
  double ms = unknown;                                      // a frame: median over frames and repeats
  double ms_spread = unknown;                               // of the repeats' medians, largest less smallest
  double algebraic = unknown, algebraic_largest = unknown;  // one step, see AlgebraicError; worst state
  double temporal = unknown;                                // RMS distance to the reference at the horizon [m]
  double floor = unknown;                                   // the scene's [m]
  double decay = unknown;                                   // energy lost in the run over what the reference loses
  double newton = unknown, linear = unknown;                // iterations a frame
  int pairs = -1;                                           // intersecting pairs in the worst frame, by the audit
  long passed_through = 0;
  bool reproduced = true;  // every repeat ended with the same bits
  bool ranked = false;     // the temporal error is above the floor, the run clean to its end
  bool front = false;      // nothing is faster and not worse by more than the floor
};

struct CompareResult {
  std::vector<CompareFloor> floors;
  std::vector<CompareRow> rows;
  std::string plots;     // which were made, or why not
  bool finished = true;  // false: stopped
};

// Runs every setting on every scene `repeats` times, in turn, and holds it against two references from common states:
// its own time step solved to the end (algebraic), and steps of a 16th of a frame (temporal). What is finished is kept
// in the folder and not done again by the same program and settings. Leaves compare.txt, .csv, .json, .h5 and plots.
CompareResult compare(const CompareRequest&);

// Sets ranked and front of the rows of one scene or several.
void rank(std::vector<CompareRow>&);

std::string compare_table(const CompareResult&);
std::string compare_csv(const CompareResult&);
std::string compare_json(const CompareResult&);
void write_compare_hdf5(const std::filesystem::path&, const CompareResult&);
std::string plot_comparison(const CompareResult&, const std::filesystem::path& folder);  // a line that says which

}  // namespace selvedge
