#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "pipeline/cells/cell_list.hpp"

namespace selvedge {

struct StressRequest {
  std::filesystem::path configs = "configs/stress";  // holds SCENE.yaml of every scene
  std::vector<std::string> scenes;                   // empty: all that are there
  int repeats = 10;
  std::uint64_t seed = 1;
  double jitter = 0.01;  // of the starts, in mean edge lengths
  bool short_form = false;
  std::filesystem::path out = "out/stress";
  std::ostream* log = nullptr;  // a line as each repeat ends
  std::function<bool()> stop;   // asked after every frame; true ends the suite, unfinished repeats are not kept
};

// The result of one repeat of a scene.
struct StressRow {
  std::string scene;
  int repeat = 0;
  std::uint64_t seed = 0;
  double jitter = 0;  // used, in mean edge lengths
  int vertices = 0, frames = 0, frames_wanted = 0;
  double seconds = 0;
  long pairs = 0, vertex_pairs = 0, nonfinite = 0;  // by the audit, over all frames
  int worst_frame = 0, worst_inside = 0;
  int wanted_frames = 0;    // frames that are not clean against the obstacles' wanted positions
  long passed_through = 0;  // by the audit of motion, over all frames
  long impulses = 0, zones = 0, shortened = 0;
  double held_share = 0;    // vertex-steps whose motion was shortened with a zone, of all
  double obstacle_lag = 0;  // largest [m]
  double max_stretch = 1;
  std::vector<std::string> outcome;   // a line each of what the scene states
  std::vector<std::string> failures;  // why it failed, a line each; empty: passed
  bool kept = false;                  // from an earlier call
  bool passed() const { return failures.empty(); }
};

// Runs each scene `repeats` times from jittered starts. Every repeat must run to its end, finite, clean in every frame
// by the audit, with nothing passed through and under 1 % of its vertex-steps held back by zone shortening, and come to
// the outcome that the scene states; obstacles may lag only where the scene's outcome says that they must. A repeat is
// a cell, and one that finished is not run again by the same program and settings. Leaves in `out` stress.json,
// stress.csv and stress.txt, the cells, and as SCENE/repeat_K the trajectory and page of each scene's first repeat and
// of every one that failed.
std::vector<StressRow> stress(const StressRequest&);

// The cells SCENE.repeat_K. `out`, `log` and `stop` of the request have no part in them. Throws Error where there is no
// such scene.
CellList stress_cells(const StressRequest&);

std::string stress_row_json(const StressRow&);
std::optional<StressRow> read_stress_row(const std::string& json);
std::string stress_json(const std::vector<StressRow>&);
std::string stress_csv(const std::vector<StressRow>&);
std::string stress_table(const std::vector<StressRow>&);  // a row a repeat, then a row a scene, for people

}  // namespace selvedge
