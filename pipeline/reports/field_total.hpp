#pragma once

#include <limits>
#include <string_view>
#include <vector>

#include "pipeline/reports/report_fields.hpp"

namespace selvedge {

// A field over the frames of a run. An enumerator counts by its number, a list by its sum.
struct FieldTotal {
  double sum = 0, largest = 0, smallest = std::numeric_limits<double>::infinity();
  double at_start = 0, at_end = 0;        // of frame 0 and of the last frame
  int frames = 0;                         // in which it is not 0
  int first_frame = -1, last_frame = -1;  // of these; -1: there is none
  std::vector<int> by_word = {};          // frames by an enumerator that is not 0; empty: there is none
};

// One a row of report_fields().
using FieldTotals = std::vector<FieldTotal>;
FieldTotals no_totals();
void add_report(FieldTotals&, int frame, const StepReport&);

// By the name of the field; throws Error for a name that no field has.
const FieldTotal& total_of(const FieldTotals&, std::string_view name);

// The value for the summary. Not for `by_word` and what is made by code of its own.
double value_of(const FieldTotal&, Over);

}  // namespace selvedge
