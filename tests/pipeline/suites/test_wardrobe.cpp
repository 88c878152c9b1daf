#include <catch2/catch.hpp>

#include <sstream>

#include "collision/geometry/error.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "pipeline/suites/wardrobe.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_wardrobe {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// What is worn through the first frames of clips, and the body's way into them.
WardrobeRequest short_form(const Folder& folder) {
  WardrobeRequest request;
  request.configs = source_root() / "configs";
  request.wear = {"tshirt"};
  request.clips = {"walk"};
  request.most_frames = 10;
  request.out = folder.path / "wardrobe";
  return request;
}

}  // namespace

TEST_CASE("A garment comes down from the T-pose and walks clean; its row is kept", "[wardrobe]") {
  const Folder folder("wardrobe");
  WardrobeRequest request = short_form(folder);
  Stopwatch watch;
  const std::vector<WardrobeRow> rows = wardrobe(request);
  const double all = watch.lap();
  REQUIRE(rows.size() == 1);
  const WardrobeRow& row = rows[0];
  CHECK(row.passed());
  CHECK(row.frames == 40);  // a second to come down
  CHECK(row.excused_frames == 0);
  CHECK(row.vertices > 700);
  CHECK_FALSE(row.kept);
  CHECK(row.seconds >= 1e-3 * row.milliseconds);
  CHECK(row.seconds <= all);
  CHECK(std::filesystem::exists(request.out / "wardrobe.csv"));
  CHECK(std::filesystem::exists(request.out / "tshirt" / "walk" / "view.html"));

  std::ostringstream log;
  request.log = &log;
  CHECK(wardrobe(request).at(0).kept);
  CHECK_THAT(log.str(), Contains("tshirt walk: passed"));
  CHECK_THAT(wardrobe_table(rows), Contains("tshirt") && Contains("1 of 1 rows passed"));
}

TEST_CASE("What an outfit goes through does not depend on the garments before it", "[wardrobe][.long]") {
  const Folder folder("wardrobe_shared");
  WardrobeRequest request = short_form(folder);
  request.most_frames = 1;
  request.wear = {"training_layers"};
  const WardrobeRow alone = wardrobe(request).at(0);
  request.wear = {"shorts", "training_layers"};
  request.out = folder.path / "after";
  const WardrobeRow after = wardrobe(request).at(1);
  CHECK(after.wear == "training_layers");
  CHECK(after.max_stretch == alone.max_stretch);
}

TEST_CASE("Rows of the wardrobe survive being written, and fail for each thing that may not be", "[wardrobe]") {
  WardrobeRow row;
  row.wear = "skirt";
  row.frames = 3;
  row.failures = {"rejected in frame 3: why"};
  const auto read = read_wardrobe_row(wardrobe_row_json(row));
  REQUIRE(read);
  CHECK(read->wear == "skirt");
  CHECK(read->failures == row.failures);
  CHECK_FALSE(read->passed());
  CHECK_FALSE(read_wardrobe_row("{}"));
}

TEST_CASE("Names that nothing has are refused", "[wardrobe]") {
  const Folder folder("wardrobe_names");
  WardrobeRequest request = short_form(folder);
  request.wear = {"tshirts"};
  CHECK_THROWS_WITH(wardrobe(request), Contains("tank_top") && Contains("did you mean `tshirt`"));
  request = short_form(folder);
  request.clips = {"walking"};
  CHECK_THROWS_WITH(wardrobe(request), Contains("walking") && Contains("walk_slow"));
}

}  // namespace selvedge::test_wardrobe
