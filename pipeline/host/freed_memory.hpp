#pragma once

namespace selvedge {

// Keeps memory that is freed for the next allocation, in place of giving it back to the system and asking anew: arrays
// of a few hundred kB come and go in each frame, and each new page of them costs a fault. Does nothing where the user
// has set how the allocator works (MALLOC_... or GLIBC_TUNABLES), or where it is not glibc's. Call in main.
void keep_freed_memory();

}  // namespace selvedge
