#pragma once

#include <hdf5.h>
#include <sys/mman.h>
#include <unistd.h>

namespace selvedge {

// To be called after a failed write to an open file: its unwritten bytes are discarded when it is closed. A file that
// HDF5 cannot close crashes the program at its end. Closing also sets the file's length, which fails for /dev/null. So
// the bytes go to a file in memory that nobody else has.
inline void write_nowhere(hid_t file) {
  void* descriptor = nullptr;
  if (file < 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor) < 0) return;
  const int nowhere = ::memfd_create("nowhere", MFD_CLOEXEC);
  if (nowhere < 0) return;
  ::dup2(nowhere, *static_cast<int*>(descriptor));
  ::close(nowhere);
}

}  // namespace selvedge
