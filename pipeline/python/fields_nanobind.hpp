#pragma once

#include <nanobind/nanobind.h>

#include <variant>

#include "pipeline/reports/bound_field.hpp"

namespace selvedge {

// A field's value as Python's bool, int, float, str or list of int.
nanobind::object object_of(const FieldValue&);

// The fields of a struct by their names, those that have a column.
template <class Struct>
nanobind::dict dict_of(const BoundFields<Struct>& fields, const Struct& all) {
  nanobind::dict dict;
  for (const BoundField<Struct>& field : fields)
    if (field.type != ColumnType::none) dict[field.name.c_str()] = object_of(field.get(all));
  return dict;
}

}  // namespace selvedge
