#pragma once

#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "collision/geometry/error.hpp"
#include "pipeline/processes/processes.hpp"

namespace selvedge {

// A failure that every process knows of: all of them throw it at the same call. `where` begins with the rank of the
// process that failed, unless that is rank 0.
struct SharedFailure : Error {
  using Error::Error;
};

// Each of these calls first compares what the processes are about to do. It throws SharedFailure on all of them where
// one has failed (`together`), or where they do not do the same.

// Adds up numbers of all processes, one by one, in the order of ranks: every process gets the same bits, whatever the
// timing. All give equally many. Each process adds a part of them, so that memory and traffic hardly grow with ranks.
void add_up(Processes&, std::span<float>);
void add_up(Processes&, std::span<double>);

// The number that each process gives, by rank.
std::vector<std::uint64_t> gathered(Processes&, std::uint64_t);

// Throws SharedFailure unless all give the same number. `what`: what it stands for, as "configurations".
void check_same(Processes&, std::uint64_t, const std::string& what, const std::string& where, const std::string& cure);

void wait_for_all(Processes&);

// Tells the other processes, at their next call, that this one has failed. Throws SharedFailure with the failure of the
// first rank that has one.
[[noreturn]] void share_failure(Processes&, const std::exception&);

// Does the work of this process. Where it throws, all processes throw SharedFailure. Null: it is alone.
template <class Work>
auto together(Processes* processes, const Work& work) {
  if (!processes) return work();
  try {
    return work();
  } catch (const SharedFailure&) {
    throw;
  } catch (const std::exception& problem) {
    share_failure(*processes, problem);
  }
}

}  // namespace selvedge
