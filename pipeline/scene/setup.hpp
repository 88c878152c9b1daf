#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/steppers/following_stepper.hpp"
#include "pipeline/formats/look.hpp"
#include "pipeline/garments/worn_part.hpp"
#include "pipeline/scene/kinds.hpp"
#include "pipeline/scene/outcome.hpp"
#include "pipeline/scene/run_options.hpp"

namespace selvedge {

struct PosedBodies;
struct SceneTable;
struct WeightFile;

// A garment of a scene: where it is on its body, and whether it still is.
struct WornCloth {
  int cloth = 0, obstacle = 0;
  WornWatch watch;
};

// A scene file, read: everything a run needs.
struct Setup {
  std::filesystem::path file;
  std::string config;  // the full configuration as YAML, overrides applied
  Scene scene;
  State initial;         // when its time begins; what a run starts from is made of it (run/prepare.hpp)
  Points velocity;       // at time 0
  std::string prepared;  // what was done for the initial state; empty: nothing
  RunOptions run;
  std::string quality;                               // what run.quality has set, for people
  std::function<Drive(double time)> drive_at;        // the world at a time [s]
  std::vector<std::shared_ptr<PosedBodies>> bodies;  // of each obstacle, null for what is no body: what drive_at knows
  std::vector<Follower> followers;                   // vertices without mass that go with others, all of them pins
  std::vector<Look> looks;                           // of each cloth, for the trajectory; empty: no file gives one
  std::vector<Outcome> outcomes;                     // what must come true
  std::vector<WornCloth> worn;                       // garments on their bodies, by where skinning has them at first
  std::vector<std::string> short_form;               // overrides that make a shorter run of the scene
  StepperKind kind;                                  // of the stepper
  Config kind_options;                               // what the file gives for it
  std::shared_ptr<std::map<std::filesystem::path, WeightFile>> networks;  // that network_of has read; copies share it
  std::shared_ptr<const SceneTable> table;                                // by which the file was read
  std::vector<std::string> warnings;  // named and counted: degenerate triangles left out, isolated vertices, ...
};

// Reads a scene file. `overrides` are key=value with dotted keys (run.frames=10). Throws Error with file, line, key,
// what is allowed and the nearest known key. `kinds` are the steppers that it may name.
Setup read_setup(const std::filesystem::path& file, const std::vector<std::string>& overrides = {},
                 const Kinds& = known_kinds());

}  // namespace selvedge
