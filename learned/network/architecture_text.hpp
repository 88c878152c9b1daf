#pragma once

#include <string>

#include "learned/network/architecture.hpp"

namespace selvedge {

// The architecture as lines `field: value`, for weight files and for people. Numbers are read back exactly.
std::string architecture_text(const Architecture&);

// Throws Error, which names `where` and the field, for a field that is missing, unknown, duplicate or malformed, and
// where `check_architecture` does.
Architecture parse_architecture(const std::string& text, const std::string& where);

}  // namespace selvedge
