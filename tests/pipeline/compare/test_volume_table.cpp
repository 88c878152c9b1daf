#include <catch2/catch.hpp>

#include "pipeline/compare/volume_table.hpp"

namespace selvedge::test_volume_table {

namespace {

VolumeSequence sequence(const std::string& row, const std::string& name, std::vector<double> losses) {
  VolumeSequence s{row, "tshirt", name, {}, 20};
  for (const double loss : losses) s.found.volume_by_frame.push_back(loss / 1.8e5);
  s.found.loss_by_frame = std::move(losses);
  s.found.pairs = 6;
  s.found.contours = 4;
  s.found.enclosed = 2;
  s.found.not_orientable = s.found.unassigned = 1;
  return s;
}

}  // namespace

TEST_CASE("volume table: means over sequences, shares of frames, and how a row stands to the baseline", "[tools]") {
  std::vector<VolumeSequence> all;
  for (int k = 0; k < 16; ++k) {
    const double a = 0.05 + 0.1 * (k % 4);
    all.push_back(sequence("hood", std::to_string(k), {a, 0.2}));
    all.push_back(sequence("senc", std::to_string(k), {0, 0.5 * (a + 0.2) / 2}));
  }
  all.push_back(sequence("senc", "alone", {0, 0}));
  const std::vector<VolumeSummary> summaries = volume_summaries(all, "hood", 500);
  REQUIRE(summaries.size() == 2);
  const VolumeSummary &hood = summaries[0], &senc = summaries[1];
  CHECK(hood.row == "hood");
  CHECK(hood.sequences == 16);
  CHECK(hood.frames == 32);
  CHECK(hood.loss.mean == Approx(0.2));
  CHECK(hood.loss.low < 0.2);
  CHECK(hood.loss.high > 0.2);
  CHECK(hood.loss.high - hood.loss.low < 0.1);
  CHECK(hood.above_tenth.mean == Approx(0.5 + 0.5 * 0.75));
  CHECK(hood.above_hundredth.mean == 1);
  CHECK(hood.volume.mean == Approx(0.2 / 1.8e5));
  CHECK(hood.pairs.mean == 3);
  CHECK(hood.unassigned.mean == 1);
  CHECK(hood.ratio.mean == Approx(1));
  CHECK(hood.loss_as_published.mean == hood.loss.mean);
  // The sequence that the baseline lacks takes no part in the ratio.
  CHECK(senc.sequences == 17);
  CHECK(senc.ratio.mean == Approx(0.254).margin(0.005));
  CHECK(senc.ratio.high < 1);
  CHECK(volume_table(summaries, "hood").find("senc") != std::string::npos);
  CHECK(volume_summaries(all, "hood", 500)[1].loss.low == senc.loss.low);
  CHECK(volume_by_frame_csv(all, "tshirt").substr(0, 16) == "frame,hood,senc\n");
  CHECK(volume_summaries({}, "hood").empty());
}

TEST_CASE("volume table: the start and the fans at rest count as published alone", "[tools]") {
  VolumeSequence one = sequence("senc", "one", {0.47, 0.022, 0.03, 0.01});
  one.found.first_made = 1;
  one.found.of_fans = 0.022;
  CHECK(one.found.net_losses() == std::vector<double>{0, 0.03 - 0.022, 0});
  CHECK(one.found.share_above(0.005) == Approx(1.0 / 3));
  const VolumeSummary summary = volume_summaries({one}, "senc", 10)[0];
  CHECK(summary.loss.mean == Approx(0.008 / 3));
  CHECK(summary.loss_as_published.mean == Approx(0.133));
}

}  // namespace selvedge::test_volume_table
