#pragma once

#include <string>
#include <vector>

namespace selvedge {

// A table of a training by columns; what is no number is NaN.
struct CsvColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  explicit CsvColumns(const std::string& csv);
  const std::vector<double>& operator[](const std::string& name) const;  // none: empty
};

struct Curve {
  std::string name;
  std::vector<double> y;
};

// Curves over the steps as SVG; `logarithmic` leaves out what is not above zero. Empty where nothing is left.
std::string chart(const std::string& title, const std::vector<double>& x, const std::vector<Curve>& curves,
                  bool logarithmic);
// Those columns of the table that are not zero throughout.
std::vector<Curve> columns_of(const CsvColumns&, const std::vector<std::string>& names);

// The beginning of a page that needs nothing else, and a heading with text as it stands.
std::string page_head(const std::string& title);
std::string page_text(const std::string& heading, const std::string& text);

}  // namespace selvedge
