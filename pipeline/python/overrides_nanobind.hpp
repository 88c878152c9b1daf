#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

namespace selvedge {

// A value of Python as a scene file has it, on one line. Throws Error for what such a file cannot say.
std::string yaml_of(const nanobind::handle& value, const std::string& where);

// Overrides `key=value`: of a dict by dotted keys, in which dicts may stand in dicts, or a list of such texts as it is.
std::vector<std::string> overrides_of(const nanobind::handle& overrides);

}  // namespace selvedge
