#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "pipeline/suites/bench.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_bench_counts {

TEST_CASE("bench: counts of work a frame stand beside the times", "[bench]") {
  BenchMember member;
  member.scene = "drop";
  member.size = 40;
  for (const double seconds : {0.1, 0.4}) {
    Frame frame;
    frame.seconds = seconds;
    frame.report.status = StepStatus::accepted;
    frame.report.iterations = 14;
    frame.report.counts = {6, 10, 4, 3'000'000'000, 3};
    add_frame(member.summary, member.summary.frames + 1, frame);
  }
  BenchResult result;
  result.members.push_back(member);
  const auto json = nlohmann::json::parse(bench_json(result))["members"][0];
  CHECK(json["iterations"] == 14);
  CHECK(json["solves"] == 6);
  CHECK(json["coarse_builds"] == 10);
  CHECK(json["searches"] == 4);
  CHECK(json["candidates"] == 3'000'000'000);
  CHECK(json["audits"] == 3);
  CHECK(json["ms_worst"] == 400);
  CHECK(json["run"]["solves"] == 12);
}

TEST_CASE("bench: a scene that is not there is named before anything is timed", "[bench]") {
  const fake::Folder folder("bench_lost");
  BenchRequest request;
  request.scenes = {"lost"};
  request.configs = folder.path;
  request.out = folder.path / "out";
  CHECK_THROWS_WITH(bench(request), Catch::Contains("lost.yaml: there is no such scene"));
  CHECK_FALSE(std::filesystem::exists(request.out));
}

}  // namespace selvedge::test_bench_counts
