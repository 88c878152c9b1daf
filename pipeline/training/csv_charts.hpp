#pragma once

#include <string>
#include <vector>

namespace selvedge {

// A table of a training by columns. Words that are no numbers become NaN.
struct CsvColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  explicit CsvColumns(const std::string& csv);
  const std::vector<double>& operator[](const std::string& name) const;  // a missing column is empty
};

struct Curve {
  std::string name;
  std::vector<double> y;
};

// Curves over the steps as SVG. `logarithmic` leaves out values that are not above zero. Empty if nothing is left.
std::string chart(const std::string& title, const std::vector<double>& x, const std::vector<Curve>& curves,
                  bool logarithmic);
// The given columns of the table, except those that are zero throughout.
std::vector<Curve> columns_of(const CsvColumns&, const std::vector<std::string>& names);

// The head of an HTML page that needs no other files, and a heading with plain text.
std::string page_head(const std::string& title);
std::string page_text(const std::string& heading, const std::string& text);

}  // namespace selvedge
