#include "physics/steppers/proposal_times.hpp"

#include <algorithm>

namespace selvedge {
namespace {

constexpr int learning_steps = 8;       // steps of the parent before its time counts as known
constexpr int longest_known = 32;       // steps after its last one for which its time counts as known
constexpr double newest_weight = 0.25;  // of a step in the parent's mean time

}  // namespace

void ProposalTimes::add_parent(double time) {
  parent_ = parents_ == 0 ? time : (1 - newest_weight) * parent_ + newest_weight * time;
  ++parents_;
  age_ = 0;
  all_ += time;
}

void ProposalTimes::add_refused(double proposal, double step) {
  add_parent(step);
  all_ += proposal;
  last_lost_ = proposal;
  lost_ += proposal;
}

void ProposalTimes::add_taken(double time) {
  all_ += time;
  ++age_;
  if (parents_ == 0) return;
  last_lost_ = time - parent_;
  lost_ += last_lost_;
}

bool ProposalTimes::knows_parent() const { return parents_ >= learning_steps && age_ < longest_known; }

bool ProposalTimes::may_propose(double extra) const { return lost_ + std::max(0.0, last_lost_) <= extra * all_; }

}  // namespace selvedge
