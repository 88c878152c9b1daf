#include "pipeline/host/process_threads.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <thread>

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

// Takes back a request for absurdly many threads, whose stacks alone would end the program. Returns whether there was
// one.
bool refuse_too_many_threads() {
  const long long processors = std::max(1u, std::thread::hardware_concurrency());
  const long long most = std::max<long long>(64, 8 * processors);
  const char* asked = std::getenv("OMP_NUM_THREADS");
  if (!asked || !asks_for_more_than(most, asked)) return false;
  std::cerr << "warning: OMP_NUM_THREADS=" << asked << " is more than " << most << " threads: " << processors
            << " are used, one a processor\n";
  setenv("OMP_NUM_THREADS", std::to_string(processors).c_str(), 1);
  return true;
}

}  // namespace

void set_up_threads(char** arguments) {
  const bool too_many = refuse_too_many_threads();
  const bool waits = std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT");
  if (!too_many && waits && std::getenv("OPENBLAS_NUM_THREADS")) return;
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
