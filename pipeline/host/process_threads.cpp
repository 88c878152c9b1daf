#include "pipeline/host/process_threads.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace selvedge {

void set_up_threads(char** arguments) {
  const bool waits = std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT");
  if (waits && std::getenv("OPENBLAS_NUM_THREADS")) return;
  if (!waits) setenv("GOMP_SPINCOUNT", "10000", 0);
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  // By its path, so that lists of processes show its name; or as it runs, where its file is gone. Comes back only if
  // both failed, and then nothing is lost but speed.
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (!unknown) execv(program.c_str(), arguments);
  execv("/proc/self/exe", arguments);
}

}  // namespace selvedge
