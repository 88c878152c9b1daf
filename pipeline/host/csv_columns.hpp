#pragma once

#include <string>
#include <vector>

namespace selvedge {

// A table of numbers by columns, from text with commas and a line of names. Words that are no numbers become NaN.
struct CsvColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  explicit CsvColumns(const std::string& csv);
  const std::vector<double>& operator[](const std::string& name) const;  // a missing column is empty
};

}  // namespace selvedge
