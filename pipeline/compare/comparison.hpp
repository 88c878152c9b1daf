#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/compare/row_limits.hpp"
#include "pipeline/scene/kinds.hpp"

namespace selvedge {

struct CompareScene {
  std::string name;
  std::filesystem::path file;
  std::vector<std::string> overrides;  // key=value
  int states = 4;                      // common states, spread over the run; 0: no references, no errors
  int horizon = 6;                     // frames from each of them
  std::string outfit;                  // group of the scene in an evaluation
  // Of a sequence:
  bool tangled = false;  // by the generator of training
};

// A row of every scene: a stepper as it is set.
struct CompareSetting {
  std::string name;
  std::vector<std::string> overrides;
  std::string stepper;            // replaces that of the scene; empty: the scene's
  std::filesystem::path weights;  // of its network; empty: none
};

// Sequences, an outfit on a clip each. They start as skinned in the first frame of the clip, or tangled by the
// generator of the third training stage.
struct SequenceOptions {
  std::string file;                         // the scene of them all, seen from the comparison file
  std::vector<std::string> outfits, clips;  // each outfit with each clip in turn
  int count = 0, tangled = 0;               // of sequences; of them tangled
  int frames = 150;
  std::uint64_t seed = 1;
  double shape_spread = 3;  // of the bodies of tangled ones [standard deviations]
  std::string training;     // file whose people are compared on, seen from the comparison file; empty: outfits
  std::string split = "test";
};

// Options of an evaluation's tables.
struct EvaluationOptions {
  std::string baseline;  // the row to which the others are compared; empty: no evaluation
  int resamples = 10000;
  bool volume = false;   // of self-penetration too, on the runs kept
  int left_frames = 50;  // frames of the plot of remaining initial pairs
};

// Which table of Tan et al. 2022 a run stands in: those of garments, table 5 (graph networks from scratch) or table 6
// (few and many shapes on unseen clips).
enum class DrapesUse { garments, graph_network, clips };

// A finished training of drapes, for the tables of the repulsive layer.
struct ComparedDrapes {
  std::string name;
  std::filesystem::path run;  // its folder, seen from the working folder
  DrapesUse use = DrapesUse::garments;
  bool counted = true;  // in the means over all garments
};

// A comparison file, read.
struct Comparison {
  std::filesystem::path file;
  std::vector<CompareScene> scenes;
  std::vector<CompareSetting> settings;
  std::vector<ComparedDrapes> drapes;
  std::vector<std::string> reference;  // overrides of the temporal reference, beside its time step
  std::vector<std::string> algebraic;  // and of the algebraic one
  Kinds kinds = known_kinds();         // of steppers
  SequenceOptions sequences;
  std::string split_text;  // what sequences of a training file are of; empty: there are none
  EvaluationOptions evaluation;
  RowLimits limits;
  std::string weights_folder;  // seen from the file
  int keep_runs = 0;  // of so many scenes, the trajectory of each row's first repeat and a page that plays them
  int repeats = 3;
  int judged_frames = 4;  // of a run, of which the distance to the optimum is found
  double jitter = 1e-3;   // of the common states for the floor, in mean edge lengths
};

// Throws Error with file, line and key. short_form: with the file's own `short_form` and that of every scene.
// `overrides` are key=value, of the comparison file.
Comparison read_comparison(const std::filesystem::path&, bool short_form,
                           const std::vector<std::string>& overrides = {});

}  // namespace selvedge
