#include "pipeline/training/taught_states.hpp"

#include <utility>

namespace selvedge {

void TaughtStates::add(std::unique_ptr<TaughtState> state) {
  if (all.size() < most) {
    all.push_back(std::move(state));
    return;
  }
  all[oldest] = std::move(state);
  oldest = (oldest + 1) % most;
}

std::vector<TaughtState*> TaughtStates::draw(RandomStream& random, int count) const {
  std::vector<TaughtState*> left, drawn;
  for (const auto& one : all) left.push_back(one.get());
  for (int k = 0; k < count; ++k) {
    const auto at = left.begin() + random.below(static_cast<int>(left.size()));
    drawn.push_back(*at);
    left.erase(at);
  }
  return drawn;
}

std::shared_future<TeacherStep> made_target(Points x) {
  std::promise<TeacherStep> made;
  made.set_value({std::move(x), nullptr, ""});
  return made.get_future().share();
}

std::unique_ptr<TaughtState> taught_copy(const RollingState& from, Graph raw) {
  auto copy = std::make_unique<TaughtState>();
  RollingState& to = copy->state;
  to.roll.request = from.roll.request;
  to.roll.scene = from.roll.scene;
  to.frame = from.frame;
  to.pass = from.pass;
  to.now = from.now;
  to.over = false;
  to.taught = made_target(from.taught.get().x);  // the future itself would keep the solver of the roll-out
  to.body_left_out = from.body_left_out;
  to.found = from.found;
  copy->raw = std::move(raw);
  return copy;
}

}  // namespace selvedge
