#include "pipeline/host/csv_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace selvedge {
namespace {

double number_of(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  return end == word.c_str() ? std::nan("") : number;
}

}  // namespace

CsvColumns::CsvColumns(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line, word;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    for (std::vector<double>& column : columns)
      column.push_back(std::getline(words, word, ',') ? number_of(word) : std::nan(""));
    if (!columns.empty()) continue;
    while (std::getline(words, word, ',')) names.push_back(word);
    columns.resize(names.size());
  }
}

const std::vector<double>& CsvColumns::operator[](const std::string& name) const {
  static const std::vector<double> none;
  const auto at = std::ranges::find(names, name);
  return at == names.end() ? none : columns[static_cast<std::size_t>(at - names.begin())];
}

}  // namespace selvedge
