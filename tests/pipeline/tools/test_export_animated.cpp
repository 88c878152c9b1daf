#include <catch2/catch.hpp>
#include <limits>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/tools/export.hpp"
#include "tests/pipeline/exports/read_animated.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_export_animated {

namespace {

constexpr double fps = 24;

// Two cloths, the second named so that no format can take the name as it is, over a still and a moving obstacle.
Scene two_cloths() {
  Scene scene;
  add_cloth(scene, fake::grid_points(5), fake::grid_triangles(5), {}, "sheet");
  add_cloth(scene, fake::grid_points(3), fake::grid_triangles(3), {}, "2nd \"cloth\"");
  Triangles tetrahedron(4, 3);
  tetrahedron << 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2;
  add_obstacle(scene, 4, tetrahedron, false, "still");
  add_obstacle(scene, 4, tetrahedron, true, "mover");
  return scene;
}

Frame waving(const Scene& scene, int index) {
  Frame frame = fake::frame(scene, index);
  frame.time = index / fps;
  for (Eigen::Index i = 0; i < frame.x.rows(); ++i) {
    frame.x(i, 1) += 0.3f * std::sin(0.7f * static_cast<float>(i + index));
    frame.x(i, 0) += 2.5f * static_cast<float>(index * index);
  }
  return frame;
}

std::filesystem::path write_run(const fake::Folder& folder, const Scene& scene, int frames) {
  const std::filesystem::path path = folder.path / "run.h5";
  TrajectoryWriter writer(path, trajectory_info(scene, "", "conventional", fps));
  for (int i = 0; i < frames; ++i) writer.append(waving(scene, i));
  writer.close();
  return path;
}

double largest_difference(const PointsF& a, const PointsF& b) {
  REQUIRE(a.rows() == b.rows());
  return (a.cast<double>() - b.cast<double>()).cwiseAbs().maxCoeff();
}

void check_track(const read_animated::Surface& read, const Scene& scene, int first, int count, int frames,
                 double bound) {
  REQUIRE(read.times.size() == static_cast<std::size_t>(frames));
  for (int i = 0; i < frames; ++i) {
    CHECK(read.times[i] == Approx(i / fps));
    CHECK(largest_difference(read.x[i], waving(scene, i).x.middleRows(first, count)) <= bound);
  }
}

}  // namespace

TEST_CASE("glTF: cloths and obstacles come back at every frame, to 2e-5 of their box") {
  const fake::Folder folder("export_glb");
  const Scene scene = two_cloths();
  const auto files = export_trajectory({write_run(folder, scene, 5), "glb", folder.path / "glb", true, {}});
  REQUIRE(files == std::vector<std::filesystem::path>{folder.path / "glb" / "run.glb"});
  const auto read = read_animated::glb(files[0]);
  REQUIRE(read.size() == 4);
  const double box = 41;  // the longest side: 2.5 * 4^2 and the sheet
  check_track(read.at("sheet"), scene, 0, 25, 5, 2e-5 * box);
  check_track(read.at("2nd \"cloth\""), scene, 25, 9, 5, 2e-5 * box);
  CHECK(read.at("sheet").triangles == fake::grid_triangles(5));
  CHECK(read.at("2nd \"cloth\"").triangles == fake::grid_triangles(3));
  const auto& mover = read.at("obstacle_1_mover");
  REQUIRE(mover.x.size() == 5);
  CHECK(largest_difference(mover.x[3], fake::tetrahedron_points(3, 0.3).cast<float>()) < 2e-5 * 0.5);
  const auto& still = read.at("obstacle_0_still");
  REQUIRE(still.x.size() == 1);
  CHECK(largest_difference(still.x[0], fake::tetrahedron_points(0, -5).cast<float>()) < 2e-5 * 0.1);
}

TEST_CASE("glTF: one frame and a vertex that never moves need no morph target") {
  const fake::Folder folder("export_glb_one");
  const Scene scene = two_cloths();
  const auto files = export_trajectory({write_run(folder, scene, 1), "glb", folder.path, false, {}});
  check_track(read_animated::glb(files[0]).at("sheet"), scene, 0, 25, 1, 2e-5);
}

TEST_CASE("glTF: three hundred frames take 8 bytes a vertex and frame") {
  const fake::Folder folder("export_glb_size");
  const Scene scene = two_cloths();
  const auto files = export_trajectory({write_run(folder, scene, 300), "glb", folder.path, false, {}});
  const double vertices = 34, weights = 300 * 300, tables = 2 * 300 * 140;
  CHECK(std::filesystem::file_size(files[0]) < 8 * vertices * 301 + weights + tables + 8192);
}

TEST_CASE("USD: cloths and obstacles come back at every frame, to a micrometre") {
  const fake::Folder folder("export_usda");
  const Scene scene = two_cloths();
  const auto files = export_trajectory({write_run(folder, scene, 5), "usda", folder.path / "usda", true, {}});
  REQUIRE(files == std::vector<std::filesystem::path>{folder.path / "usda" / "run.usda"});
  const auto read = read_animated::usda(files[0]);
  REQUIRE(read.size() == 4);
  check_track(read.at("sheet"), scene, 0, 25, 5, 4e-6);  // 41 m as float are good to 2e-6
  check_track(read.at("_2nd__cloth_"), scene, 25, 9, 5, 4e-6);
  CHECK(read.at("_2nd__cloth_").triangles == fake::grid_triangles(3));
  REQUIRE(read.at("obstacle_1_mover").x.size() == 5);
  CHECK(largest_difference(read.at("obstacle_1_mover").x[3], fake::tetrahedron_points(3, 0.3).cast<float>()) < 1e-6);
  REQUIRE(read.at("obstacle_0_still").x.size() == 1);
}

TEST_CASE("MDD and PC2 hold the same floats, one of them big-endian") {
  const fake::Folder folder("export_mdd");
  const Scene scene = two_cloths();
  const std::filesystem::path run = write_run(folder, scene, 4);
  int done = 0, all = 0;
  const auto files = export_trajectory({run, "mdd", folder.path, true, [&](int d, int a) { done = d, all = a; }});
  CHECK(files.size() == 7);  // the obstacle that stands still has no cache
  CHECK(done == all);
  CHECK(all == 3 * 4 + 1);
  check_track(read_animated::mdd(folder.path / "sheet.mdd"), scene, 0, 25, 4, 0);
  check_track(read_animated::mdd(folder.path / "2nd__cloth_.mdd"), scene, 25, 9, 4, 0);
  export_trajectory({run, "pc2", folder.path, false, {}});
  CHECK(read_animated::pc2(folder.path / "sheet.pc2").x == read_animated::mdd(folder.path / "sheet.mdd").x);
  CHECK(read_mesh(folder.path / "sheet.obj").triangles == fake::grid_triangles(5));
}

TEST_CASE("formats without a way to say so refuse what is not finite and name it; nothing is left behind") {
  const fake::Folder folder("export_nan");
  const Scene scene = two_cloths();
  const std::filesystem::path run = folder.path / "run.h5";
  TrajectoryWriter writer(run, trajectory_info(scene, "", "conventional", fps));
  for (int i = 0; i < 3; ++i) {
    Frame frame = waving(scene, i);
    if (i == 2) frame.x(27, 1) = std::numeric_limits<float>::quiet_NaN();
    writer.append(frame);
  }
  writer.close();
  for (const std::string format : {"glb", "usda"}) {
    CHECK_THROWS_WITH(export_trajectory({run, format, folder.path / format, false, {}}),
                      Catch::Contains("vertex 2 is not finite in frame 2") && Catch::Contains("2nd"));
    CHECK(std::filesystem::is_empty(folder.path / format));
  }
  CHECK(export_trajectory({run, "mdd", folder.path / "mdd", false, {}}).size() == 4);
}

TEST_CASE("a run without a frame is not exported") {
  const fake::Folder folder("export_empty");
  const std::filesystem::path run = write_run(folder, two_cloths(), 0);
  for (const std::string format : {"obj", "pc2", "mdd", "glb", "usda"})
    CHECK_THROWS_WITH(export_trajectory({run, format, folder.path / "out", false, {}}),
                      Catch::Contains("no full frame"));
}

}  // namespace selvedge::test_export_animated
