#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "pipeline/suites/bench.hpp"

namespace selvedge::test_bench_training {

TEST_CASE("bench: steps of training are timed, and without libtorch the row says so", "[bench]") {
  const TrainingTiming timing = time_training("tiny", 9, 2, 2, "nowhere/libselvedge_torch.so");
  CHECK(timing.nodes == 81);
  CHECK(timing.edges > 400);
  CHECK(timing.threads == 2);
  CHECK(timing.fused.wall > timing.forward.wall);
  CHECK(timing.forward.wall > 0);
  CHECK_FALSE(timing.with_torch);
  const std::string table = training_table({timing});
  CHECK(table.find("tiny") != std::string::npos);
  CHECK(table.find("libtorch's part cannot be loaded") != std::string::npos);
  BenchResult result;
  result.training = {timing};
  const auto json = nlohmann::json::parse(bench_json(result));
  CHECK(json["training"][0]["nodes"] == 81);
  CHECK_FALSE(json["training"][0].contains("libtorch_step_ms"));
  CHECK(bench_table(result) == table);
}

}  // namespace selvedge::test_bench_training
