#include <catch2/catch.hpp>

#include <limits>
#include <nlohmann/json.hpp>

#include "pipeline/suites/bench.hpp"

namespace selvedge::test_bench_engine {

TEST_CASE("bench: the network engine has rows beside the peak of the same run", "[bench]") {
  const EngineTimings timings = time_engine(1, 300, 150);
  CHECK(timings.peak.flops > 0);
  REQUIRE(timings.rows.size() == 2);
  const EngineTiming &wide = timings.rows[0], &small = timings.rows[1];
  CHECK(wide.run.nodes == 300);
  CHECK(wide.run.edges == 1800);
  CHECK(wide.steps == 15);
  CHECK(wide.passes == 1);
  CHECK(small.network == "small");
  CHECK(small.run.nodes == 144);
  CHECK(small.passes == 2);
  CHECK(small.run.edges > 2 * (2 * 12 * 11 + 11 * 11));  // the mesh's, both ways, and coarse ones
  for (const EngineTiming& row : timings.rows) {
    CHECK(share_of_peak(timings, row) > 0);
    CHECK(busy_share_of_peak(timings, row) > 0);
  }
}

TEST_CASE("bench: shares of a peak that other work has lowered are void", "[bench]") {
  EngineTimings timings;
  timings.peak.flops = timings.peak.flops_busy = 100e9;
  timings.peak.share_of_ports = 0.86;
  timings.rows.push_back({"wide", 128, 15, 1, {}});
  timings.rows[0].run.operations = 50e9;
  timings.rows[0].run.seconds = 1;
  timings.rows[0].run.busy_seconds = 2;
  CHECK(share_of_peak(timings, timings.rows[0]) == Approx(0.5));
  CHECK(busy_share_of_peak(timings, timings.rows[0]) == Approx(0.25));
  CHECK(engine_table(timings).find("void") == std::string::npos);

  timings.peak.share_of_ports = 0.84;
  CHECK(is_void(timings.peak));
  CHECK(engine_table(timings).find("void") != std::string::npos);
  BenchResult result;
  result.engine = timings;
  const auto json = nlohmann::json::parse(bench_json(result));
  CHECK(json["engine"]["void"] == true);
  CHECK(json["engine"]["rows"].size() == 1);
  CHECK(bench_table(result) == engine_table(timings));  // parts that did not run leave nothing

  timings.peak.share_of_ports = std::numeric_limits<double>::quiet_NaN();
  CHECK(is_void(timings.peak));
}

}  // namespace selvedge::test_bench_engine
