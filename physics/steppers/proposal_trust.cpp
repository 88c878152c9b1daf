#include "physics/steppers/proposal_trust.hpp"

#include <algorithm>

namespace selvedge {
namespace {

constexpr const char* trust_block = "hybrid.trust";

}  // namespace

bool read_trust(const State& state, ProposalTrust& trust) {
  const MemoryRows* rows = find_rows(state.memory, trust_block, 1);
  if (!rows || rows->cols() != 3) return false;
  const auto number = [&](int k) { return static_cast<int>((*rows)(0, k)); };
  trust = {number(0), number(1), number(2)};
  return true;
}

void remember(const ProposalTrust& trust, State& state) {
  MemoryRows row(1, 3);
  row << trust.wait, trust.next_wait, trust.admitted;
  replace_blocks("hybrid", {{trust_block, row}}, state.memory);
}

ProposalTrust after_wait(ProposalTrust trust) {
  trust.wait = std::max(0, trust.wait - 1);
  return trust;
}

ProposalTrust after_admission(ProposalTrust trust, int to_halve) {
  if (++trust.admitted < to_halve) return trust;
  return {0, std::max(1, trust.next_wait / 2), 0};
}

ProposalTrust after_refusal(ProposalTrust trust, int longest_wait) {
  const int wait = std::min(trust.next_wait, longest_wait);
  return {wait, std::min(2 * wait, longest_wait), 0};
}

}  // namespace selvedge
