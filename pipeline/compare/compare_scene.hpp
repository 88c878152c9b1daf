#pragma once

#include "pipeline/cells/cell_list.hpp"
#include "pipeline/compare/compare_parts.hpp"
#include "pipeline/run/prepare.hpp"

namespace selvedge {

// A scene of a comparison with everything that is measured on it: a cell of the comparison.

// All that a part's result depends on, but the machine for times.
struct SceneKeys {
  std::string program, reference;
  std::vector<std::string> settings;
};

struct SceneWork {
  const CompareScene* scene = nullptr;
  bool keeps = false;  // the trajectories of its rows
  std::filesystem::path folder;
  SceneKeys keys;
  std::vector<std::optional<Setup>> setups;  // absent: this build cannot, and `trouble` says why
  std::vector<std::string> trouble;
  Start start;  // of all of them
  CompareFloor floor;
  std::vector<CompareErrors> errors;
  std::vector<std::vector<CompareRun>> runs;  // of each setting
  std::string machine;                        // that has timed the runs
};

// Reads every setup and makes every stepper once, so that what is wrong is said before hours of work. Keeps a pointer
// to the scene.
SceneWork open_scene(const Comparison&, const CompareScene&, bool short_form, const std::string& program);

// The files that the scene and its settings are read from, and what its cell depends on.
std::vector<std::filesystem::path> needs_of(const Comparison&, const SceneWork&);
std::string key_of(const Comparison&, const SceneWork&);

// Measures the scene: the floor, every setting's errors, and the timed runs of all settings in turn. Parts are kept in
// the scene's folder as they end, and those that are there are not made again. False: stopped.
bool measure_scene(const Comparison&, bool short_form, const CellWatch&, SceneWork&);

// Reads what measure_scene has left in the scene's folder. `machine`: the one that has measured. False: not all of it
// is there.
bool read_measured(const Comparison&, const std::string& machine, SceneWork&);

// The file of a setting's first run, which need not be there.
std::filesystem::path trajectory_of(const SceneWork&, std::size_t setting);

}  // namespace selvedge
