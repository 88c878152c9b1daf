#include "pipeline/host/process_threads.hpp"

#include <unistd.h>

#include <cstdlib>

namespace selvedge {

void set_up_threads(char** arguments) {
  const bool waits = std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT");
  if (waits && std::getenv("OPENBLAS_NUM_THREADS")) return;
  if (!waits) setenv("GOMP_SPINCOUNT", "10000", 0);
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  execv("/proc/self/exe", arguments);  // comes back only if it failed, and then nothing is lost but speed
}

}  // namespace selvedge
