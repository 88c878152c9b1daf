#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "collision/audit/bisection.hpp"

namespace selvedge {

// Parts of the time that one pair may be cut into before it counts as not apart: in the end, and at first. Ordinary
// cloth needs one, and 16 at the most that was seen.
inline constexpr int most_parts = 4096, few_parts = 64;

// What the proofs of one motion may cost, in counts. Totals over all pairs decide what is given up, not their order:
// the result is the same for any number of threads, with a memory and without.
class ProofBudget {
 public:
  // Pairs that few parts do not prove apart. Where there are more, nothing is learned from further proofs.
  static constexpr int most_unproven = 1 << 16;
  // Of the time, for all pairs together that few parts did not decide.
  static constexpr std::int64_t parts_for_open = std::int64_t{1} << 22;

  void add_unproven() { unproven_.fetch_add(1, std::memory_order_relaxed); }
  bool exceeded() const { return unproven_.load(std::memory_order_relaxed) > most_unproven; }
  // Parts for each of so many pairs.
  static int share(std::size_t open) {
    const auto each = parts_for_open / std::max<std::int64_t>(1, static_cast<std::int64_t>(open));
    return static_cast<int>(std::clamp<std::int64_t>(each, few_parts, most_parts));
  }

 private:
  std::atomic<int> unproven_ = 0;
};

// Asks before a proof of a cell whether it is still wanted. One of coincident edges takes many parts, and a cell holds
// many of them: each proof counts, where a comparison of boxes hardly does.
class ProofWatch {
 public:
  ProofWatch(AuditBudget& searched, ProofBudget& proofs) : searched_(searched), proofs_(proofs) {}
  bool ended() {
    return (++asked_ % asked_after == 0 ? !searched_.add(0) : searched_.exceeded()) || proofs_.exceeded();
  }
  bool given_up() const { return proofs_.exceeded(); }
  void add_unproven() { proofs_.add_unproven(); }

 private:
  static constexpr int asked_after = 16;
  AuditBudget& searched_;
  ProofBudget& proofs_;
  int asked_ = 0;
};

}  // namespace selvedge
