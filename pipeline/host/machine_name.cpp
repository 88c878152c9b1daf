#include "pipeline/host/machine_name.hpp"

#include <unistd.h>

#include <array>
#include <fstream>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/parallel.hpp"

namespace selvedge {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (const std::size_t colon = line.find(": "); line.starts_with("model name") && colon != std::string::npos)
      return line.substr(colon + 2);
  return "unknown processor";
}

}  // namespace

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return "unknown";
  return name.data();
}

std::string machine_name() { return host_name() + ", " + processor_name() + ", " + counted(most_threads(), "thread"); }

}  // namespace selvedge
