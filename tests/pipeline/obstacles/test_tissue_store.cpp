#include <catch2/catch.hpp>

#include <fstream>

#include "pipeline/host/bounded_folder.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/tools/plan.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_tissue_store {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Setup walker(const Folder& folder, const std::string& more = "") {
  return read_setup(fake::write(folder, "scene.yaml",
                                "cloths:\n  - {rectangle: {size: [0.3, 0.3], resolution: 3}, translate: [0, 3, 0]}\n"
                                "obstacles:\n  - name: person\n    body: {model: mannequin, clip: walk" +
                                    more + "}\nrun: {frames: 3}\n"));
}

constexpr std::array<double, 3> times{0.8, 1.0, 1.2};

std::vector<Points> poses(const Setup& setup) {
  std::vector<Points> all;
  for (const double time : times) all.push_back(setup.drive_at(time).obstacles.at(0));
  return all;
}

// The poses of a run that keeps its soft tissue in the folder, and how many it computed.
std::pair<std::vector<Points>, int> kept_poses(const Folder& folder, const std::string& more = "") {
  const Setup setup = walker(folder, more);
  const PosedBodies& body = *setup.bodies.at(0);
  read_tissue(folder.path, setup.bodies);
  const int before = body.poses;
  std::vector<Points> all = poses(setup);
  write_tissue(setup.bodies);
  return {std::move(all), body.poses - before};
}

std::filesystem::path only_file(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::directory_entry> files{std::filesystem::directory_iterator(folder), {}};
  REQUIRE(files.size() == 1);
  return files[0].path();
}

}  // namespace

TEST_CASE("Soft tissue: a second run computes none, and has the same bits", "[tissue_store]") {
  const Folder folder("tissue_twice");
  const std::vector<Points> without = poses(walker(folder));
  CHECK(without[1] != without[2]);
  const auto [first, computed] = kept_poses(folder);
  CHECK(computed == 3);
  CHECK(first == without);
  const auto [second, computed_again] = kept_poses(folder);
  CHECK(computed_again == 0);
  CHECK(second == without);
}

TEST_CASE("Soft tissue: another room or clip has a store of its own", "[tissue_store]") {
  const Folder folder("tissue_rooms");
  kept_poses(folder);
  const auto [wider, computed] = kept_poses(folder, ", room: 2 cm");
  CHECK(computed == 3);
  CHECK(wider == poses(walker(folder, ", room: 2 cm")));
  CHECK(kept_poses(folder, ", first_frame: 1").second > 0);
  CHECK(kept_poses(folder).second == 0);
}

TEST_CASE("Soft tissue: a store that cannot be read is computed anew", "[tissue_store]") {
  const Folder folder("tissue_broken");
  const std::vector<Points> whole = kept_poses(folder).first;
  const std::filesystem::path file = only_file(folder.path / "tissue");
  SECTION("cut short") { std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2); }
  SECTION("no HDF5 file") { std::ofstream(file) << "soft tissue"; }
  const auto [again, computed] = kept_poses(folder);
  CHECK(computed == 3);
  CHECK(again == whole);
  CHECK(kept_poses(folder).second == 0);
}

TEST_CASE("Soft tissue: the plan says what a pose costs, and how to leave it out", "[tissue_store][plan]") {
  const Folder folder("tissue_plan");
  CHECK_THAT(plan_text(walker(folder)), Contains("in   soft tissue") && Contains("`person` leave 10 mm") &&
                                            Contains("ms a pose here; its `room: 0`"));
  CHECK_THAT(plan_text(walker(folder, ", room: 0")), Contains("out  soft tissue"));
}

TEST_CASE("A bounded folder loses the files that were used longest ago", "[tissue_store]") {
  const Folder folder("bounded_folder");
  const auto now = std::filesystem::file_time_type::clock::now();
  for (int k = 0; k < 4; ++k) {
    const std::filesystem::path file = folder.path / (std::to_string(k) + ".h5");
    std::ofstream(file) << std::string(100, 'x');
    std::filesystem::last_write_time(file, now - std::chrono::hours(10 - k));
  }
  mark_used(folder.path / "0.h5");
  keep_within(folder.path, 250);
  CHECK(std::filesystem::exists(folder.path / "0.h5"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "1.h5"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "2.h5"));
  CHECK(std::filesystem::exists(folder.path / "3.h5"));
}

}  // namespace selvedge::test_tissue_store
