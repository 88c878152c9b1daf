#include <catch2/catch.hpp>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_time_of_files {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

const std::string sheet = "cloths: [{rectangle: {size: [0.1, 0.1], resolution: 2}, translate: [0, 9, 0]}]\n";

// One triangle at a height that is its frame's number [m].
void write_frame(const Folder& folder, int number) {
  Points x(3, 3);
  x << 0, number, 0, 0, number, 1, 1, number, 0;
  Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  write_obj(folder.path / ("f" + std::to_string(number) + ".obj"), x, triangles);
}

Setup with(const Folder& folder, const std::string& obstacle, const std::string& run = "{frames: 1}") {
  return read_setup(
      fake::write(folder, "scene.yaml", sheet + "obstacles:\n  - {name: slab, " + obstacle + "}\nrun: " + run + "\n"));
}

double height(const Setup& setup, double time) { return setup.drive_at(time).obstacles[0](0, 1); }

}  // namespace

TEST_CASE("A number that is missing in a sequence is named, and the others keep their times", "[time]") {
  const Folder folder("time_gap");
  for (const int number : {1, 2, 4, 5, 9}) write_frame(folder, number);
  const Setup setup = with(folder, "sequence: {pattern: f%d.obj, first: 1, fps: 10}");
  for (const double number : {1.0, 2.0, 3.0, 4.0, 4.5, 7.0, 9.0})
    CHECK(height(setup, (number - 1) / 10) == Approx(number));
  CHECK(height(setup, 7) == 9);
  CHECK_THAT(fake::lines(setup.warnings), Contains("4 of 9: f3.obj, f6.obj to f8.obj"));
  CHECK_THROWS_WITH(with(folder, "sequence: {pattern: f%d.obj, first: 1, count: 7, fps: 10}"),
                    Contains("asks for 7 files") && Contains("f5.obj is the last"));
  CHECK_THROWS_WITH(with(folder, "sequence: {pattern: f%d.obj, first: 3, fps: 10}"),
                    Contains("f3.obj") && Contains("first: 1"));
  CHECK_THROWS_WITH(with(folder, "sequence: {pattern: g%d.obj, fps: 10}"), Contains("g0.obj"));
  std::filesystem::copy_file(folder.path / "f1.obj", folder.path / "f2147483647.obj");
  const Setup far = with(folder, "sequence: {pattern: f%d.obj, first: 1, fps: 10}");
  CHECK(std::ranges::any_of(far.warnings, [](const std::string& w) { return w.find("of 2147483647") != w.npos; }));
}

TEST_CASE("What files do not say of their time is said, and so is where they end", "[time]") {
  const Folder folder("time_said");
  for (const int number : {0, 1, 2}) write_frame(folder, number);
  const std::string files = "files: [f0.obj, f1.obj, f2.obj]";
  CHECK_THAT(fake::lines(with(folder, "sequence: {" + files + "}").warnings),
             Contains("30 frames a second are assumed"));
  CHECK_THAT(fake::lines(with(folder, "sequence: {" + files + ", fps: 10}", "{frames: 7}").warnings),
             !Contains("slab"));
  const Setup longer = with(folder, "sequence: {" + files + ", fps: 10}", "{frames: 8}");
  CHECK_THAT(fake::lines(longer.warnings), Contains("`slab` ends at 0.2 s: from frame 6 of 8"));
  const Setup later = with(folder, "sequence: {" + files + ", fps: 10, start: 1 s}", "{frames: 36}");
  CHECK(height(later, 1) == 0);
  CHECK(height(later, 1.15) == Approx(1.5));
  CHECK_THAT(fake::lines(later.warnings), !Contains("begins"));
  // A run may have any rate.
  for (const char* fps : {"24", "30", "120"})
    CHECK(height(with(folder, "sequence: {" + files + ", fps: 10}", "{frames: 1, fps: " + std::string(fps) + "}"),
                 0.15) == Approx(1.5));
  const Setup body = with(folder, "body: {clip: walk}", "{frames: 200}");
  CHECK_THAT(fake::lines(body.warnings), Contains("`slab` ends at 5.967 s: from frame 179 of 200"));
}

TEST_CASE("A frame of an earlier run is shown when it was, and a rejected one not at all", "[time]") {
  const Folder folder("time_run");
  const Scene scene = fake::scene(3);
  const auto write = [&](const std::vector<double>& times, StepStatus last) {
    TrajectoryWriter writer(folder.path / "run.h5", trajectory_info(scene, "", "conventional", 10));
    for (std::size_t k = 0; k < times.size(); ++k) {
      Frame frame;
      frame.time = times[k];
      frame.report.status = k + 1 < times.size() ? StepStatus::accepted : last;
      frame.x = PointsF::Constant(scene.surface.vertex_count, 3, static_cast<float>(k));
      frame.obstacles = {PointsF::Zero(4, 3), PointsF::Zero(4, 3)};
      writer.append(frame);
    }
    writer.close();
  };
  const std::string part = "trajectory: {file: run.h5, part: sheet";
  write({0.5, 0.6, 0.9, 0.9}, StepStatus::rejected);
  const Setup setup = with(folder, part + "}");
  CHECK(height(setup, 0.2) == 0);
  CHECK(height(setup, 0.55) == Approx(0.5));
  CHECK(height(setup, 0.75) == Approx(1.5));
  CHECK(height(setup, 3) == 2);
  CHECK_THAT(fake::lines(setup.warnings), Contains("begins at 0.5 s") && Contains("start: 0 s"));
  CHECK(height(with(folder, part + ", start: 0 s}"), 0.25) == Approx(1.5));
  write({0.5, 0.6, 0.6}, StepStatus::accepted);
  CHECK_THROWS_WITH(with(folder, part + "}"), Contains("run.h5") && Contains("frame 2 at 0.6 s"));
}

TEST_CASE("Cases of other people's files play at the speed that these say", "[time]") {
  const std::filesystem::path cases = fake::open_data() / ".." / "cases" / "cache_time";
  if (!std::filesystem::exists(cases)) {
    WARN("skipped: there is no " << cases);
    return;
  }
  // The slab's rows are stored with another axis up, and turned: its height is the largest coordinate along y.
  const auto rise = [](const Setup& setup) {
    return setup.drive_at(0.5).obstacles[0].col(1).maxCoeff() - setup.drive_at(0).obstacles[0].col(1).maxCoeff();
  };
  const Setup whole = read_setup(cases / "pc_slab_pc2.yaml"), half = read_setup(cases / "pc_slab_half_pc2.yaml");
  CHECK(rise(whole) == Approx(0.1).margin(1e-4));
  CHECK(rise(half) == Approx(rise(whole)).margin(1e-4));
  const Setup gap = read_setup(cases / "gap.yaml");
  CHECK_THAT(fake::lines(gap.warnings), Contains("gap/f3.obj"));
  const auto top = [&](double frame) { return gap.drive_at(frame / 30).obstacles[0].col(1).maxCoeff(); };
  CHECK(top(1) == Approx(0.2));
  CHECK(top(2) == Approx(0.35));  // the missing one
  CHECK(top(3) == Approx(0.5));
}

}  // namespace selvedge::test_time_of_files
