#include "pipeline/host/process_threads.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/parallel.hpp"

namespace selvedge {
namespace {

// Each level of nested loops has a number of its own in the list.
bool asks_for_more_than(long long most, const char* list) {
  for (const char* at = list; *at != '\0'; ++at) {
    if (!std::isdigit(static_cast<unsigned char>(*at))) continue;
    char* end = nullptr;
    if (std::strtoll(at, &end, 10) > most) return true;
    at = end - 1;
  }
  return false;
}

}  // namespace

std::optional<std::string> limit_threads() {
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const long long most = std::max<long long>(64, 8LL * processors);
  const char* set = std::getenv("OMP_NUM_THREADS");
  if (!set || !asks_for_more_than(most, set)) return {};
  const std::string asked = set;
  setenv("OMP_NUM_THREADS", std::to_string(processors).c_str(), 1);
  use_threads(processors);
  return fmt::format("OMP_NUM_THREADS={} is more than {} threads: {} used, one a processor", asked, most,
                     counted(processors, "is", "are"));
}

void set_up_threads(char** arguments, bool limited) {
  const bool waits = std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT");
  if (!limited && waits && std::getenv("OPENBLAS_NUM_THREADS")) return;
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
