#pragma once

#include <string>

#include "learned/network/architecture.hpp"

namespace selvedge {

// The architecture as lines `field: value`, for weight files and for people. Numbers are written so that they are read
// back as they were.
std::string architecture_text(const Architecture&);

// Throws Error, which names `where` and the field, for a field that is missing, unknown, given twice or not of its
// kind, and whatever `check_architecture` refuses.
Architecture parse_architecture(const std::string& text, const std::string& where);

}  // namespace selvedge
