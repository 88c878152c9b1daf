#pragma once

#include <string>
#include <vector>

#include "pipeline/host/csv_columns.hpp"
#include "pipeline/plots/plot.hpp"

namespace selvedge {

struct PlottedColumn {
  std::string column, name;  // of the table, and in words
};

// Columns of a training's table over its steps, as an element of a page. Columns that are zero throughout are left out;
// nothing if none is left. On a logarithmic scale signs are left out.
std::string column_plot(const std::string& title, const PlotAxis& y, const CsvColumns&,
                        const std::vector<PlottedColumn>&);

}  // namespace selvedge
