#pragma once

#include <string>
#include <vector>

#include "collision/geometry/error.hpp"
#include "learned/graph/graph.hpp"

namespace selvedge {

// Copies the table's row for each value into the columns from `first` on, or does nothing without columns. Throws Error
// for a table of another width, or without a row for a value.
inline void embed(const FeatureRows& table, const std::vector<int>& values, int first, int columns, FeatureRows& rows) {
  if (columns == 0) return;
  if (table.cols() != columns)
    throw Error(
        "an embedding table has " + std::to_string(table.cols()) + " columns in place of " + std::to_string(columns),
        "weights of a learned stepper", "use weights with their own architecture");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < 0 || values[i] >= table.rows())
      throw Error("an embedding table has no row " + std::to_string(values[i]), "weights of a learned stepper",
                  "use weights with their own architecture");
    rows.row(static_cast<Eigen::Index>(i)).segment(first, columns) = table.row(values[i]);
  }
}

}  // namespace selvedge
