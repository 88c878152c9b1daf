#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/training/training_step.hpp"
#include "pipeline/training/training_watch.hpp"

namespace selvedge {

// Means over the steps since the last line of steps.csv.
class StepWindow {
 public:
  void add(const StepRecord&);
  // The sums so far, to be added over processes, and such sums added to these.
  std::vector<double> sums() const;
  void add(std::span<const double> sums, double learning_rate);
  // Mean of the sums of losses since the last line, or in the last line if there are none since [J].
  double mean_sum() const { return count_ > 0 ? sum_ / count_ : last_mean_; }
  // Returns the line and starts the next one. `counts`: of all processes.
  std::string take_line(const Trainer&, const TrainingCounts& counts, double seconds);

 private:
  struct Term {
    double value = 0, gradient = 0;
  };
  std::vector<Term> terms_;
  int count_ = 0, bad_ = 0;
  double sum_ = 0, norm_ = 0, scale_ = 0, rate_ = 0, last_mean_ = 0;
};

// Headers and lines of steps.csv and measures.csv, each with a newline. `seconds` is the time of training so far.
std::string steps_header();
// Converts a steps.csv of a version with other terms to the current columns. New columns are 0.
std::string with_columns_of_now(const std::string& steps_csv);
std::string measures_header();
std::string measure_line(const TrainingMeasure&, double seconds);

// The run as one HTML page without other files: every term, its share of the gradient, gaps and the roll-out.
std::string training_page(const TrainingOptions&, const std::string& steps_csv, const std::string& measures_csv);

}  // namespace selvedge
