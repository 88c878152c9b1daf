#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/scene/outcome_measures.hpp"

namespace selvedge {

// The measure must lie between `least` and `most` in every frame that counts, or in one of them (`once`).
struct Outcome {
  std::string name;
  Measure measure;
  std::optional<double> from{}, until{};  // times of the frames that count [s]; neither: the last frame
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool once = false;
};

struct OutcomeResult {
  std::string name;
  bool came_true = false;
  double value = 0;  // in the frame that decided: the first that failed, else the last that counted
  int frame = -1;    // that frame; -1: no frame counted
};

// Follows a run: shown every state from the first on, with what the world asked of it.
class OutcomeWatch {
 public:
  OutcomeWatch(const Scene&, const std::vector<Outcome>&, double end_time);
  void operator()(const State&, const Drive&);
  std::vector<OutcomeResult> results() const;

 private:
  struct Progress {
    double turned = 0;     // turns so far
    Points start;          // positions that drift is measured from
    bool decided = false;  // failed, or with `once` come true
    OutcomeResult result;
  };
  double measure(const Outcome&, Progress&, const State&, const Drive&) const;
  bool counts(const Outcome&, double time) const;

  const Scene& scene_;
  const std::vector<Outcome>& outcomes_;
  double end_time_;
  Points before_;  // positions of the frame before
  std::vector<Progress> progress_;
};

bool all_came_true(const std::vector<OutcomeResult>&);

// One line: the name, and where it did not come true what was measured instead.
std::string outcome_text(const Outcome&, const OutcomeResult&);

}  // namespace selvedge
