#include <fmt/format.h>

#include <cmath>

#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/validate/validate.hpp"

namespace selvedge {
namespace {

std::string number(const std::optional<double>& value, const char* format = "{:.5g}") {
  return value ? fmt::format(fmt::runtime(format), *value) : "";
}

std::string error_text(const ValidationRow& row) {
  if (!row.error) return "";
  return row.judged == Judged::relative ? fmt::format("{:.2f} %", 100 * *row.error) : fmt::format("{:.4f}", *row.error);
}

std::string bound_text(const ValidationRow& row) {
  switch (row.judged) {
    case Judged::relative:
      return fmt::format("{:g} %", 100 * row.bound);
    case Judged::absolute:
      return fmt::format("{:g}", row.bound);
    case Judged::at_most:
      return fmt::format("<= {:g}", row.bound);
    case Judged::at_least:
      return fmt::format(">= {:g}", row.bound);
    case Judged::rises:
      return fmt::format("rises by {:g}", row.bound);
  }
  return "";
}

std::string verdict(const ValidationRow& row) { return !row.counts ? "shown" : row.passed ? "pass" : "FAIL"; }

const char* judged_name(Judged judged) {
  switch (judged) {
    case Judged::relative:
      return "relative";
    case Judged::absolute:
      return "absolute";
    case Judged::at_most:
      return "at_most";
    case Judged::at_least:
      return "at_least";
    case Judged::rises:
      return "rises";
  }
  return "";
}

}  // namespace

std::string validate_table(const std::vector<ValidationRow>& rows) {
  std::string text = fmt::format("{:<11} {:<22} {:>10} {:>10} {:>9} {:>14} {:>6} {:<6} {}\n", "case", "quantity",
                                 "measured", "expected", "error", "bound", "order", "", "parameters");
  int counted = 0, failed = 0;
  double seconds = 0;
  const ValidationRow* before = nullptr;
  for (const ValidationRow& row : rows) {
    text += fmt::format("{:<11} {:<22} {:>10.5g} {:>10} {:>9} {:>14} {:>6} {:<6} {}\n", row.name, row.quantity,
                        row.measured, number(row.expected), error_text(row), bound_text(row),
                        number(row.order, "{:.1f}"), verdict(row), row.parameters);
    counted += row.counts;
    failed += row.counts && !row.passed;
    if (!before || before->parameters != row.parameters || before->name != row.name) seconds += row.seconds;
    before = &row;
  }
  if (counted == 0) return text + "nothing was judged: no value that was asked for has a bound\n";
  return text + fmt::format("{} of {} within their bounds, {:.0f} s\n", counted - failed, counted, seconds);
}

std::string validate_markdown(const std::vector<ValidationRow>& rows) {
  std::string text =
      "| case | parameters | quantity | measured | expected | error | bound | order | "
      "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const ValidationRow& row : rows)
    text += fmt::format("| {} | {} | {} | {:.5g} | {} | {} | {} | {} | {} |\n", row.name, row.parameters, row.quantity,
                        row.measured, number(row.expected), error_text(row), bound_text(row),
                        number(row.order, "{:.1f}"), verdict(row));
  return text;
}

std::string validate_csv(const std::vector<ValidationRow>& rows) {
  std::string text = "case,parameters,quantity,measured,expected,judged,bound,error,order,counts,passed,seconds\n";
  for (const ValidationRow& row : rows)
    text += fmt::format("{},{},{},{:.9g},{},{},{:g},{},{},{},{},{:.3f}\n", row.name, row.parameters, row.quantity,
                        row.measured, number(row.expected, "{:.9g}"), judged_name(row.judged), row.bound,
                        number(row.error, "{:.6g}"), number(row.order, "{:.3f}"), row.counts, row.passed, row.seconds);
  return text;
}

std::string validate_json(const std::vector<ValidationRow>& rows) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const ValidationRow& row : rows)
    list.push_back({{"case", row.name},
                    {"parameters", row.values},
                    {"quantity", row.quantity},
                    {"measured", row.measured},
                    {"expected", number_or_null(row.expected)},
                    {"judged", judged_name(row.judged)},
                    {"bound", row.bound},
                    {"error", number_or_null(row.error)},
                    {"order", number_or_null(row.order)},
                    {"counts", row.counts},
                    {"passed", row.passed},
                    {"seconds", row.seconds}});
  return json_text({{"program_version", program_version()}, {"passed", passed(rows)}, {"rows", list}});
}

}  // namespace selvedge
