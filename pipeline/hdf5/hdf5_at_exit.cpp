#include "pipeline/hdf5/hdf5_at_exit.hpp"

#include <hdf5.h>

namespace selvedge::h5 {

void do_nothing_at_exit() { H5dont_atexit(); }

}  // namespace selvedge::h5
