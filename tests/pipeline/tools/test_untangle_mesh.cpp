#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/tools/check.hpp"
#include "pipeline/tools/untangle_mesh.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_untangle_mesh {

namespace {

// A sheet of quads with texture coordinates and a group, and a spike whose tip is below it.
std::string spiked_sheet() {
  std::string text = "# a sheet and a spike\nmtllib none.mtl\no sheet\n";
  constexpr int n = 8;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      text += "v " + std::to_string(i / 8.0 + 0.001 * j) + " 0 " + std::to_string(j / 8.0) + "\n";
  text += "v 0.45 -0.03 0.45 0.5 0.5 0.5\r\nv 0.3 0.2 \\\n 0.3\nv 0.6 0.2 0.3\nv 0.45 0.2 0.7\n";
  for (int k = 0; k < 4; ++k) text += "vt 0.1 0." + std::to_string(k) + "\n";
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1;
      const auto corner = [](int v, int t) { return std::to_string(v) + "/" + std::to_string(t) + " "; };
      text += "f " + corner(a, 1) + corner(a + n + 1, 2) + corner(a + n + 2, 3) + corner(a + 1, 4) + "\n";
    }
  return text + "g spike\nf 82 84 83\nf 82 85 84\nf 82 83 85\n";
}

std::vector<std::string> other_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("v ", 0) != 0 && line.rfind(" 0.3", 0) != 0) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("untangle: a mesh file comes out clean, all other lines as they were") {
  const fake::Folder folder("untangle_file");
  UntangleRequest request;
  request.file = fake::write(folder, "in.obj", spiked_sheet());
  request.out = folder.path / "out.obj";
  request.unit = "cm";
  const UntangleReport report = untangle_mesh(request);
  REQUIRE(report.result.pairs_before > 0);
  REQUIRE(is_clean(report));
  CHECK(report.mean_edge == Approx(0.00147).epsilon(0.1));
  CHECK(report.result.length_before < 0.01);

  const Mesh in = read_mesh(request.file), out = read_mesh(request.out);
  CHECK(same_triangles(in.triangles, out.triangles));
  CHECK(out.x == report.result.x);
  CHECK(out.uv == in.uv);
  CHECK(other_lines(spiked_sheet()) == other_lines(fake::whole(request.out)));
  CHECK(fake::whole(request.out).find(" 0.5 0.5 0.5\n") != std::string::npos);
  CHECK(check({request.out, {}, {}}).worst_pairs == 0);

  const auto json = nlohmann::json::parse(untangle_json(report));
  CHECK(json["pairs_before"] == report.result.pairs_before);
  CHECK(json["pairs_after"] == 0);
  CHECK(json["audited_pairs"] == 0);
  CHECK(json["clean"] == true);
  for (const char* key : {"mean_move", "far_move", "min_stretch", "max_stretch", "degenerate_after", "left", "seconds"})
    CHECK(json.contains(key));
  CHECK(untangle_text(report).find("intersecting pairs") != std::string::npos);
}

TEST_CASE("untangle: other formats, units and layers") {
  const fake::Folder folder("untangle_formats");
  UntangleRequest request;
  request.file = fake::write(folder, "in.obj", spiked_sheet());
  request.out = folder.path / "out.ply";
  const UntangleReport report = untangle_mesh(request);
  CHECK(read_mesh(request.out).triangles == read_mesh(request.file).triangles);
  REQUIRE(report.warnings.size() == 1);
  CHECK(report.warnings[0].find("not written") != std::string::npos);
  request.unit = "furlong";
  CHECK_THROWS_AS(untangle_mesh(request), Error);
  request.unit = "m";
  request.layers = {1, 2, 3};
  CHECK_THROWS_AS(untangle_mesh(request), Error);
  request.layers.clear();
  request.out = folder.path / "out.stl";
  CHECK_THROWS_AS(untangle_mesh(request), Error);
}

TEST_CASE("untangle: the open data", "[data]") {
  const std::filesystem::path data = fake::open_data();
  struct Given {
    const char *file, *body;
    int pairs;
  };
  for (const Given& given : {Given{"diffcloth/dress-v5k-f10k.obj", "", 315},
                             {"diffcloth/tshirt1900-folding-biFolded.obj", "", 48},
                             {"makehuman/helper_tights.obj", "makehuman/body.obj", 96},
                             {"meshes/two-cubes-intersecting.ply", "", 96}}) {
    if (!std::filesystem::exists(data / given.file)) {
      WARN("skipped, not there: " << (data / given.file).string());
      continue;
    }
    INFO(given.file);
    const fake::Folder folder("untangle_data");
    UntangleRequest request;
    request.file = data / given.file;
    request.out = folder.path / "out.obj";
    if (*given.body) request.bodies = {data / given.body};
    const UntangleReport report = untangle_mesh(request);
    CHECK(report.result.pairs_before == given.pairs);
    CHECK(report.audited_pairs == 0);
    CHECK(is_clean(report));
    CHECK(report.result.least_stretch > 0.5);
    CHECK(report.result.largest_stretch < 2);
    CHECK(report.result.far_move < 0.1);
    CHECK(report.result.mean_move < 2);
    CHECK(report.degenerate_after <= report.degenerate_before);
    CHECK(same_triangles(read_mesh(request.file).triangles, read_mesh(request.out).triangles));
  }
}

TEST_CASE("untangle: a shirt tucked into a skirt part of the way round, on a body") {
  const std::filesystem::path given = fake::open_data().parent_path() / "cases" / "tucked_layers";
  if (!std::filesystem::exists(given)) {
    WARN("skipped: no " << given);
    return;
  }
  const fake::Folder folder("untangle_tucked");
  UntangleRequest request;
  request.file = given / "both0.obj";
  request.bodies = {given / "body0.obj"};
  request.out = folder.path / "out.obj";
  const UntangleReport report = untangle_mesh(request);
  CHECK(report.result.pairs_before == 165);
  CHECK(is_clean(report));
}

}  // namespace selvedge::test_untangle_mesh
