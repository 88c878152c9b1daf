#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "pipeline/compare/compare.hpp"
#include "pipeline/hdf5/hdf5_handles.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/version.hpp"

namespace selvedge {
namespace {

struct Column {
  const char* name;    // in files
  const char* title;   // in the table
  const char* format;  // in the table
  double (*value)(const CompareRow&);
};

double if_it_ran(const CompareRow& row, double value) { return std::isfinite(row.ms) ? value : unknown; }

const std::vector<Column>& columns() {
  using R = const CompareRow&;
  static const std::vector<Column> all{
      {"dt", "dt [s]", "{:.2g}", [](R r) { return r.dt; }},
      {"ms", "ms", "{:.1f}", [](R r) { return r.ms; }},
      {"ms_spread", "+-", "{:.1f}", [](R r) { return r.ms_spread; }},
      {"algebraic", "algebraic", "{:.2g}", [](R r) { return r.algebraic; }},
      {"algebraic_largest", "largest", "{:.2g}", [](R r) { return r.algebraic_largest; }},
      {"temporal", "temp. [m]", "{:.3g}", [](R r) { return r.temporal; }},
      {"floor", "floor [m]", "{:.2g}", [](R r) { return r.floor; }},
      {"ranked", "ranked", "{}", [](R r) { return double(r.ranked); }},
      {"front", "front", "{}", [](R r) { return double(r.front); }},
      {"decay", "decay", "{:.3f}", [](R r) { return r.decay; }},
      {"newton", "Newton", "{:.1f}", [](R r) { return r.newton; }},
      {"linear", "linear", "{:.1f}", [](R r) { return r.linear; }},
      {"pairs", "pairs", "{:.0f}", [](R r) { return if_it_ran(r, double(r.pairs)); }},
      {"passed_through", "through", "{:.0f}", [](R r) { return if_it_ran(r, double(r.passed_through)); }},
      {"reproduced", "same bits", "{}", [](R r) { return if_it_ran(r, r.reproduced); }}};
  return all;
}

std::string share_cell(const CompareRow& row) {
  return row.measures.contains("proposal_share") ? fmt::format("{:.2f}", row.measure("proposal_share")) : "";
}

std::string table_cell(const Column& column, const CompareRow& row) {
  const double value = column.value(row);
  if (std::isnan(value)) return "";
  const std::string format = column.format;
  return format == "{}" ? (value != 0 ? "yes" : "no") : fmt::format(fmt::runtime(format), value);
}

Json floor_json(const CompareFloor& f) {
  return {{"scene", f.scene},     {"vertices", f.vertices}, {"frames", f.frames}, {"states", f.states},
          {"horizon", f.horizon}, {"motion", f.motion},     {"steps", f.steps},   {"jittered", f.jittered},
          {"floor", f.floor()},   {"lost", f.lost}};
}

Json row_json(const CompareRow& row) {
  Json json = {{"scene", row.scene}, {"setting", row.setting}};
  for (const Column& column : columns()) json[column.name] = number_or_null(column.value(row));
  for (const auto& [name, value] : row.measures) json[name] = number_or_null(value);
  json["pairs_by_frame"] = row.pairs_by_frame;
  json["trouble"] = row.trouble;
  json["machine"] = row.machine;
  return json;
}

// As a field of RFC 4180.
std::string quoted(const std::string& text) {
  std::string field(1, '"');
  for (const char c : text) field.append(c == '"' ? 2 : 1, c);
  field.push_back('"');
  return field;
}

}  // namespace

std::string compare_table(const CompareResult& result) {
  std::string text;
  std::map<std::string, std::string> machines;  // of scenes
  std::set<std::string> different;
  for (const CompareRow& row : result.rows) different.insert(machines[row.scene] = row.machine);
  for (const CompareFloor& f : result.floors) {
    text += fmt::format("{}: {} vertices, {} frames", f.scene, f.vertices, f.frames);
    text += f.states == 0 ? std::string("\n")
                          : fmt::format(
                                "; {} common states, {} frames from each\n"
                                "  the reference moves {:.3g} m in that; floor {:.2g} m (dt/8 against dt/16 {:.2g}, "
                                "jittered {:.2g}); it loses "
                                "{:.3g} J in all\n",
                                f.states, f.horizon, f.motion, f.floor(), f.steps, f.jittered, f.lost);
    if (different.size() > 1)
      text += fmt::format("  timed on {}; times of other machines are not ranked with these\n", machines[f.scene]);
    text += fmt::format("  {:<24}", "setting");
    for (const Column& column : columns()) text += fmt::format(" {:>10}", column.title);
    text += fmt::format(" {:>10}\n", "share");
    for (const CompareRow& row : result.rows) {
      if (row.scene != f.scene) continue;
      text += fmt::format("  {:<24}", row.setting);
      for (const Column& column : columns()) text += fmt::format(" {:>10}", table_cell(column, row));
      text += fmt::format(" {:>10}  {}\n", share_cell(row), row.trouble);
    }
    text += "\n";
  }
  return text;
}

std::string compare_csv(const CompareResult& result) {
  std::string text = "scene,setting";
  for (const Column& column : columns()) text += std::string(",") + column.name;
  std::set<std::string> measures;
  for (const CompareRow& row : result.rows)
    for (const auto& [name, value] : row.measures) measures.insert(name);
  for (const std::string& name : measures) text += "," + name;
  text += ",trouble,machine\n";
  for (const CompareRow& row : result.rows) {
    text += fmt::format("{},{}", quoted(row.scene), quoted(row.setting));
    const auto add = [&](double value) { text += std::isfinite(value) ? fmt::format(",{:.9g}", value) : ","; };
    for (const Column& column : columns()) add(column.value(row));
    for (const std::string& name : measures) add(row.measure(name));
    text += fmt::format(",{},{}\n", quoted(row.trouble), quoted(row.machine));
  }
  return text;
}

std::string compare_json(const CompareResult& result) {
  return json_text({{"program_version", program_version()},
                    {"finished", result.finished},
                    {"scenes", json_list(result.floors, floor_json)},
                    {"rows", json_list(result.rows, row_json)}});
}

namespace {

void fill_compare_hdf5(const h5::File& file, const CompareResult& result) {
  const h5::Handle rows = file.make_group("rows"), scenes = file.make_group("scenes");
  const auto write_texts = [&file](const std::string& place, const auto& all, auto member) {
    std::vector<std::string> texts;
    for (const auto& one : all) texts.push_back(one.*member);
    file.write_texts(place, texts);
  };
  const auto write_numbers = [&file](const std::string& place, const auto& all, auto value) {
    std::vector<double> numbers;
    for (const auto& one : all) numbers.push_back(std::invoke(value, one));
    file.write_constant(place, H5T_NATIVE_DOUBLE, {numbers.size()}, numbers.data());
  };
  file.write_text("program_version", program_version());
  write_texts("rows/scene", result.rows, &CompareRow::scene);
  write_texts("rows/setting", result.rows, &CompareRow::setting);
  write_texts("rows/trouble", result.rows, &CompareRow::trouble);
  for (const Column& column : columns()) write_numbers(std::string("rows/") + column.name, result.rows, column.value);
  write_texts("scenes/scene", result.floors, &CompareFloor::scene);
  write_numbers("scenes/motion", result.floors, &CompareFloor::motion);
  write_numbers("scenes/steps", result.floors, &CompareFloor::steps);
  write_numbers("scenes/jittered", result.floors, &CompareFloor::jittered);
  write_numbers("scenes/lost", result.floors, &CompareFloor::lost);
}

}  // namespace

void write_compare_hdf5(const std::filesystem::path& path, const CompareResult& result) {
  h5::write_whole(path, [&](const h5::File& file) { fill_compare_hdf5(file, result); });
}

}  // namespace selvedge
