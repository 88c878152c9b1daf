#pragma once

#include <memory>
#include <vector>

#include "pipeline/training/random_stream.hpp"
#include "pipeline/training/rolling_state.hpp"

namespace selvedge {

// A state with its target, from which a network has learned once. It cannot go on to its next frame.
struct TaughtState {
  RollingState state;
  Graph raw;  // what the network sees of it
};

// States with their targets that are learned from again. Where there are `most`, a new one takes the oldest one's
// place.
struct TaughtStates {
  std::size_t most = 0;
  std::size_t oldest = 0;  // index of the one that leaves next
  std::vector<std::unique_ptr<TaughtState>> all;

  void add(std::unique_ptr<TaughtState>);
  // `count` different ones, which there have to be.
  std::vector<TaughtState*> draw(RandomStream&, int count) const;
};

// A target that is there, V x 3 [m].
std::shared_future<TeacherStep> made_target(Points x);

// A copy of what losses and network need of a state that has a target, without the body and the cloth of later frames.
std::unique_ptr<TaughtState> taught_copy(const RollingState&, Graph raw);

}  // namespace selvedge
