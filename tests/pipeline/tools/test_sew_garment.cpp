#include "pipeline/tools/sew_garment.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_sew_garment {

using Catch::Matchers::Contains;

namespace {

// A skirt of two panels of those widths at hem and waist, from the knee to the waist [cm].
std::string skirt(int hem, int waist) {
  const auto panel = [&](const std::string& name, int z, int turn) {
    const std::string h = std::to_string(hem), w = std::to_string(waist);
    return "\"" + name + "\":{\"translation\":[0,62," + std::to_string(z) + "],\"rotation\":[0," +
           std::to_string(turn) + ",0],\"vertices\":[[-" + h + ",0],[" + h + ",0],[" + w + ",40],[-" + w +
           ",40]],\"edges\":[{\"endpoints\":[0,1]},{\"endpoints\":[1,2]},{\"endpoints\":[2,3]},{\"endpoints\":[3,0]}]}";
  };
  return "{\"pattern\":{\"panels\":{" + panel("front", 25, 0) + "," + panel("back", -25, 180) +
         R"(},"stitches":[[{"panel":"front","edge":1},{"panel":"back","edge":3}],)"
         R"([{"panel":"front","edge":3},{"panel":"back","edge":1}]]},"properties":{"units_in_meter":100}})";
}

PatternReport sewn(const fake::Folder& folder, int hem, int waist) {
  PatternRequest request;
  request.file = fake::write(folder, "skirt.json", skirt(hem, waist));
  request.out = folder.path / "skirt.obj";
  request.edge = 0.08;
  return sew_garment(request);
}

}  // namespace

TEST_CASE("A skirt is sewn round the mannequin's hips, whose origin is not at its soles", "[sew_garment]") {
  const fake::Folder folder("sewn_skirt");
  const PatternReport report = sewn(folder, 30, 22);
  CHECK(report.raised == Approx(0.94).margin(0.02));
  // It hangs on the hips: the mannequin's joints of the legs are 3 cm below its origin.
  CHECK(report.sewn.x.col(1).maxCoeff() < 0.2);
  CHECK(report.sewn.x.col(1).maxCoeff() > -0.1);
  CHECK(report.sewn.watch.left_in == -1);
}

TEST_CASE("A skirt that is too wide has slid off, which is said with the frame", "[sew_garment]") {
  const fake::Folder folder("sewn_wide");
  const PatternReport report = sewn(folder, 36, 36);
  CHECK(report.sewn.watch.left_in > report.sewn.closing_frames);
  CHECK(report.sewn.watch.left_in < report.sewn.closing_frames + report.sewn.draping_frames + 10);
  CHECK_FALSE(is_clean(report));
  CHECK_THAT(pattern_text(report), Contains("`skirt` has slid off its body") && Contains("in frame"));
}

TEST_CASE("A pattern in another unit is told by its size, and errors name its file", "[sew_garment]") {
  const fake::Folder folder("sewn_unit");
  const auto cut_in = [&](const std::string& unit) {
    std::string text = skirt(30, 22);
    text.replace(text.find("\"units_in_meter\":100"), 20, "\"units_in_meter\":" + unit);
    PatternRequest request;
    request.file = fake::write(folder, "skirt.json", text);
    request.out = folder.path / "skirt.obj";
    request.flat = true;
    return sew_garment(request).warnings;
  };
  CHECK(cut_in("100").empty());
  CHECK_THAT(fake::lines(cut_in("10000")), Contains("`front`, spans 0.00721 m") && Contains("units_in_meter"));
  const std::string told = testing::refusal([&] { cut_in("1"); });
  CHECK_THAT(told,
             Contains("skirt.json: panel `front`") && Contains("2000 are the most") && Contains("units_in_meter"));
}

TEST_CASE("A pattern whose stitches never closed is not good, however well it lies", "[sew_garment]") {
  PatternReport report;
  report.stitches = 40;
  report.sewn.moving_share = 0;
  report.sewn.watch.part.places.push_back({});
  CHECK(is_clean(report));
  report.open_stitches = 7;
  report.largest_gap = 0.077;
  CHECK_FALSE(is_clean(report));
  REQUIRE(faults_of(report).size() == 1);
  CHECK_THAT(faults_of(report)[0], Contains("7 of 40 stitches never closed, 77 mm apart at most"));
}

TEST_CASE("A skirt that is too narrow to close round the body is not good", "[sew_garment][.long]") {
  const fake::Folder folder("sewn_narrow");
  const PatternReport report = sewn(folder, 12, 8);
  CHECK(report.open_stitches > 0);
  CHECK(report.largest_gap > 5e-3);
  CHECK_FALSE(is_clean(report));
  CHECK_THAT(pattern_text(report), Contains("never closed"));
}

TEST_CASE("Patterns of other people that lie nowhere are refused or said to be off", "[sew_garment][.long]") {
  const std::filesystem::path cases = fake::open_data() / ".." / "cases" / "pattern_result";
  if (!std::filesystem::exists(cases)) {
    WARN("skipped: there is no " << cases);
    return;
  }
  const fake::Folder folder("pattern_cases");
  PatternRequest request;
  request.body = (cases / "body.obj").string();
  request.out = folder.path / "o.h5";
  request.edge = 0.04;
  request.file = cases / "nounit.json";
  CHECK_THROWS_WITH(sew_garment(request), Contains("units_in_meter"));
  request.file = cases / "skirt.json";
  const PatternReport report = sew_garment(request);
  CHECK_FALSE(is_clean(report));
  CHECK_THAT(pattern_text(report), Contains("has slid off"));
}

}  // namespace selvedge::test_sew_garment
