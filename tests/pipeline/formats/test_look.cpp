#include <algorithm>

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_mtl.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/hdf5/look_hdf5.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_look {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// A quadrangle and a triangle, whose common edge is there twice, in two groups of two materials.
const std::string split_seam =
    "mtllib shirt.mtl\no shirt\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 1 1 0\n"
    "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.6 0\nvt 1 0\nvt 0.6 1\nvn 0 0 1\nvn 0 0 1\n"
    "g left\ns 1\nusemtl red cloth\nf 1/1/1 2/2/1 3/3/1 4/4/1\ng right\nusemtl blue\nf 5/5/2 6/6/2 7/7/2\n";

Mesh read(const Folder& folder, const std::string& text) { return read_mesh(fake::write(folder, "shirt.obj", text)); }

}  // namespace

TEST_CASE("OBJ: polygons, texture coordinates, normals, materials and parts are the look of the mesh", "[look]") {
  const Folder folder("look_obj");
  fake::write(folder, "shirt.mtl",
              "newmtl blue\nKd 0 0 1\nmap_Kd -s 2 2 1 textures/blue cloth.png\nnewmtl other\nKd 1 1 1\n"
              "newmtl red cloth\r\nKd 0.5 0 0.25\r\nmap_Kd C:\\work\\red.png\n");
  Mesh mesh = read(folder, split_seam);
  read_materials(mesh);
  const Look& look = mesh.look;
  CHECK(mesh.warnings.empty());
  CHECK(mesh.triangles.rows() == 3);
  CHECK(look.vertex == std::vector<int>{0, 1, 2, 3, 4, 5, 6});
  CHECK(look.begin == std::vector<int>{0, 4});
  CHECK(look.corners == std::vector<int>{0, 1, 2, 3, 4, 5, 6});
  CHECK(look.corner_uv == look.corners);
  CHECK(look.uv(6, 0) == 0.6);
  CHECK(look.corner_normal == std::vector<int>(7, 0));  // two `vn` of one value are one normal
  CHECK(look.materials == std::vector<LookMaterial>{{"red cloth", Vec3(0.5, 0, 0.25), "red.png"},
                                                    {"blue", Vec3(0, 0, 1), "textures/blue cloth.png"}});
  CHECK(look.face_material == std::vector<int>{0, 1});
  CHECK(look.parts == std::vector<LookPart>{{"shirt", "left", "1"}, {"shirt", "right", "1"}});
  CHECK(look.face_part == std::vector<int>{0, 1});
}

TEST_CASE("a mesh of which vertices and triangles say all has no look; polygons of PLY are kept", "[look]") {
  const Folder folder("look_none");
  CHECK(read(folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n").look.empty());
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const Mesh quad = read_mesh(fake::write(folder, "quad.ply", head + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"));
  CHECK(quad.look.begin == std::vector<int>{0});
  CHECK(quad.look.corners == std::vector<int>{0, 1, 2, 3});
}

TEST_CASE("wrong normals and missing material files do not keep a mesh from being read", "[look]") {
  const Folder folder("look_wrong");
  Mesh mesh = read(folder,
                   "mtllib gone.mtl\nmtllib ../up.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvn a b\n"
                   "vn 0 0 1\nf 1//2 2//x 3//9\n");
  CHECK(mesh.look.corner_normal == std::vector<int>{0, -1, -1});
  REQUIRE(mesh.warnings.size() == 1);
  CHECK_THAT(mesh.warnings[0], Contains("1 corner of a face names a normal that is not there"));
  read_materials(mesh);
  REQUIRE(mesh.warnings.size() == 3);
  CHECK_THAT(mesh.warnings[1], Contains("gone.mtl"));
  CHECK_THAT(mesh.warnings[2], Contains("../up.mtl"));
  CHECK(mesh.look.materials == std::vector<LookMaterial>{{"red"}});
}

TEST_CASE("names may have a # and blanks in them, in OBJ as in MTL, and a line may name several files", "[look]") {
  const Folder folder("look_names");
  fake::write(folder, "my mats.mtl", "newmtl Red#1\nKd 1 0 0\nnewmtl Material #25\nKd 0.5 # grey\n");
  fake::write(folder, "a.mtl", "newmtl Material #26\nKd 0 1 0\n");
  fake::write(folder, "b.mtl", "newmtl blue # of the sea\nmap_Kd sea.png # far away\n");
  Mesh mesh = read(folder,
                   "mtllib my mats.mtl\nmtllib a.mtl b.mtl # two\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0#no\n"
                   "o c#1\nusemtl Red#1\nf 1 2 3#no\nusemtl Material #25\nf 2 3 1\nusemtl Material #26 # green\n"
                   "f 3 1 2\nusemtl blue\nf 1 2 3\n");
  read_materials(mesh);
  CHECK(mesh.look.materials == std::vector<LookMaterial>{{"Red#1", Vec3(1, 0, 0)},
                                                         {"Material #25", Vec3(0.5, 0.5, 0.5)},
                                                         {"Material #26", Vec3(0, 1, 0)},
                                                         {"blue", {}, "sea.png"}});
  CHECK(mesh.look.parts == std::vector<LookPart>{{"c#1"}});
  CHECK_THAT(mesh.warnings.back(), Contains("gone.mtl"));
  CHECK(std::ranges::count_if(mesh.warnings, [](const std::string& w) { return w.find(".mtl") < w.size(); }) == 1);
}

TEST_CASE("a welded mesh keeps the vertices of its file in the look", "[look]") {
  const Folder folder("look_weld");
  Mesh mesh = read(folder, split_seam);
  weld(mesh, "shirt.obj");
  CHECK(mesh.x.rows() == 5);
  CHECK(mesh.look.vertex == std::vector<int>{0, 1, 2, 3, 1, 4, 2});
  CHECK(mesh.look.corners == std::vector<int>{0, 1, 2, 3, 4, 5, 6});
  Mesh plain = read(folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n");
  weld(plain, "shirt.obj");
  CHECK(plain.look.vertex == std::vector<int>{0, 1, 2, 0, 2, 3});
}

TEST_CASE("a look comes back from a file as it was, and a damaged one is refused", "[look]") {
  const Folder folder("look_hdf5");
  Mesh mesh = read(folder, split_seam);
  mesh.look.materials[1].colour = Vec3(0, 0, 1);
  const auto written = [&](const std::string& name, const Look& look) {
    h5::write_whole(folder.path / name, [&](const h5::File& file) { h5::write_look(file, "look", look); });
    return h5::File::open(folder.path / name);
  };
  const Look look = h5::read_look(written("whole.h5", mesh.look), "look", 7);
  CHECK(look.vertex == mesh.look.vertex);
  CHECK(look.corners == mesh.look.corners);
  CHECK(look.begin == mesh.look.begin);
  CHECK(look.uv == mesh.look.uv);
  CHECK(look.corner_uv == mesh.look.corner_uv);
  CHECK(look.corner_normal == mesh.look.corner_normal);
  CHECK(look.materials == mesh.look.materials);
  CHECK(look.face_material == mesh.look.face_material);
  CHECK(look.parts == mesh.look.parts);
  CHECK(look.face_part == mesh.look.face_part);
  CHECK_THROWS_WITH(h5::read_look(h5::File::open(folder.path / "whole.h5"), "look", 6), Contains("look/vertex"));
  CHECK(h5::read_look(h5::File::open(folder.path / "whole.h5"), "none", 7).empty());
  Look bad = mesh.look;
  bad.corner_uv[3] = 7;
  CHECK_THROWS_WITH(h5::read_look(written("uv.h5", bad), "look", 7), Contains("corner_uv") && Contains("names 7"));
  bad = mesh.look;
  bad.begin[1] = 5;
  CHECK_THROWS_WITH(h5::read_look(written("begin.h5", bad), "look", 7), Contains("fewer than three corners"));
  bad = mesh.look;
  bad.face_material.pop_back();
  CHECK_THROWS_WITH(h5::read_look(written("material.h5", bad), "look", 7), Contains("has 1 entries, not 2"));
}

}  // namespace selvedge::test_look
