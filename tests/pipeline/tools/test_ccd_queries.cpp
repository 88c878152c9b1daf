#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/tools/ccd_queries.hpp"
#include "pipeline/tools/ccd_report.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_ccd_queries {

namespace {

// A vertex that falls through a face, or stops above it.
std::string query(const std::string& end_height, int truth) {
  const std::string last = truth ? ",1\n" : ",0\n";
  const std::string face = "0,1,0,1,0,1" + last + "0,1,0,1,1,1" + last + "1,1,0,1,0,1" + last;
  return "1,4,1,1,1,4" + last + face + "1,4," + end_height + ",1,4" + last + face;
}

// The text with its line `number`, from 1, replaced; empty removes it.
std::string with_line(const std::string& text, int number, const std::string& line) {
  std::istringstream in(text);
  std::string out, each;
  for (int k = 1; std::getline(in, each); ++k)
    if (k != number)
      out += each + "\n";
    else if (!line.empty())
      out += line + "\n";
  return out;
}

std::filesystem::path write_queries(const fake::Folder& folder, const std::string& kind, const std::string& content) {
  std::filesystem::create_directories(folder.path / kind);
  return fake::write(folder, kind + "/queries.csv", content);
}

Error refused(const std::filesystem::path& file) {
  try {
    (void)read_ccd_queries(file);
  } catch (const Error& error) {
    return error;
  }
  FAIL("read without an error");
  return {"", "", ""};
}

}  // namespace

TEST_CASE("ccd queries: fractions are read exactly") {
  const fake::Folder folder("ccd_read");
  std::string text = query("-1,2", 1) + "\n" + query("1,9007199254740992", 0);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
  const auto queries = read_ccd_queries(write_queries(folder, "vertex-face", text));
  REQUIRE(queries.size() == 2);
  CHECK(queries[0].kind == PairKind::vertex_face);
  CHECK(queries[0].contact);
  CHECK(queries[0].line == 1);
  CHECK(queries[0].x0[0] == Vec3(0.25, 1, 0.25));
  CHECK(queries[0].x0[2] == Vec3(0, 0, 1));
  CHECK(queries[0].x1[0] == Vec3(0.25, -0.5, 0.25));
  CHECK(queries[0].x1[3] == Vec3(1, 0, 0));
  CHECK_FALSE(queries[1].contact);
  CHECK(queries[1].line == 10);
  CHECK(queries[1].x1[0].y() == 0x1p-53);
  CHECK(read_ccd_queries(write_queries(folder, "edge-edge", text))[1].kind == PairKind::edge_edge);
}

TEST_CASE("ccd queries: tiny and huge doubles") {
  const fake::Folder folder("ccd_extreme");
  const auto height = [&](double numerator, double denominator) {
    char digits[2000];
    std::snprintf(digits, sizeof digits, "%.0f,%.0Lf", numerator, std::ldexp(1.0L, static_cast<int>(denominator)));
    return read_ccd_queries(write_queries(folder, "vertex-face", query(digits, 0)))[0].x1[0].y();
  };
  CHECK(height(1e300, 0) == 1e300);
  CHECK(height(-6004799503160661, 109) == std::ldexp(-6004799503160661.0, -109));
  CHECK(height(6004799503160661, 1060) == std::ldexp(6004799503160661.0, -1060));
  CHECK(height(3, 1074) == 3 * std::numeric_limits<double>::denorm_min());
}

TEST_CASE("ccd queries: errors name file, line and cure") {
  const fake::Folder folder("ccd_errors");
  const std::string good = query("1,2", 0) + query("-1,2", 1);
  struct Case {
    std::string content, what;
    int line;
  };
  const std::string huge = std::string(60, '1');
  const Case cases[] = {
      {with_line(good, 11, "0,1,0,1,1,1"), "has 6 fields", 11},
      {with_line(good, 11, "0,1,0,1,1,1,1,1"), "has 8 fields", 11},
      {with_line(good, 2, "0,1,0.5,1,1,1,0"), "`0.5` is not a whole number", 2},
      {with_line(good, 2, "0,1,,1,1,1,0"), "`` is not a whole number", 2},
      {with_line(good, 2, "x_num,x_den,y_num,y_den,z_num,z_den,truth"), "truth is `truth`", 2},
      {with_line(good, 2, "0,1,0,1,1,0,0"), "denominator zero", 2},
      {with_line(good, 2, "0,1,0,1,1,3,0"), "1/3 is not a double exactly", 2},
      {with_line(good, 2, "0,1,0,1,9007199254740993,1,0"), "not a double exactly", 2},
      {with_line(good, 2, "0,1,0,1," + huge + ",1,0"), "more digits than", 2},
      {with_line(good, 2, "0,1,0,1,1,1,2"), "truth is `2`", 2},
      {with_line(good, 2, "0,1,0,1,1,1,1"), "not that of the query's other rows", 2},
      {with_line(good, 16, ""), "ends after 15 rows", 15},
      {"", "ends after 0 rows", 0},
  };
  for (const Case& each : cases) {
    const auto file = write_queries(folder, "vertex-face", each.content);
    const Error error = refused(file);
    INFO(each.what);
    CHECK(error.problem().find(each.what) != std::string::npos);
    CHECK(error.where() == file.string() + ":" + std::to_string(each.line));
    CHECK(error.cure() != "");
  }
  CHECK(refused(write_queries(folder, "point-point", good)).problem().find("kind") != std::string::npos);
  for (const char* where : {"vertex-face", "point-point"})
    CHECK(refused(folder.path / where / "absent.csv").problem() == "there is no such file");
  CHECK(refused(folder.path / "vertex-face").problem().find("kind") != std::string::npos);
}

TEST_CASE("ccd report: counts, degenerate ones apart, and what was answered wrongly") {
  const fake::Folder folder("ccd_report");
  // A contact, none, one that starts in the plane beside the face, and two whose truth is wrong on purpose.
  std::string in_plane = with_line(with_line(query("1,1", 0), 1, "-1,1,0,1,0,1,0"), 5, "-1,1,1,1,0,1,0");
  const auto file = write_queries(folder, "vertex-face",
                                  query("-1,2", 1) + query("1,2", 0) + in_plane + query("-1,4", 0) + query("1,4", 1));
  const CcdReport report = ccd_report({file});
  CHECK(report.files == 1);
  CHECK(report.all.queries == 5);
  CHECK(report.all.positives == 2);
  CHECK(report.all.false_negatives == 1);
  CHECK(report.all.false_positives == 1);
  CHECK(report.degenerate.queries == 1);
  CHECK(report.degenerate.positives == 0);
  CHECK(report.wrong == std::vector<std::string>{file.string() + ":33", file.string() + ":25"});
  CHECK(report.mean_us > 0);
  CHECK(report.max_us >= report.mean_us);
  CHECK_FALSE(is_clean(report));
  const auto json = nlohmann::json::parse(ccd_json(report));
  CHECK(json["queries"] == 5);
  CHECK(json["positives"] == 2);
  CHECK(json["false_negatives"] == 1);
  CHECK(json["false_positives"] == 1);
  CHECK(json["degenerate"] == 1);
  CHECK(json["mean_us"].is_number());
  CHECK(json["max_us"].is_number());
  CHECK(ccd_text(report).find("5 queries, 2 positives: 1 false negatives") != std::string::npos);
}

TEST_CASE("ccd report: queries with exact truth", "[data]") {
  const std::filesystem::path folder = fake::open_data() / "ccd";
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no queries with exact truth in " << folder << " (set SELVEDGE_DATA)");
    return;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  const CcdReport report = ccd_report(files);
  INFO(ccd_text(report));
  CHECK(report.all.queries > 1000);
  CHECK(report.all.positives > 0);
  CHECK(report.degenerate.queries > 0);
  CHECK(report.all.false_negatives == 0);
  CHECK(report.all.false_positives == 0);
}

}  // namespace selvedge::test_ccd_queries
