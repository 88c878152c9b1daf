#pragma once

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace selvedge {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// How well the temporal reference of a scene is known, and what there is to be known: RMS over vertices and states.
struct CompareFloor {
  std::string scene;
  int vertices = 0, frames = 0, states = 0, horizon = 0;
  double motion = 0;    // of the reference from a common state to the horizon [m]
  double steps = 0;     // difference of dt/8 and dt/16 [m]
  double jittered = 0;  // difference of two references from jittered states [m]
  double lost = 0;      // energy in the whole reference run [J]; below zero where the world drives it
  // The larger of the two differences: what is below is not ranked.
  double floor() const { return std::max(steps, jittered); }
};

// A setting on a scene.
struct CompareRow {
  std::string scene, setting;
  std::string machine;                                      // that has timed it (machine_name.hpp)
  std::string outfit;                                       // of a sequence
  bool tangled = false;                                     // it starts so
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
  bool reproduced = true;                       // every repeat ended with the same bits
  bool ranked = false;                          // the temporal error is above the floor, the run clean to its end
  std::map<std::string, double> measures = {};  // by name: compare_columns.hpp
  std::vector<int> pairs_by_frame = {};         // of cloth, the start's first
  bool front = false;                           // nothing is faster and not worse by more than the floor

  double measure(const std::string& name) const {  // unknown where the row has none of this name
    const auto found = measures.find(name);
    return found == measures.end() ? unknown : found->second;
  }
};

inline bool is_clean(const CompareRow& row) { return row.pairs <= 0 && row.passed_through == 0; }

struct CompareResult {
  std::vector<CompareFloor> floors;
  std::vector<CompareRow> rows;
  std::string evaluation;                    // of its tables, for people; empty: there is none
  std::string repulsion, repulsion_figures;  // tables for people and figures as SVG, of trainings of drapes
  std::filesystem::path views;               // folder of the pages that play a scene's rows; empty: runs were not kept
  std::string plots;                         // which were made, or why not
  bool finished = true;                      // false: stopped
};

}  // namespace selvedge
