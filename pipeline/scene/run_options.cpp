#include "pipeline/scene/run_options.hpp"

namespace selvedge {

const std::vector<std::string>& known_steppers() {
  static const std::vector<std::string> known{"conventional", "icm"};
  return known;
}

}  // namespace selvedge
