#include "pipeline/host/read_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "collision/geometry/require_file.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/npz.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_read_file {

using Catch::Matchers::Contains;
using fake::Folder;

TEST_CASE("files: a pipe or a device is refused, since reading it might never end", "[read_file]") {
  const Folder folder("pipes");
  const auto pipe = folder.path / "pipe.obj";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(require_file(pipe, "mesh"), Contains("pipe.obj: is a pipe, which might never end") &&
                                                    Contains("write what it gives into a file"));
  CHECK_THROWS_WITH(require_file(folder.path, "mesh"), Contains("is a folder") && Contains("name the mesh file in it"));
  CHECK_NOTHROW(require_file(folder.path / "absent", "mesh"));
  CHECK_NOTHROW(require_file(fake::write(folder, "file", "text"), "mesh"));

  // /dev/null ends at once: a reader that opens it anyway finds it empty.
  const auto refused = Contains("/dev/null: is a device");
  CHECK_THROWS_WITH(read_file("/dev/null", "text"), refused);
  CHECK_THROWS_WITH(read_text_file("/dev/null", "text"), refused);
  CHECK_THROWS_WITH(read_weight_file("/dev/null"), refused);
  CHECK_THROWS_WITH(TrajectoryReader("/dev/null"), refused);
  CHECK_THROWS_WITH(Npz("/dev/null"), refused);
  CHECK_THROWS_WITH(read_setup("/dev/null"), refused);
  std::filesystem::create_symlink("/dev/null", folder.path / "link.obj");
  CHECK_THROWS_WITH(read_mesh(folder.path / "link.obj"), Contains("link.obj: is a device"));
  const auto scene = fake::write(folder, "scene.yaml", "cloths: [{rectangle: {}, seams: [{file: /dev/null}]}]\n");
  CHECK_THROWS_WITH(read_setup(scene), refused);
}

TEST_CASE("files: a carriage return ends a line of text, alone or before a line feed", "[read_file]") {
  const Folder folder("lines");
  const std::string mixed = "one\rtwo\r\nthree\r\r\nfour\r\rfive\r";
  CHECK(read_text_file(fake::write(folder, "a.txt", mixed), "text") == "one\ntwo\r\nthree\r\r\nfour\n\nfive\n");
  CHECK(read_headed_file(fake::write(folder, "a.txt", mixed), "text") == mixed);
  const auto scene =
      fake::write(folder, "scene.yaml", "gravity: [0, -9.81, 0] # as on Earth\rcloths: [{rectangle: {}}]\rrun: {x: 1}");
  CHECK_THROWS_WITH(read_setup(scene), Contains("scene.yaml:3"));
}

}  // namespace selvedge::test_read_file
