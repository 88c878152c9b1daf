#pragma once

namespace selvedge {

// What proposals have cost and saved so far, for the rule that stops proposals which do not pay. In seconds, or in any
// other measure of work.
class ProposalTimes {
 public:
  void add_parent(double time);  // a step without a proposal
  void add_refused(double proposal,
                   double step);  // the time lost on a proposal, and the parent's time for the step
  void add_taken(double time);    // a step made by a proposal

  // Whether enough steps of the parent were seen, the last one recently, to know its time.
  bool knows_parent() const;
  // Whether one more proposal, if it costs what the last one did, keeps the total cost of proposals beyond the parent's
  // time within `extra` times all time so far.
  bool may_propose(double extra) const;

 private:
  double parent_ = 0;          // time of a step: a mean in which the latest weigh most
  int parents_ = 0, age_ = 0;  // number of the parent's steps, and of steps since the last one
  double all_ = 0, lost_ = 0, last_lost_ = 0;
};

}  // namespace selvedge
