#include <catch2/catch.hpp>

#include "pipeline/shapes/sample_times.hpp"

namespace selvedge::test_sample_times {

using Catch::Matchers::Contains;

TEST_CASE("A time lies between two samples, and is held outside", "[sample_times]") {
  const SampleTimes times{{10, 10.5, 13}, 10};
  const auto at = [&](double time) {
    const auto [k, share] = place_of(times, time);
    return static_cast<double>(k) + share;
  };
  CHECK(times.first() == 1);
  CHECK(times.last() == Approx(1.3));
  CHECK(at(0) == 0);
  CHECK(at(1) == 0);
  CHECK(at(1.025) == Approx(0.5));
  CHECK(at(1.05) == Approx(1));
  CHECK(at(1.175) == Approx(1.5));
  CHECK(at(9) == 2);
  for (const double time : {-1.0, 0.0, 0.7, 1.3, 2.0}) {
    const SamplePlace one = place_of(steady(3, 2), time), other = steady_place(3, 2, time);
    CHECK((one.sample == other.sample && one.share == other.share));
  }
  SampleTimes moved = times;
  begin_at(0, moved);
  CHECK(moved.at == std::vector<double>{0, 0.5, 3});
}

TEST_CASE("Where samples begin late or end early is said", "[sample_times]") {
  std::vector<std::string> said;
  warn_of_begin("it", "do so", steady(3, 10), said);
  warn_of_begin("it", "do so", {{5}, 10}, said);  // does not move
  warn_of_end("it", 2, 30, 60, said);
  warn_of_end("it", 60 / 29.97, 29.97, 60, said);
  CHECK(said.empty());
  warn_of_begin("it", "do so", {{5, 6}, 10}, said);
  warn_of_begin("it", "do so", {{-5, 6}, 10}, said);
  warn_of_end("it", 1.99, 30, 90, said);
  REQUIRE(said.size() == 3);
  CHECK_THAT(said[0], Contains("begins at 0.5 s") && Contains("do so"));
  CHECK_THAT(said[1], Contains("0.5 s before time 0"));
  CHECK_THAT(said[2], Contains("ends at 1.99 s") && Contains("frame 60 of 90"));
}

}  // namespace selvedge::test_sample_times
