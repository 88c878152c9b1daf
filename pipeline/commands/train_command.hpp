#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace selvedge {

// The command `selvedge train`; see commands.hpp for what it returns.

struct TrainArguments {
  std::filesystem::path config;
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path out;
  bool resume = false, pause = false;
};

int train_command(const TrainArguments&, bool json);

}  // namespace selvedge
