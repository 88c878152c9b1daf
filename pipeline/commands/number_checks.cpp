#include "pipeline/commands/number_checks.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>
#include <string>

#include "pipeline/config/config_units.hpp"

namespace selvedge {
namespace {

CLI::Validator number_check(bool zero_allowed, const std::string& allowed, const std::string& in_help) {
  return {[=](const std::string& text) -> std::string {
            const std::optional<double> number = read_number(text);
            if (number && std::isfinite(*number) && (*number > 0 || (zero_allowed && *number == 0))) return {};
            return "is `" + text + "`; give a number " + allowed;
          },
          in_help};
}

}  // namespace

CLI::Validator above_zero() { return number_check(false, "above 0", "POSITIVE"); }
CLI::Validator at_least_zero() { return number_check(true, "of at least 0", "NONNEGATIVE"); }

}  // namespace selvedge
