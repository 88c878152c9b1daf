#pragma once

#include <filesystem>

namespace selvedge {

// The commands `selvedge weights ..`; see commands.hpp for what they return.

struct WeightsImportArguments {
  std::filesystem::path checkpoint, out;
};

struct WeightsInfoArguments {
  std::filesystem::path file;
};

struct WeightsHalveArguments {
  std::filesystem::path file, out;
};

struct WeightsParityArguments {
  std::filesystem::path file, dump;
};

int weights_import_command(const WeightsImportArguments&, bool json);
int weights_info_command(const WeightsInfoArguments&, bool json);
int weights_halve_command(const WeightsHalveArguments&, bool json);
int weights_parity_command(const WeightsParityArguments&, bool json);

}  // namespace selvedge
