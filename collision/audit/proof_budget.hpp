#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "collision/audit/box_pairs.hpp"

namespace selvedge {

// How many parts the time of one pair may be cut into before it counts as not apart: at last, and in a first round.
// Ordinary cloth needs one; the most that was seen is 16.
inline constexpr int most_parts = 4096, few_parts = 64;

// What the proofs of one motion may cost, in counts. Only totals over all pairs decide what is given up. So the result
// is the same for any number of threads, with a memory and without.
class ProofBudget {
 public:
  // The most pairs that few_parts may leave unproven. Where there are more, the audit ends.
  static constexpr int most_unproven = 1 << 16;
  // Parts of time for the second round, for all pairs together that few_parts did not decide.
  static constexpr std::int64_t parts_for_open = std::int64_t{1} << 22;

  void add_unproven() { unproven_.fetch_add(1, std::memory_order_relaxed); }
  bool exceeded() const { return unproven_.load(std::memory_order_relaxed) > most_unproven; }
  // Parts of time for each of `open` pairs.
  static int share(std::size_t open) {
    const auto each = parts_for_open / std::max<std::int64_t>(1, static_cast<std::int64_t>(open));
    return static_cast<int>(std::clamp<std::int64_t>(each, few_parts, most_parts));
  }

 private:
  std::atomic<int> unproven_ = 0;
};

// Asks before each proof in a part of the search whether the audit goes on. A proof for coincident edges takes many
// parts, and a part may hold many of them, so that asking once for each part would be too rare.
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
