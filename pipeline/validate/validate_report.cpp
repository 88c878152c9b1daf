#include <fmt/format.h>

#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/validate/validate.hpp"

namespace selvedge {
namespace {

std::string number(const std::optional<double>& value, const char* format = "{:.5g}") {
  return value ? fmt::format(fmt::runtime(format), *value) : "";
}

// How rows are judged, by their number: the name, and a bound in its unit for people.
struct JudgedForm {
  const char *name, *bound;
  double unit;
};
constexpr JudgedForm judged_forms[]{
    {"relative", "{:g} %", 100}, {"at_most", "<= {:g}", 1}, {"at_least", ">= {:g}", 1}, {"rises", "rises by {:g}", 1}};

const JudgedForm& form_of(const ValidationRow& row) { return judged_forms[static_cast<std::size_t>(row.judged)]; }

// A row by a format whose arguments are those of validate_markdown, in its order.
std::string row_text(const char* format, const ValidationRow& row) {
  return fmt::format(fmt::runtime(format), row.name, row.parameters, row.quantity, row.measured, number(row.expected),
                     row.error ? fmt::format("{:.2f} %", 100 * *row.error) : "",
                     fmt::format(fmt::runtime(form_of(row).bound), form_of(row).unit * row.bound),
                     number(row.order, "{:.1f}"),
                     !row.counts  ? "shown"
                     : row.passed ? "pass"
                                  : "FAIL");
}

}  // namespace

std::string validate_table(const std::vector<ValidationRow>& rows) {
  std::string text = fmt::format("{:<11} {:<22} {:>10} {:>10} {:>9} {:>14} {:>6} {:<6} {}\n", "case", "quantity",
                                 "measured", "expected", "error", "bound", "order", "", "parameters");
  int counted = 0, failed = 0;
  double seconds = 0;
  const ValidationRow* before = nullptr;
  for (const ValidationRow& row : rows) {
    text += row_text("{0:<11} {2:<22} {3:>10.5g} {4:>10} {5:>9} {6:>14} {7:>6} {8:<6} {1}\n", row);
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
  for (const ValidationRow& row : rows) text += row_text("| {} | {} | {} | {:.5g} | {} | {} | {} | {} | {} |\n", row);
  return text;
}

std::string validate_csv(const std::vector<ValidationRow>& rows) {
  std::string text = "case,parameters,quantity,measured,expected,judged,bound,error,order,counts,passed,seconds\n";
  for (const ValidationRow& row : rows)
    text += fmt::format("{},{},{},{:.9g},{},{},{:g},{},{},{},{},{:.3f}\n", row.name, row.parameters, row.quantity,
                        row.measured, number(row.expected, "{:.9g}"), form_of(row).name, row.bound,
                        number(row.error, "{:.6g}"), number(row.order, "{:.3f}"), row.counts, row.passed, row.seconds);
  return text;
}

std::string validate_json(const std::vector<ValidationRow>& rows) {
  Json list = Json::array();
  for (const ValidationRow& row : rows)
    list.push_back({{"case", row.name},
                    {"parameters", row.values},
                    {"quantity", row.quantity},
                    {"measured", row.measured},
                    {"expected", number_or_null(row.expected)},
                    {"judged", form_of(row).name},
                    {"bound", row.bound},
                    {"error", number_or_null(row.error)},
                    {"order", number_or_null(row.order)},
                    {"counts", row.counts},
                    {"passed", row.passed},
                    {"seconds", row.seconds}});
  return json_text({{"program_version", program_version()}, {"passed", passed(rows)}, {"rows", list}});
}

}  // namespace selvedge
