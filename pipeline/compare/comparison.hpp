#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/compare/row_limits.hpp"
#include "pipeline/scene/kinds.hpp"

namespace selvedge {

// A scene of a comparison. Members are described where keys are bound to them: pipeline/compare/comparison.cpp.
struct CompareScene {
  std::string name;
  std::filesystem::path file;
  std::vector<std::string> overrides;
  int states = 4, horizon = 6;
  std::string outfit;
  // Of a sequence:
  bool tangled = false;         // by the generator of training
  std::optional<int> sequence;  // number of a tangled one whose start has yet to be found (find_start)
};

// A row of every scene: a stepper as it is set.
struct CompareSetting {
  std::string name;
  std::vector<std::string> overrides;
  std::string stepper;            // replaces that of the scene; empty: the scene's
  std::filesystem::path weights;  // of its network; empty: none
};

// Sequences, an outfit on a clip each. Members are described where keys are bound to them:
// pipeline/compare/comparison.cpp.
struct SequenceOptions {
  std::string file;
  std::vector<std::string> outfits, clips;
  int count = 0, tangled = 0;
  int frames = 150;
  std::uint64_t seed = 1;
  double shape_spread = 3;
  std::string training;
  std::string split = "test";
};

// Options of an evaluation's tables. Members are described where keys are bound to them:
// pipeline/compare/comparison.cpp.
struct EvaluationOptions {
  std::string baseline;
  int resamples = 10000;
  bool volume = false;
  int left_frames = 50;
};

// Which table of Tan et al. 2022 a run stands in: those of garments, table 5 (graph networks from scratch) or table 6
// (few and many shapes on unseen clips).
enum class DrapesUse { garments, graph_network, clips };

// A finished training of drapes, for the tables of the repulsive layer. Members are described where keys are bound to
// them: pipeline/compare/comparison.cpp.
struct ComparedDrapes {
  std::string name;
  std::filesystem::path run;  // its folder, seen from the working folder
  DrapesUse use = DrapesUse::garments;
  bool counted = true;
};

// A comparison file, read. Members are described where keys are bound to them: pipeline/compare/comparison.cpp.
struct Comparison {
  std::filesystem::path file;
  std::vector<CompareScene> scenes;
  std::vector<CompareSetting> settings;
  std::vector<ComparedDrapes> drapes;
  std::vector<std::string> reference, algebraic;
  Kinds kinds = known_kinds();  // of steppers
  SequenceOptions sequences;
  std::string split_text;  // what sequences of a training file are of; empty: there are none
  EvaluationOptions evaluation;
  RowLimits limits;
  std::string weights_folder;
  int keep_runs = 0;
  int repeats = 3;
  int judged_frames = 4;
  double jitter = 1e-3;
};

// Throws Error with file, line and key. short_form: with the file's own `short_form` and that of every scene.
// `overrides` are key=value, of the comparison file.
Comparison read_comparison(const std::filesystem::path&, bool short_form,
                           const std::vector<std::string>& overrides = {});

}  // namespace selvedge
