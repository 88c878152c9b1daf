#pragma once

namespace selvedge::h5 {

// For a program, before it uses HDF5. At exit HDF5 closes what it has left open, and crashes there where a write to it
// has failed, as on a full disk. Files of ours are closed by their handles, so that HDF5 has nothing to do at exit.
void do_nothing_at_exit();

}  // namespace selvedge::h5
