#include "pipeline/host/peak_memory.hpp"

#include <malloc.h>

#include <fstream>
#include <string>

namespace selvedge {

std::int64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
    if (word == "VmHWM:") {
      std::int64_t kibibytes = 0;
      status >> kibibytes;
      return kibibytes * 1024;
    }
  return 0;
}

void reset_peak_memory() {
  malloc_trim(0);  // what was freed but kept would count for the next run
  std::ofstream("/proc/self/clear_refs") << 5;
}

}  // namespace selvedge
