#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "pipeline/compare/algebraic_error.hpp"
#include "pipeline/run/summary.hpp"
#include "pipeline/suites/bench_detection.hpp"
#include "pipeline/suites/bench_engine.hpp"
#include "pipeline/suites/bench_training.hpp"

namespace selvedge {

struct BenchRequest {
  std::filesystem::path configs = "configs/bench";  // holds SCENE.yaml of every scene
  std::vector<std::string> scenes{"hang", "drop", "tube"};
  std::vector<int> sizes{40, 64, 100, 150};
  std::vector<std::string> only{"detection", "engine", "training", "scenes"};  // the parts to run
  std::optional<int> frames;                                                   // instead of the scenes' own
  std::filesystem::path out = "out/bench";
  std::ostream* log = nullptr;  // a line as each member ends
};

struct BenchMember {
  std::string scene;
  int size = 0;
  RunSummary summary;
  std::optional<AlgebraicError> algebraic;  // worst of the contact-free states that were looked at; hang only
  std::optional<double> decay;              // energy lost, over what a run with converged steps loses; hang only
};

struct BenchResult {
  std::vector<DetectionTiming> detection;
  std::optional<EngineTimings> engine;
  std::vector<TrainingTiming> training;
  std::vector<BenchMember> members;
};

// Times self-detection, then the engine of learned steppers, then steps of training, then runs every scene at every
// size through run_scene, each into its own folder below `out`, and leaves bench.json, bench.csv and bench.txt there.
BenchResult bench(const BenchRequest&);

// Everything for programs; a row a member; tables for people.
std::string bench_json(const BenchResult&);
std::string bench_csv(const std::vector<BenchMember>&);
std::string bench_table(const BenchResult&);

}  // namespace selvedge
