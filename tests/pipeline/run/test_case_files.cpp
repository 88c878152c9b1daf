#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "pipeline/tools/untangle_mesh.hpp"
#include "tests/pipeline/cases.hpp"
#include "tests/pipeline/files.hpp"

// Files of other people that were refused, misread or taken at their word, held to what the README of the cases says.
namespace selvedge::test_case_files {

using Catch::Matchers::Contains;
using fake::case_file;

TEST_CASE("cases: skeletons of twelve programs are known by their names", "[case_files]") {
  const auto folder = case_file("bvh_names");
  if (!folder) return;
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() != ".yaml") continue;
    INFO(entry.path());
    CHECK_NOTHROW(read_setup(entry.path()));
    ++read;
  }
  CHECK(read == 12);
}

TEST_CASE("cases: a byte order mark and a comment before the first vertex change no index", "[case_files]") {
  const auto folder = case_file("obj_dialects");
  if (!folder) return;
  const Mesh plain = read_mesh(*folder / "nobom_shift.obj");
  for (const char* name : {"bom.obj", "bom_comment.obj"}) CHECK_NOTHROW(read_mesh(*folder / name));
  const Mesh marked = read_mesh(*folder / "bom_shift.obj");
  CHECK(marked.x == plain.x);
  CHECK(marked.triangles == plain.triangles);
}

TEST_CASE("cases: absurd numbers are refused with their place and value", "[case_files]") {
  if (!case_file("hostile_files")) return;
  const auto refused = [](const char* name) { return read_setup(*case_file(name)); };
  CHECK_THROWS_WITH(refused("slow_numbers/yaml/x.yaml"), Contains("x.yaml:10") && Contains("9223372036854775807"));
  CHECK_THROWS_WITH(refused("slow_numbers/obj/x.yaml"), Contains("x.obj:39") && Contains("-2147483648"));
  CHECK_THROWS_WITH(refused("hostile_files/copies.yaml"), Contains("copies.yaml:3") && Contains("1000000000"));
  CHECK_THROWS_WITH(refused("hostile_files/start_stretch.yaml"),
                    Contains("start_stretch.yaml:8") && Contains("7.7e+08"));
  const fake::Folder folder("case_untangled");
  UntangleRequest request;
  request.out = folder.path / "out.obj";
  request.file = *case_file("hostile_files/far.ply");
  CHECK_THROWS_WITH(untangle_mesh(request), Contains("far.ply:45") && Contains("1e+18"));
  request.file = *case_file("untangle_huge/x.obj");
  CHECK_THROWS_WITH(untangle_mesh(request), Contains("x.obj:43") && Contains("-1e308"));
  CHECK_FALSE(std::filesystem::exists(request.out));
}

TEST_CASE("cases: a glTF file opens nothing outside of its own folder", "[case_files]") {
  if (!case_file("hostile_files")) return;
  const fake::Folder folder("case_gltf");
  BodyRequest request;
  request.out = folder.path / "out.h5";
  request.file = *case_file("hostile_files/exf2.gltf");
  CHECK_THROWS_WITH(convert_body(request), Contains("sec_private/secret.txt"));
  CHECK_FALSE(std::filesystem::exists(request.out));
}

TEST_CASE("cases: a trajectory with a dataset larger than its place is one error", "[case_files]") {
  const auto file = case_file("traj_fps/fps_8.h5");
  if (!file) return;
  CHECK_THROWS_WITH(TrajectoryReader(*file), Contains("fps_8.h5") && Contains("fps"));
}

TEST_CASE("cases: pins inside a collider and cloth in the wrong unit are said when a scene is read", "[case_files]") {
  if (!case_file("pin_inside")) return;
  CHECK_THAT(fake::lines(read_setup(*case_file("pin_inside/scene.yaml")).warnings),
             Contains("21 pins of group top") && Contains("inside the obstacle `shoulder`"));
  CHECK_THAT(fake::lines(read_setup(*case_file("cm_scale/scene.yaml")).warnings),
             Contains("84.9 m") && Contains("unit: cm"));
}

}  // namespace selvedge::test_case_files
