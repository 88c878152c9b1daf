#include "pipeline/reports/field_total.hpp"

#include <algorithm>
#include <array>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

void add(FieldTotal& total, int frame, double number) {
  total.sum += number;
  total.largest = std::max(total.largest, number);
  total.smallest = std::min(total.smallest, number);
  if (frame == 0) total.at_start = number;
  total.at_end = number;
  if (number == 0) return;
  ++total.frames;
  if (total.first_frame < 0) total.first_frame = frame;
  total.last_frame = frame;
}

}  // namespace

FieldTotals no_totals() { return FieldTotals(report_fields().size()); }

void add_report(FieldTotals& totals, int frame, const StepReport& report) {
  for (std::size_t k = 0; k < totals.size(); ++k) {
    const BoundField<StepReport>& field = report_fields()[k];
    const double number = number_of(field.get(report), field.words);
    add(totals[k], frame, number);
    if (field.type != ColumnType::word || number == 0) continue;
    totals[k].by_word.resize(field.words.size());
    ++totals[k].by_word[static_cast<std::size_t>(number)];
  }
}

const FieldTotal& total_of(const FieldTotals& totals, std::string_view name) {
  const auto found = std::ranges::find(report_fields(), name, &BoundField<StepReport>::name);
  if (found == report_fields().end())
    throw Error("is no field of a report", std::string(name), "pipeline/reports/report_fields.cpp lists them");
  return totals[static_cast<std::size_t>(found - report_fields().begin())];
}

double value_of(const FieldTotal& total, Over over) {
  const std::array values{total.sum,
                          total.largest,
                          total.smallest,
                          total.at_start,
                          total.at_end,
                          double(total.frames),
                          double(total.first_frame),
                          double(total.last_frame)};  // in the order of Over
  const auto k = static_cast<std::size_t>(over);
  return k < values.size() ? values[k] : 0;
}

}  // namespace selvedge
