#include "pipeline/python/fields_nanobind.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace selvedge {

nanobind::object object_of(const FieldValue& value) {
  return std::visit([](const auto& one) { return nanobind::cast(one); }, value);
}

}  // namespace selvedge
