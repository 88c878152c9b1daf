#pragma once

namespace selvedge {

// How threads wait, how many there are and how many BLAS starts are settings that those libraries read while they are
// loaded, before main. So where the environment lacks them this adds them and starts the program over, in the same
// process; what else the user has set stays. Call first in main; returns where there is nothing to do.
// * A thread that waits for work spins for some 30 us and then sleeps. Left alone it spins for milliseconds, which on a
//   machine with other work to do was measured to make a frame five times slower, and gains nothing on an idle one.
// * More threads than 64, or than eight for each processor where that is more, are not taken seriously: the program has
//   one a processor then, and standard error says so.
// * BLAS runs on the calling thread alone: the parallel loops are ours.
void set_up_threads(char** arguments);

}  // namespace selvedge
