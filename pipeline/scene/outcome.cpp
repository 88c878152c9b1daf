#include "pipeline/scene/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

constexpr double time_slack = 1e-6;  // of sums of time steps [s]

}  // namespace

OutcomeWatch::OutcomeWatch(const Scene& scene, const std::vector<Outcome>& outcomes, double end_time)
    : scene_(scene), outcomes_(outcomes), end_time_(end_time), progress_(outcomes.size()) {
  for (std::size_t k = 0; k < outcomes.size(); ++k) progress_[k].result.name = outcomes[k].name;
}

bool OutcomeWatch::counts(const Outcome& outcome, double time) const {
  if (!outcome.from && !outcome.until) return time >= end_time_ - time_slack;
  return time >= outcome.from.value_or(0) - time_slack && time <= outcome.until.value_or(end_time_) + time_slack;
}

double OutcomeWatch::measure(const Outcome& outcome, Progress& progress, const State& state, const Drive& drive) const {
  return std::visit(
      [&](const auto& m) {
        using M = std::decay_t<decltype(m)>;
        if constexpr (std::is_same_v<M, Turns>)
          return progress.turned;
        else if constexpr (std::is_same_v<M, Drift>)
          return drift(m, progress.start, state.x);
        else
          return measured(m, scene_, state, drive);
      },
      outcome.measure);
}

void OutcomeWatch::operator()(const State& state, const Drive& drive) {
  for (std::size_t k = 0; k < outcomes_.size(); ++k) {
    const Outcome& outcome = outcomes_[k];
    Progress& progress = progress_[k];
    if (const Turns* turns = std::get_if<Turns>(&outcome.measure); turns && before_.rows() > 0)
      progress.turned += turned(*turns, before_, state.x);
    if (progress.decided || !counts(outcome, state.time)) continue;
    if (progress.start.rows() == 0) progress.start = state.x;
    const double value = measure(outcome, progress, state, drive);
    const bool within = value >= outcome.least && value <= outcome.most;  // false for NaN
    progress.decided = within == outcome.once;
    progress.result = {outcome.name, within, value, state.frame};
  }
  before_ = state.x;
}

std::vector<OutcomeResult> OutcomeWatch::results() const {
  std::vector<OutcomeResult> all;
  for (const Progress& progress : progress_) all.push_back(progress.result);
  return all;
}

bool all_came_true(const std::vector<OutcomeResult>& results) {
  return std::ranges::all_of(results, &OutcomeResult::came_true);
}

std::string outcome_text(const Outcome& outcome, const OutcomeResult& result) {
  if (result.came_true) return outcome.name + ": yes";
  if (result.frame < 0) return outcome.name + ": no frame came to it";
  std::string asked;
  if (std::isfinite(outcome.least)) asked += fmt::format(" at least {:.4g}", outcome.least);
  if (std::isfinite(outcome.most)) asked += fmt::format(" at most {:.4g}", outcome.most);
  return fmt::format("{}: no, {:.4g} in frame {}, asked{}", outcome.name, result.value, result.frame, asked);
}

}  // namespace selvedge
