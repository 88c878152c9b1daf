#pragma once

namespace selvedge {

// What proposals have cost and saved so far, for the rule that stops them where they do not pay. In seconds, or in any
// other measure of work.
class ProposalTimes {
 public:
  void add_parent(double time);  // a step without a proposal
  void add_refused(double proposal,
                   double step);  // the time lost on a proposal, and that of the parent's step after it
  void add_taken(double time);    // a step that a proposal has become

  // Whether enough of the parent's steps were seen, and the last one not long ago, to know its time.
  bool knows_parent() const;
  // Whether another proposal, if it goes as the last one did, leaves the sum of what proposals have cost beyond the
  // parent's time within `extra` times all time so far.
  bool may_propose(double extra) const;

 private:
  double parent_ = 0;          // of a step, the latest weigh most
  int parents_ = 0, age_ = 0;  // its steps, and those since the last one
  double all_ = 0, lost_ = 0, last_lost_ = 0;
};

}  // namespace selvedge
