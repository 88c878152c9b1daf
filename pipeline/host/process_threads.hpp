#pragma once

#include <optional>
#include <string>

namespace selvedge {

// Takes back a request by OMP_NUM_THREADS for more threads than 64, or than eight for each processor where that is
// more: their stacks alone would end the program. Returns what to warn of: one thread a processor is used then.
// Processes that the program starts, and OpenMP in this one where it is loaded already, have that number.
std::optional<std::string> limit_threads();

// How threads wait and how many BLAS starts are settings that those libraries read while they are loaded, before main.
// So where the environment lacks them this adds them and starts the program over, in the same process; what else the
// user has set stays. Call in main after limit_threads; `limited`: that has changed the environment. Returns where
// there is nothing to do.
// * A thread that waits for work spins for some 30 us and then sleeps. Left alone it spins for milliseconds, which on a
//   machine with other work to do was measured to make a frame five times slower, and gains nothing on an idle one.
// * BLAS runs on the calling thread alone: the parallel loops are ours.
void set_up_threads(char** arguments, bool limited);

}  // namespace selvedge
