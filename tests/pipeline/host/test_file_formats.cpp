#include "pipeline/host/file_formats.hpp"

#include <catch2/catch.hpp>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_file_formats {

using Catch::Matchers::Contains;

TEST_CASE("Files of other programs are refused with the format to export", "[file_formats]") {
  const fake::Folder folder("file_formats");
  const auto read = [&](const std::string& parts) {
    return read_setup(
        fake::write(folder, "scene.yaml", "cloths: [{rectangle: {edge: 0.5}}]\nobstacles: [" + parts + "]\n"));
  };
  for (const char* name : {"a.fbx", "a.DAE", "a.usdz", "a.glb"}) fake::write(folder, name, "?");
  CHECK_THROWS_WITH(read("{body: {model: a.fbx}}"), Contains("export it as .glb"));
  CHECK_THROWS_WITH(read("{body: {model: mannequin, clip: a.fbx}}"), Contains("export it as .glb or .bvh"));
  CHECK_THROWS_WITH(read("{mesh: a.DAE}"), Contains("export it as .obj or .ply"));
  CHECK_THROWS_WITH(read_mesh(folder.path / "a.usdz"), Contains("export it as .obj or .ply"));
  CHECK_THROWS_WITH(read("{mesh: a.glb}"), Contains("`body: {model: ..}`"));
  for (const char* name : {"a.glb", "B.GLTF", "c.vrm"}) CHECK(is_gltf(name));
  CHECK_FALSE(is_gltf("a.fbx"));
}

}  // namespace selvedge::test_file_formats
