#include "pipeline/validate/validate.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/validate/validate_case.hpp"

namespace selvedge {
namespace {

using Lists = std::map<std::string, std::vector<std::string>>;

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    parts.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::vector<ValidationCase> chosen_cases(const std::vector<std::string>& names) {
  const std::vector<ValidationCase>& all = validation_cases();
  if (names.empty()) return all;
  refuse_unknown(names, names_of(all), "case", "validate", "cases");
  std::vector<ValidationCase> chosen;
  for (const std::string& name : names) chosen.push_back(*std::ranges::find(all, name, &ValidationCase::name));
  return chosen;
}

void check_value(const ValidationParameter& parameter, const std::string& value) {
  const std::string where = "--set " + parameter.name + "=" + value;
  if (!parameter.choices.empty()) {
    if (std::find(parameter.choices.begin(), parameter.choices.end(), value) == parameter.choices.end())
      throw Error("`" + value + "` is no value of " + parameter.name, where,
                  "allowed: " + joined(parameter.choices) + suggestion(value, parameter.choices));
    return;
  }
  std::size_t used = 0;
  double number = 0;
  try {
    number = std::stod(value, &used);
  } catch (const std::exception&) {
  }
  if (used == 0 || used != value.size())
    throw Error("`" + value + "` is not a number", where,
                "give " + parameter.name + " as a number: " + parameter.about);
  if (!parameter.range.has(number))
    throw Error(parameter.name + " is out of its range", where, "allowed: " + parameter.range.text());
}

// The values of every parameter of the cases, the command line's where it names one.
std::vector<Lists> value_lists(const std::vector<ValidationCase>& cases, const ValidateRequest& request) {
  std::vector<Lists> lists(cases.size());
  std::vector<std::string> known;
  for (std::size_t c = 0; c < cases.size(); ++c)
    for (const ValidationParameter& parameter : cases[c].parameters) {
      lists[c][parameter.name] = split(request.short_form ? parameter.brief : parameter.otherwise);
      if (std::find(known.begin(), known.end(), parameter.name) == known.end()) known.push_back(parameter.name);
    }
  for (const std::string& override : request.overrides) {
    const std::size_t equals = override.find('=');
    const std::string name = override.substr(0, equals);
    if (equals == std::string::npos)
      throw Error("`" + override + "` sets nothing", "--set", "write parameter=value or parameter=value,value");
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error("no chosen case has a parameter `" + name + "`", "--set " + override,
                  "parameters: " + joined(known) + suggestion(name, known));
    for (std::size_t c = 0; c < cases.size(); ++c)
      for (const ValidationParameter& parameter : cases[c].parameters) {
        if (parameter.name != name) continue;
        lists[c][name] = split(override.substr(equals + 1));
        for (const std::string& value : lists[c][name]) check_value(parameter, value);
      }
  }
  return lists;
}

// All combinations; the last parameter changes fastest.
std::vector<ValidationValues> combinations(const ValidationCase& one, const Lists& lists) {
  std::vector<ValidationValues> all(1);
  for (const ValidationParameter& parameter : one.parameters) {
    std::vector<ValidationValues> longer;
    for (const ValidationValues& so_far : all)
      for (const std::string& value : lists.at(parameter.name)) {
        longer.push_back(so_far);
        longer.back().all[parameter.name] = value;
      }
    all = std::move(longer);
  }
  return all;
}

std::string parameter_text(const ValidationCase& one, const ValidationValues& values) {
  std::string text;
  for (const ValidationParameter& parameter : one.parameters)
    text += (text.empty() ? "" : " ") + parameter.name + "=" + values.word(parameter.name);
  return text;
}

// The last row of the same quantity and the same parameters but for one, whose value is smaller.
const ValidationRow* coarser(const std::vector<ValidationRow>& rows, const ValidationRow& row, const std::string& but) {
  const auto own = row.values.find(but);
  if (own == row.values.end()) return nullptr;
  for (auto other = rows.rbegin(); other != rows.rend(); ++other) {
    if (other->name != row.name || other->quantity != row.quantity) continue;
    std::map<std::string, std::string> same = other->values;
    if (!(std::stod(same[but]) < std::stod(own->second))) continue;
    same[but] = own->second;
    if (same == row.values) return &*other;
  }
  return nullptr;
}

void judge(const Measured& found, const std::vector<ValidationRow>& rows, ValidationRow& row) {
  switch (found.judged) {
    case Judged::relative: {
      row.expected = found.expected;
      row.error = std::abs(found.measured - found.expected) / std::abs(found.expected);
      row.passed = *row.error <= found.bound;
      const ValidationRow* before = coarser(rows, row, "resolution");
      if (before && before->error && *before->error > 0 && *row.error > 0)
        row.order = std::log(*before->error / *row.error) /
                    std::log(std::stod(row.values.at("resolution")) / std::stod(before->values.at("resolution")));
      return;
    }
    case Judged::at_most:
      row.passed = found.measured <= found.bound;
      return;
    case Judged::at_least:
      row.passed = found.measured >= found.bound;
      return;
    case Judged::rises: {
      const ValidationRow* before = rows.empty() || rows.back().name != row.name ? nullptr : &rows.back();
      row.passed = !before || found.measured - before->measured >= found.bound;
      return;
    }
  }
}

std::string log_line(const ValidationRow& row) {
  const std::string expected =
      row.expected ? fmt::format(", expected {:.5g}, {:.2f} % off", *row.expected, 100 * *row.error) : "";
  return fmt::format("{} {}: {} {:.5g}{}: {} ({:.1f} s)\n", row.name, row.parameters, row.quantity, row.measured,
                     expected,
                     !row.counts  ? "shown"
                     : row.passed ? "passed"
                                  : "FAILED",
                     row.seconds);
}

}  // namespace

const std::vector<ValidationCase>& validation_cases() {
  static const std::vector<ValidationCase> all = [] {
    std::vector<ValidationCase> joined;
    for (const auto& some : {bending_cases(), shell_cases(), membrane_cases(), motion_cases(), turning_cases(),
                             friction_cases(), drape_cases()})
      joined.insert(joined.end(), some.begin(), some.end());
    return joined;
  }();
  return all;
}

std::vector<ValidationRow> validate(const ValidateRequest& request) {
  const std::vector<ValidationCase> cases = chosen_cases(request.cases);
  const std::vector<Lists> lists = value_lists(cases, request);
  make_folder(request.out);
  std::vector<ValidationRow> rows;
  for (std::size_t c = 0; c < cases.size(); ++c)
    for (ValidationValues& values : combinations(cases[c], lists[c])) {
      values.out = request.out;
      const Clock::time_point started = Clock::now();
      const std::vector<Measured> all = cases[c].run(values);
      const double seconds = seconds_since(started);
      for (const Measured& found : all) {
        ValidationRow row;
        row.name = cases[c].name;
        row.parameters = parameter_text(cases[c], values);
        row.values = values.all;
        row.quantity = found.quantity;
        row.measured = found.measured;
        row.judged = found.judged;
        row.bound = found.bound;
        row.counts = found.counts;
        row.seconds = seconds;
        judge(found, rows, row);
        rows.push_back(row);
        if (request.log) *request.log << log_line(row) << std::flush;
      }
      write_file(request.out / "validate.txt", validate_table(rows));
      write_file(request.out / "validate.csv", validate_csv(rows));
      write_file(request.out / "validate.json", validate_json(rows));
    }
  write_file(request.out / "validate.md", validate_markdown(rows));
  const std::string plots = plot_validation(rows, request.out);
  if (request.log) *request.log << plots << "\n";
  return rows;
}

bool passed(const std::vector<ValidationRow>& rows) {
  return std::ranges::all_of(rows, [](const ValidationRow& row) { return row.passed || !row.counts; }) &&
         std::ranges::any_of(rows, &ValidationRow::counts);
}

}  // namespace selvedge
