#include <catch2/catch.hpp>
#include <cstring>

#include "collision/geometry/error.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/hdf5/xdmf.hpp"
#include "pipeline/tools/export.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_export {

namespace {

std::filesystem::path write_run(const fake::Folder& folder, const Scene& scene, int frames) {
  const std::filesystem::path path = folder.path / "run.h5";
  TrajectoryWriter writer(path, trajectory_info(scene, "", "conventional", 30));
  for (int i = 0; i < frames; ++i) writer.append(fake::frame(scene, i));
  writer.close();
  return path;
}

}  // namespace

TEST_CASE("meshes exported from a trajectory read back to its positions") {
  const fake::Folder folder("export_mesh");
  const Scene scene = fake::scene();
  const std::filesystem::path run = write_run(folder, scene, 3);
  for (const std::string format : {"obj", "ply"}) {
    const auto files = export_trajectory({run, format, folder.path / format, true, {}});
    REQUIRE(files.size() == 7);  // the obstacle that stands still once
    REQUIRE(std::filesystem::exists(folder.path / format / ("obstacle_0_still_00000." + format)));
    const Mesh cloth = read_mesh(folder.path / format / ("cloth_00002." + format));
    REQUIRE((cloth.x - fake::frame(scene, 2).x.cast<double>()).cwiseAbs().maxCoeff() < 1e-6);
    REQUIRE(cloth.triangles == scene.surface.triangles);
    const Mesh mover = read_mesh(folder.path / format / ("obstacle_1_mover_00002." + format));
    REQUIRE((mover.x - fake::tetrahedron_points(3, 0.2)).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("a point cache holds every frame as floats after its header") {
  const fake::Folder folder("export_pc2");
  const Scene scene = fake::scene();
  const auto files = export_trajectory({write_run(folder, scene, 4), "pc2", folder.path / "pc2", false, {}});
  REQUIRE(files.size() == 2);
  const std::string bytes = fake::whole(folder.path / "pc2" / "cloth.pc2");
  REQUIRE(bytes.size() == 32 + 4 * 25 * 3 * sizeof(float));
  REQUIRE(std::memcmp(bytes.data(), "POINTCACHE2\0", 12) == 0);
  std::int32_t version = 0, points = 0, samples = 0;
  std::memcpy(&version, &bytes[12], 4);
  std::memcpy(&points, &bytes[16], 4);
  std::memcpy(&samples, &bytes[28], 4);
  REQUIRE(version == 1);
  REQUIRE(points == 25);
  REQUIRE(samples == 4);
  PointsF last(25, 3);
  std::memcpy(last.data(), &bytes[32 + 3 * 25 * 3 * sizeof(float)], 25 * 3 * sizeof(float));
  REQUIRE(last == fake::frame(scene, 3).x);
}

TEST_CASE("the folder of a run is exported as its trajectory is") {
  const fake::Folder folder("export_folder");
  std::filesystem::rename(write_run(folder, fake::scene(), 2), folder.path / "run.h5");
  const auto files = export_trajectory({folder.path, "glb", folder.path / "out", false, {}});
  REQUIRE(files.size() == 1);
  REQUIRE(files[0] == folder.path / "out" / "run.glb");
}

TEST_CASE("an export that is stopped keeps whole files alone") {
  const fake::Folder folder("export_stopped");
  const std::filesystem::path run = write_run(folder, fake::scene(), 4);
  for (const std::string format : {"obj", "ply", "pc2", "mdd", "glb", "usda"}) {
    const std::filesystem::path out = folder.path / format;
    int asked = 0;
    ExportRequest request{run, format, out, false};
    const StopFlag stop = [&] { return ++asked > 2; };
    const StopScope scope(stop);
    INFO(format);
    REQUIRE_THROWS_AS(export_trajectory(request), Stopped);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path))
      REQUIRE(entry.path().extension() != ".part");
  }
}

TEST_CASE("an unknown format is refused with those that are known") {
  const fake::Folder folder("export_unknown");
  const std::filesystem::path run = write_run(folder, fake::scene(), 1);
  REQUIRE_THROWS_WITH(export_trajectory({run, "fbx", folder.path, false, {}}), Catch::Contains("pc2"));
}

TEST_CASE("the XDMF sidecar names the arrays and rows of every frame") {
  const std::string text = xdmf_text(trajectory_info(fake::scene(), "", "conventional", 30), {0, 0.5, 1}, "run.h5");
  REQUIRE(text.find("run.h5:/frames/x") != std::string::npos);
  REQUIRE(text.find("Dimensions=\"3 25 3\"") != std::string::npos);
  REQUIRE(text.find("2 0 0  1 1 1  1 25 3") != std::string::npos);
  REQUIRE(text.find("run.h5:/obstacles/1/x") != std::string::npos);
  REQUIRE(text.find("Dimensions=\"1 4 3\">run.h5:/obstacles/0/x") != std::string::npos);
  REQUIRE(text.find("<Time Value=\"0.5\"/>") != std::string::npos);
  std::size_t opened = 0, closed = 0;
  for (std::size_t at = 0; (at = text.find("<Grid", at)) != std::string::npos; ++at) ++opened;
  for (std::size_t at = 0; (at = text.find("</Grid>", at)) != std::string::npos; ++at) ++closed;
  REQUIRE(opened == 1 + 3 * 4);
  REQUIRE(opened == closed);
  CHECK(text.find("<Attribute") == std::string::npos);
}

TEST_CASE("the XDMF sidecar of a run with contact forces has them as attributes of the cloth") {
  TrajectoryInfo info = trajectory_info(fake::scene(), "", "conventional", 30);
  info.contact_forces = true;
  const std::string text = xdmf_text(info, {0, 0.5}, "run.h5");
  std::size_t attributes = 0;
  for (std::size_t at = 0; (at = text.find("<Attribute", at)) != std::string::npos; ++at) ++attributes;
  CHECK(attributes == 2 * 3);
  CHECK(text.find("Dimensions=\"2 25 3\">run.h5:/frames/contact_friction<") != std::string::npos);
  CHECK(text.find("\"3 2\">1 0  1 1  1 25<") != std::string::npos);
  CHECK(text.find("Dimensions=\"2 25\">run.h5:/frames/contact_pressure<") != std::string::npos);
}

}  // namespace selvedge::test_export
