#include "pipeline/tools/ccd_queries.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

constexpr std::string_view form = "x_num,x_den,y_num,y_den,z_num,z_den,truth";
constexpr std::size_t rows_a_query = 8;

struct Place {
  const std::filesystem::path& file;
  int line = 0;

  [[noreturn]] void fail(const std::string& what, const std::string& cure) const {
    throw Error(what, fmt::format("{}:{}", file.string(), line), cure);
  }
};

std::vector<std::string_view> split_fields(std::string_view row) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = row.find(',');
    fields.push_back(row.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    row.remove_prefix(comma + 1);
  }
}

bool is_whole(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Whether `value` is exactly the number in `text`. Nineteen digits always fit.
bool is_exact(std::string_view text, long double value) {
  if (text.size() <= 19) return true;
  std::array<char, std::numeric_limits<long double>::max_exponent10 + 3> digits;
  const auto [end, problem] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, 0);
  return problem == std::errc() && std::string_view(digits.data(), end) == text;
}

// Extended range and precision are needed: the denominator of a small double can exceed the largest double.
long double read_whole(const Place& place, std::string_view text) {
  if (!is_whole(text)) place.fail(fmt::format("`{}` is not a whole number", text), fmt::format("rows are {}", form));
  long double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || !is_exact(text, value))
    place.fail(fmt::format("`{}` has more digits than can be read exactly", text),
               "give fractions in lowest terms of coordinates that are doubles");
  return value;
}

double read_coordinate(const Place& place, std::string_view numerator, std::string_view denominator) {
  const long double above = read_whole(place, numerator), below = read_whole(place, denominator);
  if (below == 0)
    place.fail(fmt::format("`{},{}` has denominator zero", numerator, denominator), "repair the fraction");
  const auto value = static_cast<double>(above / below);
  if (!std::isfinite(value) || std::fma(static_cast<long double>(value), below, -above) != 0)
    place.fail(fmt::format("{}/{} is not a double exactly", numerator, denominator),
               "give coordinates as doubles: the answer may change where they are rounded");
  return value;
}

struct Row {
  Vec3 node;
  bool truth = false;
  int line = 0;
};

Row read_row(const Place& place, std::string_view text) {
  const std::vector<std::string_view> fields = split_fields(text);
  if (fields.size() != 7)
    place.fail(fmt::format("has {} fields, not 7", fields.size()), fmt::format("rows are {}", form));
  if (fields[6] != "0" && fields[6] != "1") place.fail(fmt::format("truth is `{}`", fields[6]), "give 0 or 1");
  Row row{Vec3::Zero(), fields[6] == "1", place.line};
  for (int axis = 0; axis < 3; ++axis) row.node[axis] = read_coordinate(place, fields[2 * axis], fields[2 * axis + 1]);
  return row;
}

CcdQuery query_of(PairKind kind, const std::vector<Row>& r) {
  return {kind,
          {r[0].node, r[1].node, r[2].node, r[3].node},
          {r[4].node, r[5].node, r[6].node, r[7].node},
          r[0].truth,
          r[0].line};
}

PairKind kind_of(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw Error("there is no such file", file.string(), "check the path");
  for (auto folder = std::filesystem::absolute(file).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    if (folder.filename() == "edge-edge") return PairKind::edge_edge;
    if (folder.filename() == "vertex-face") return PairKind::vertex_face;
  }
  throw Error("the kind of these queries is unknown", file.string(),
              "put the file into a folder named edge-edge or vertex-face");
}

}  // namespace

std::vector<CcdQuery> read_ccd_queries(const std::filesystem::path& file) {
  const PairKind kind = kind_of(file);
  std::istringstream stream(read_text_file(file, "query"));
  std::vector<CcdQuery> queries;
  std::vector<Row> rows;
  Place place{file};
  for (std::string text; std::getline(stream, text);) {
    ++place.line;
    if (text.ends_with('\r')) text.pop_back();
    if (text.empty()) continue;
    rows.push_back(read_row(place, text));
    if (rows.back().truth != rows.front().truth)
      place.fail("truth is not that of the query's other rows", "give the same truth in all eight rows of a query");
    if (rows.size() < rows_a_query) continue;
    queries.push_back(query_of(kind, rows));
    rows.clear();
  }
  if (queries.empty() || !rows.empty())
    place.fail(fmt::format("ends after {} rows", rows_a_query * queries.size() + rows.size()),
               "give eight rows a query; some are missing or too many");
  return queries;
}

}  // namespace selvedge
