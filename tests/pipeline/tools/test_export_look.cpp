#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/exports/obj_objects.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_mtl.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/tools/export.hpp"
#include "tests/pipeline/exports/read_animated.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_export_look {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

constexpr int frames = 3;

// A strip of a quadrangle and two triangles along x. The quadrangle's right edge is there twice, with other texture
// coordinates but the same normals; the last edge is hard. The vertices are in no order of places.
const std::string strip =
    "mtllib strip.mtl\no strip\nv 2 0 0\nv 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 1 1 0\nv 1 0 0\nv 2 1 0\n"
    "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.6 0\nvt 1 0\nvt 0.6 1\nvt 1 1\nvn 0 0 1\nvn 0 0.1 0.9\n"
    "g left\nusemtl red cloth\nf 2/1/1 4/2/1 5/3/1 3/4/1\ng right\nusemtl blue\nf 7/5/1 1/6/1 6/7/1\n"
    "f 6/7/2 1/6/2 8/8/2\n";

struct Sewn {
  Mesh mesh;  // welded: six vertices of eight
  Scene scene;
  std::filesystem::path run;
};

PointsF moved(const Scene& scene, int frame) {
  PointsF x = scene.rest.cast<float>();
  for (Eigen::Index v = 0; v < x.rows(); ++v) x(v, 2) += 0.25f * static_cast<float>(frame) * x(v, 0) * x(v, 0);
  return x;
}

Sewn sewn_run(const Folder& folder) {
  fake::write(folder, "strip.mtl", "newmtl red cloth\nKd 0.5 0 0.25\nnewmtl blue\nKd 0 0 1\nmap_Kd a b.png\n");
  Sewn sewn{read_mesh(fake::write(folder, "strip.obj", strip)), {}, folder.path / "run.h5"};
  read_materials(sewn.mesh);
  weld(sewn.mesh, "strip.obj");
  REQUIRE(sewn.mesh.x.rows() == 6);
  add_cloth(sewn.scene, sewn.mesh.x, sewn.mesh.triangles, {}, "shirt");
  add_cloth(sewn.scene, fake::grid_points(3), fake::grid_triangles(3), {}, "sheet");
  TrajectoryInfo info = trajectory_info(sewn.scene, "", "conventional", 24);
  info.looks = {sewn.mesh.look, {}};
  TrajectoryWriter writer(sewn.run, info);
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.x = moved(sewn.scene, i);
    frame.report.status = StepStatus::accepted;
    writer.append(frame);
  }
  writer.close();
  return sewn;
}

// Where the vertices of the file are in a frame.
PointsF expected(const Sewn& sewn, int frame) { return moved(sewn.scene, frame)(sewn.mesh.look.vertex, Eigen::all); }

double off(const PointsF& a, const PointsF& b) {
  REQUIRE(a.rows() == b.rows());
  return (a - b).cwiseAbs().maxCoeff();
}

std::vector<std::filesystem::path> exported(const Sewn& sewn, const std::string& format, const Folder& folder) {
  return export_trajectory({sewn.run, format, folder.path / format, false, {}});
}

// The normal of the smooth part at its hard edge, and beyond it, in a frame.
Eigen::RowVector3f face_normal(const PointsF& x, int a, int b, int c) {
  const Eigen::Vector3f p = x.row(a), q = x.row(b), r = x.row(c);
  return (q - p).cross(r - p).normalized().transpose();
}

}  // namespace

TEST_CASE("OBJ: a garment comes out as its file had it, beside other cloths", "[export][look]") {
  const Folder folder("export_look_obj");
  const Sewn sewn = sewn_run(folder);
  const auto files = exported(sewn, "obj", folder);
  REQUIRE(files.size() == 1 + frames);
  CHECK(files[0].filename() == "cloth.mtl");
  Mesh back = read_mesh(files[3]);
  read_materials(back);
  CHECK(off(back.x.topRows(8).cast<float>(), expected(sewn, 2)) == 0);
  CHECK(off(back.x.bottomRows(9).cast<float>(), moved(sewn.scene, 2).bottomRows(9)) == 0);
  const Look &look = back.look, &given = sewn.mesh.look;
  CHECK(std::vector(look.begin.begin(), look.begin.begin() + 3) == given.begin);
  CHECK(std::vector(look.corners.begin(), look.corners.begin() + 10) == given.corners);
  CHECK(std::vector(look.corner_uv.begin(), look.corner_uv.begin() + 10) == given.corner_uv);
  CHECK(look.uv == given.uv);
  REQUIRE(look.materials.size() == 3);
  CHECK(std::vector(look.materials.begin(), look.materials.begin() + 2) == given.materials);
  CHECK(look.materials[2] == LookMaterial{"default"});  // the sheet has none
  CHECK(std::vector(look.face_material.begin(), look.face_material.begin() + 4) == std::vector<int>{0, 1, 1, 2});
  CHECK(look.parts[static_cast<std::size_t>(look.face_part[0])] == LookPart{"strip", "left", ""});
  CHECK(look.parts[static_cast<std::size_t>(look.face_part[2])] == LookPart{"strip", "right", ""});
  CHECK(look.parts[static_cast<std::size_t>(look.face_part[3])].object == "sheet");
  CHECK(fake::has(fake::whole(files[1]), "\ng left\nusemtl red cloth\nf 2/1/1 4/2/2 5/3/3 3/4/4\n"));
  CHECK(fake::whole(files[1]).starts_with("mtllib cloth.mtl\no strip\nv 2 0 0\n"));
}

TEST_CASE("OBJ: faces without a material do not get one that is named `default`", "[export][look]") {
  AnimatedSurface surface{"sheet", Triangles(2, 3), 3};
  surface.look = plain_look(3, {0, 1, 2, 2, 1, 0}, {0, 3});
  surface.look.materials = {{"default", Vec3(1, 0, 0)}};
  surface.look.face_material = {0, -1};
  const PointsF x = PointsF::Zero(3, 3);
  const std::string text = objects_text({&surface, 1}, normal_slots({&surface, 1}), {&x, 1}, "sheet.mtl");
  CHECK(fake::has(text, "usemtl default\nf 1 2 3\nusemtl default_1\nf 3 2 1\n"));
  CHECK(objects_materials({&surface, 1}) == "newmtl default\nKd 1 0 0\n");
}

TEST_CASE("USD: a garment has its file's vertices, faces, coordinates, normals, materials and parts",
          "[export][look]") {
  const Folder folder("export_look_usda");
  const Sewn sewn = sewn_run(folder);
  const auto read = read_animated::usda(exported(sewn, "usda", folder)[0]);
  REQUIRE(read.size() == 2);
  const read_animated::Surface& shirt = read.at("shirt");
  CHECK(shirt.counts == std::vector<int>{4, 3, 3});
  CHECK(shirt.corners == sewn.mesh.look.corners);
  REQUIRE(shirt.x.size() == frames);
  for (int i = 0; i < frames; ++i) CHECK(off(shirt.x[i], expected(sewn, i)) < 1e-6);
  REQUIRE(shirt.uv.rows() == 10);
  for (int k = 0; k < 10; ++k)
    CHECK((shirt.uv.row(k) - sewn.mesh.look.uv.row(k < 4 ? k : sewn.mesh.look.corner_uv[k])).norm() < 1e-6);
  CHECK(shirt.materials == std::map<std::string, std::vector<int>>{{"red_cloth", {0}}, {"blue", {1, 2}}});
  CHECK(shirt.parts == std::map<std::string, std::vector<int>>{{"left", {0}}, {"right", {1, 2}}});
  REQUIRE(shirt.normals.size() == frames);
  const PointsF x = expected(sewn, 2);
  // The seam is smooth: its two vertices at one place have one normal. The last triangle has its own.
  CHECK(off(shirt.normals[2].row(1), shirt.normals[2].row(4)) == 0);
  CHECK(off(shirt.normals[2].row(7), face_normal(x, 5, 0, 7)) < 1e-4);
  CHECK(off(shirt.normals[2].row(0), face_normal(x, 1, 3, 4)) < 1e-4);
  CHECK(off(shirt.normals[2].row(5), face_normal(x, 6, 0, 5)) < 1e-4);
  CHECK(off(shirt.normals[2].row(1), face_normal(x, 1, 3, 4)) > 0.1);
  CHECK(read.at("sheet").uv.rows() == 0);
  CHECK(read.at("sheet").materials.empty());
  const std::string text = fake::whole(folder.path / "usda" / "run.usda");
  CHECK(fake::has(text, "asset inputs:file = @a b.png@"));
  CHECK(fake::has(text, "color3f inputs:diffuseColor = (0.5, 0, 0.25)"));
  CHECK(fake::has(text, "string name = \"red cloth\""));
}

TEST_CASE("glTF: the file's vertices come first, and those that texture and normals split follow", "[export][look]") {
  const Folder folder("export_look_glb");
  const Sewn sewn = sewn_run(folder);
  const auto read = read_animated::glb(exported(sewn, "glb", folder)[0]);
  REQUIRE(read.size() == 2);
  const read_animated::Surface& shirt = read.at("shirt");
  REQUIRE(shirt.x.size() == frames);
  REQUIRE(shirt.x[0].rows() == 10);  // two more along the hard edge
  for (int i = 0; i < frames; ++i) CHECK(off(shirt.x[i].topRows(8), expected(sewn, i)) < 1e-4);
  CHECK(off(shirt.x[2].row(8), expected(sewn, 2).row(5)) < 1e-4);
  CHECK(off(shirt.x[2].row(9), expected(sewn, 2).row(0)) < 1e-4);
  Triangles triangles(4, 3);
  triangles << 1, 3, 4, 1, 4, 2, 6, 0, 5, 8, 9, 7;
  CHECK(shirt.triangles == triangles);
  const Look& look = sewn.mesh.look;
  for (int k = 0; k < 7; ++k) CHECK((shirt.uv.row(look.corners[k]) - look.uv.row(look.corner_uv[k])).norm() < 1e-6);
  CHECK((shirt.uv.row(8) - look.uv.row(6)).norm() < 1e-6);
  CHECK(shirt.materials == std::map<std::string, std::vector<int>>{{"red cloth", {0, 1}}, {"blue", {2, 3}}});
  CHECK(shirt.parts == std::map<std::string, std::vector<int>>{{"left", {0, 1}}, {"right", {2, 3}}});
  REQUIRE(shirt.normals.size() == frames);
  const PointsF x = expected(sewn, 2);
  CHECK(off(shirt.normals[2].row(3), shirt.normals[2].row(6)) == 0);
  CHECK(off(shirt.normals[2].row(9), face_normal(x, 5, 0, 7)) < 1e-5);
  CHECK(off(shirt.normals[2].row(0), face_normal(x, 6, 0, 5)) < 1e-5);
  CHECK(read.at("sheet").materials.count("sheet") == 1);
}

TEST_CASE("PLY and point caches have the file's vertices, a file a cloth", "[export][look]") {
  const Folder folder("export_look_caches");
  const Sewn sewn = sewn_run(folder);
  CHECK(exported(sewn, "ply", folder).size() == 2 * frames);
  CHECK(off(read_mesh(folder.path / "ply" / "shirt_00002.ply").x.cast<float>(), expected(sewn, 2)) == 0);
  const auto files = exported(sewn, "mdd", folder);
  REQUIRE(files.size() == 5);
  const auto cache = read_animated::mdd(folder.path / "mdd" / "shirt.mdd");
  for (int i = 0; i < frames; ++i) CHECK(off(cache.x[i], expected(sewn, i)) == 0);
  Mesh moving = read_mesh(folder.path / "mdd" / "shirt.obj");
  read_materials(moving);
  CHECK(moving.look.materials == sewn.mesh.look.materials);
  CHECK(moving.look.corners == sewn.mesh.look.corners);
}

TEST_CASE("export --onto: the file of the cloth is driven by the numbers of its vertices", "[export][look]") {
  const Folder folder("export_onto_same");
  const Sewn sewn = sewn_run(folder);
  const auto files = export_trajectory({.trajectory = sewn.run,
                                        .format = "obj",
                                        .out = folder.path / "onto",
                                        .onto = folder.path / "strip.obj",
                                        .cloth = "shirt"});
  const Mesh back = read_mesh(files.back());
  CHECK(off(back.x.topRows(8).cast<float>(), expected(sewn, 2)) == 0);
  CHECK(back.x.rows() == 17);  // the sheet is still there
  CHECK(fake::has(fake::whole(files.back()), "\ng left\nusemtl red cloth\nf 2/1/1"));
}

TEST_CASE("export --onto: a finer mesh in another unit goes with the nearest cloth, and keeps its corners",
          "[export][look]") {
  const Folder folder("export_onto_other");
  const Sewn sewn = sewn_run(folder);
  // Beside the first triangle, 1 cm above it, and on its edge.
  fake::write(folder, "patch.obj",
              "v 25 25 1\nv 75 25 1\nv 75 50 1\nv 25 50 1\nv 50 10 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
              "f 1/1 2/2 3/3 4\nf 5/1 2/2 1/3\n");
  ExportRequest request{.trajectory = sewn.run, .format = "usda", .out = folder.path / "onto"};
  request.onto = folder.path / "patch.obj";
  request.onto_unit = "cm";
  const auto read = read_animated::usda(export_trajectory(request)[0]);
  REQUIRE(read.size() == 1);
  const read_animated::Surface& patch = read.at("patch");
  CHECK(patch.counts == std::vector<int>{4, 3});
  PointsF rest(5, 3);
  rest << 0.25, 0.25, 0.01, 0.75, 0.25, 0.01, 0.75, 0.5, 0.01, 0.25, 0.5, 0.01, 0.5, 0.1, 0;
  CHECK(off(patch.x[0], rest) < 2e-6);
  // The quadrangle becomes the plane from (0, 0) to (1, 0.5), on which the patch is turned and stays as far away.
  const Eigen::Vector3f along = Eigen::Vector3f(1, 0, 0.5).normalized(), normal(-along.z(), 0, along.x());
  for (int v = 0; v < 5; ++v) {
    const Eigen::Vector3f foot(rest(v, 0), rest(v, 1), 0.5f * rest(v, 0));
    CHECK(off(patch.x[2].row(v), (foot + rest(v, 2) * normal).transpose()) < 2e-6);
  }
  CHECK(patch.uv.row(3).norm() == 0);  // a corner without a coordinate

  request.onto_unit = "km";
  CHECK_THROWS_WITH(export_trajectory(request), Contains("--onto-unit: unknown unit `km`"));
  request.onto_unit = "m";
  CHECK_THROWS_WITH(export_trajectory(request), Contains("from the rest shape") && Contains("--onto-unit"));
  request.cloth = "shrit";
  CHECK_THROWS_WITH(export_trajectory(request), Contains("is no cloth of the run") && Contains("did you mean `shirt`"));
}

TEST_CASE("runs without a look, and files of earlier versions, are exported as ever", "[export][look]") {
  const Folder folder("export_look_none");
  Scene scene;
  add_cloth(scene, fake::grid_points(3), fake::grid_triangles(3), {}, "sheet");
  TrajectoryWriter writer(folder.path / "run.h5", trajectory_info(scene, "", "conventional", 24));
  Frame frame;
  frame.x = scene.rest.cast<float>();
  frame.report.status = StepStatus::accepted;
  writer.append(frame);
  writer.close();
  CHECK(TrajectoryReader(folder.path / "run.h5").looks()[0].empty());
  const auto files = export_trajectory({folder.path / "run.h5", "obj", folder.path, false, {}});
  REQUIRE(files.size() == 1);
  CHECK(files[0].filename() == "cloth_00000.obj");
  CHECK(fake::whole(files[0]).starts_with("v 0 0 0\nv 0.5 0 0\n"));
  CHECK(fake::has(fake::whole(files[0]), "\nf 1 4 2\n"));
}

}  // namespace selvedge::test_export_look
