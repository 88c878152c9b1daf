#include "pipeline/commands/command_output.hpp"

#include <optional>

#include "pipeline/run/running_mark.hpp"

namespace selvedge {

int end_command(bool json, const std::string& text, const std::string& object, bool well) {
  people(json) << text;
  if (json) std::cout << object;
  return well ? 0 : 1;
}

std::string stopped_text(bool finished) { return finished ? "" : "stopped; the same command goes on\n"; }

void warn_of_training() {
  if (const std::optional<std::string> training = running_training())
    std::cerr << "warning: " << *training << " is being trained: times are not to be compared with others\n";
}

}  // namespace selvedge
