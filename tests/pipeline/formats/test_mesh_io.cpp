#include <catch2/catch.hpp>

#include <cstring>

#include "collision/geometry/error.hpp"
#include "collision/geometry/surface.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_obj.hpp"
#include "pipeline/formats/mesh_ply.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_mesh_io {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Mesh read(const std::string& name, const std::string& text) {
  const Folder folder("mesh");
  return read_mesh(fake::write(folder, name, text));
}

std::string refusal(const std::string& name, const std::string& text) {
  try {
    read(name, text);
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

template <class T>
std::string bytes(T value, bool big) {
  std::string text(sizeof value, 0);
  std::memcpy(text.data(), &value, sizeof value);
  return big ? std::string(text.rbegin(), text.rend()) : text;
}

// A square of two vertex orders and types, with an element and properties that mean nothing here.
std::string binary_ply(bool big) {
  std::string text =
      "ply\nformat binary_" + std::string(big ? "big" : "little") +
      "_endian 1.0\ncomment by hand\nelement marker 1\nproperty list uchar short note\nelement vertex 4\n"
      "property uchar red\nproperty float z\nproperty double x\nproperty float32 y\n"
      "element face 1\nproperty int flags\nproperty list ushort uint vertex_index\nend_header\n";
  text += bytes<std::uint8_t>(2, big) + bytes<std::int16_t>(7, big) + bytes<std::int16_t>(-7, big);
  const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
  for (const auto& p : corners)
    text += bytes<std::uint8_t>(200, big) + bytes<float>(static_cast<float>(p[2]), big) + bytes<double>(p[0], big) +
            bytes<float>(static_cast<float>(p[1]), big);
  text += bytes<std::int32_t>(-1, big) + bytes<std::uint16_t>(4, big);
  for (std::uint32_t v = 0; v < 4; ++v) text += bytes<std::uint32_t>(v, big);
  return text;
}

const std::string ascii_ply =
    "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
    "property float s\r\nproperty float t\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
    "0 0 0 0 0\r\n1 0 0 1 0\r\n1 1 0 1 1\r\n0 1 0.5 0 1\r\n4 0 1 2 3\r\n";

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("OBJ: every form of an index, polygons, groups, continued lines", "[mesh_io]") {
  const Mesh mesh =
      read("a.obj",
           "# a comment\r\nmtllib x.mtl\r\no body\r\nv 0 0 0 1.0\r\nv 1 0 0\r\n  v\t1 1 0 # trailing\r\n"
           "v 0 1 \\\r\n 0\r\nv 0.5 2 1e-1\r\nvt 0 0\r\nvt 1 0 0\r\nvt 1 1\r\nvt 0 1\r\nvn 0 0 1\r\n"
           "g lower\r\nusemtl m\r\ns 1\r\nf 1/1/1 2/2/1 3/3/1 4/4/1\r\ng upper top\r\nf -3//1 -1//1 -2//1\r\n"
           "l 1 2\r\n");
  CHECK(mesh.x.rows() == 5);
  CHECK(mesh.x.row(3) == Eigen::RowVector3d(0, 1, 0));
  CHECK(mesh.x(4, 2) == 0.1);
  Triangles expected(3, 3);
  expected << 0, 1, 2, 0, 2, 3, 2, 4, 3;
  CHECK(mesh.triangles == expected);
  expected.row(2).setConstant(-1);
  CHECK(mesh.uv.rows() == 4);
  CHECK(mesh.uv_triangles == expected);
  REQUIRE(mesh.groups.size() == 4);
  CHECK(mesh.groups[0] == std::pair<std::string, std::vector<int>>("body", {0, 1, 2, 3, 4}));
  CHECK(mesh.groups[1] == std::pair<std::string, std::vector<int>>("lower", {0, 1, 2, 3}));
  CHECK(mesh.groups[3] == std::pair<std::string, std::vector<int>>("top", {2, 3, 4}));
  CHECK(mesh.warnings.empty());
}

TEST_CASE("OBJ: the rest of an o line is one name, each word of a g line is one", "[mesh_io]") {
  struct Case {
    std::string lines;
    std::vector<std::string> groups;
  };
  const std::string face = "f 1 2 3\n";
  for (const Case& c :
       {Case{"o Left sleeve\n" + face, {"Left sleeve"}}, Case{"o  Left \t sleeve \n" + face, {"Left sleeve"}},
        Case{"g cuff left\n" + face, {"cuff", "left"}},
        Case{"o Left sleeve\ng cuff hem\n" + face, {"Left sleeve", "cuff", "hem"}},
        Case{"o Left sleeve\n" + face + "o Right sleeve\n" + face, {"Left sleeve", "Right sleeve"}},
        Case{"o shirt\ng shirt\n" + face, {"shirt"}}, Case{"o Left sleeve\no\n" + face, {}}}) {
    CAPTURE(c.lines);
    std::vector<std::string> found;
    for (const auto& [name, vertices] : read("a.obj", triangle + c.lines).groups) found.push_back(name);
    CHECK(found == c.groups);
  }
}

TEST_CASE("Byte order marks are read over, unknown words counted, and what no OBJ file begins with is refused",
          "[mesh_io]") {
  const std::string faces = triangle + "v 1 1 0\nf 1 2 3\nf 2 4 3\n";
  const Mesh plain = read("a.obj", faces);
  const Mesh marked = read("a.obj", "\xEF\xBB\xBF" + faces);
  CHECK(marked.x == plain.x);
  CHECK(marked.triangles == plain.triangles);
  CHECK(marked.warnings.empty());
  CHECK(read("a.ply", "\xEF\xBB\xBF" + ascii_ply).x == read("a.ply", ascii_ply).x);
  CHECK_THAT(refusal("a.obj", std::string("\xFF\xFEv\0 \0", 6)), Contains("UTF-16") && Contains("UTF-8"));
  // A mark in the middle of a file, as files that were put together have it, hides a line.
  CHECK_THAT(refusal("a.obj", triangle + "\xEF\xBB\xBFv 1 1 0\nf 1 2 3\n"),
             Contains("a.obj:4") && Contains("word of OBJ"));
  const Mesh odd = read("a.obj", faces + "vertex 1 2 3\nF 1 2 3\nF 2 3 4\n");
  REQUIRE(odd.warnings.size() == 2);
  CHECK_THAT(odd.warnings[0], Contains("2 lines") && Contains("`F`"));
  CHECK_THAT(odd.warnings[1], Contains("1 line begins with") && Contains("`vertex`"));
}

TEST_CASE("A PLY file has one element of vertices", "[mesh_io]") {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  CHECK_THAT(refusal("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + xyz +
                                  "property float s\nproperty float t\nelement vertex 3\n" + xyz +
                                  "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                  "0 0 0 0.5 0.5\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
             Contains("two elements `vertex`") && Contains("leave one"));
}

TEST_CASE("Files whose lines end in carriage returns alone are read as others", "[mesh_io]") {
  const auto with_returns = [](std::string text) {
    std::ranges::replace(text, '\n', '\r');
    return text;
  };
  const std::string faces = "# corners\n" + triangle + "vn 0 0 1\nv 1 1 0\nf 1 2 3\nf 2 4 3\n";
  const Folder folder("returns");
  const auto path = fake::write(folder, "a.obj", with_returns(faces));
  const Mesh plain = read("b.obj", faces), mesh = read_mesh(path);
  CHECK(mesh.x == plain.x);
  CHECK(mesh.triangles == plain.triangles);
  std::vector<std::string> warnings;
  write_moved(path, folder.path / "moved.obj", 2 * mesh.x, mesh, warnings);
  CHECK(read_mesh(folder.path / "moved.obj").x == 2 * plain.x);
  CHECK_THAT(refusal("a.obj", with_returns(triangle + "f 1 2 4\n")), Contains("a.obj:4"));

  std::string text = ascii_ply;
  std::erase(text, '\r');
  CHECK(read("a.ply", with_returns(text)).x == read("a.ply", text).x);
  CHECK_THAT(refusal("a.ply", with_returns(text + "4 0 x")) + refusal("a.ply", with_returns("ply\nformat odd\n")),
             Contains("a.ply:2"));
  // Values keep their bytes, also those that read as ends of lines.
  text = binary_ply(false);
  const std::size_t values = text.find("end_header\n") + 11;
  std::string returns = with_returns(text.substr(0, values)) + text.substr(values);
  for (std::string* each : {&text, &returns}) (*each)[values + 1] = '\n', (*each)[values + 2] = '\r';
  CHECK(read("a.ply", returns).x == read("a.ply", text).x);
}

TEST_CASE("Vertices at one place are counted, and joined on request", "[mesh_io]") {
  // Two triangles that share an edge in space alone, with a rounding between them, and one that loses its area.
  Mesh mesh = read("a.obj", triangle +
                                "v 1 0 1e-8\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\ng left\nf 1/1 2/2 3/3\n"
                                "g right\nf 4/1 5/2 6/3\nf 2/1 4/2 5/3\n");
  CHECK(coincident_vertices(mesh.x) == 2);
  weld(mesh, "a.obj");
  CHECK(mesh.welded == std::vector<int>{0, 1, 2, 1, 3, 2});
  CHECK(mesh.x.rows() == 4);
  Triangles expected(2, 3);
  expected << 0, 1, 2, 1, 3, 2;
  CHECK(mesh.triangles == expected);
  CHECK(mesh.uv_triangles.rows() == 2);
  CHECK(mesh.groups[1].second == std::vector<int>{1, 2, 3});
  CHECK_THAT(mesh.warnings.back(), Contains("1 degenerate"));
  CHECK(coincident_vertices(mesh.x) == 0);
  // Cubes of the search and their neighbours: chains across their faces, and the same answer as comparing all.
  Points line(300, 3);
  for (int k = 0; k < 300; ++k) line.row(k) << (k % 100) * 0.01, (k / 100) * 0.4e-6, k == 299 ? 1 : 0;
  CHECK(coincident_vertices(line) == 199);
}

TEST_CASE("Triangles that lie on others are counted", "[mesh_io]") {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const Mesh mesh = read("a.obj", square + square + "f 1 2 3 4\nf 8 7 6 5\n");
  CHECK(coincident_triangles(mesh.x, mesh.triangles) == 2);
  CHECK(coincident_triangles(mesh.x, mesh.triangles.topRows(2)) == 0);
}

TEST_CASE("PLY: text and both byte orders give the same mesh", "[mesh_io]") {
  const Mesh text = read("a.ply", ascii_ply), little = read("a.ply", binary_ply(false)),
             big = read("a.PLY", binary_ply(true));
  Triangles expected(2, 3);
  expected << 0, 1, 2, 0, 2, 3;
  for (const Mesh* mesh : {&text, &little, &big}) {
    CHECK(mesh->triangles == expected);
    CHECK(mesh->x == text.x);
    CHECK(mesh->x(3, 2) == 0.5);
  }
  CHECK(text.uv.rows() == 4);
  CHECK(text.uv_triangles == expected);
}

TEST_CASE("Meshes written are read back bit for bit", "[mesh_io]") {
  const Folder folder("mesh");
  Points x(4, 3);
  x << 0.1, 1.0 / 3, -1e-300, 1e8, -0.0, 3, 1, 1, 1, 2, 5, 7;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 2, 1, 3;
  write_obj(folder.path / "a.obj", x, triangles);
  write_ply(folder.path / "a.ply", x, triangles);
  for (const char* name : {"a.obj", "a.ply"}) {
    const Mesh mesh = read_mesh(folder.path / name);
    CHECK(mesh.x == x);
    CHECK(mesh.triangles == triangles);
  }
  CHECK_THROWS_AS(write_obj(folder.path / "no" / "such" / "a.obj", x, triangles), Error);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path)) files += entry.exists();
  CHECK(files == 2);  // nothing half written is left
}

TEST_CASE("Triangles that repeat are left out and counted, the rest of a mesh's faults are counted", "[mesh_io]") {
  const Mesh mesh =
      read("a.obj", triangle + "v 0 0 1\nv 0 0 -1\nv 9 9 9\nf 1 2 3\nf 1 1 2\nf 3 1 2\nf 1 3 2\nf 1 2 4\nf 1 2 5\n");
  CHECK(mesh.triangles.rows() == 3);
  REQUIRE(mesh.warnings.size() == 4);
  CHECK_THAT(mesh.warnings[0], Contains("1 degenerate triangle "));
  CHECK_THAT(mesh.warnings[1], Contains("2 duplicate triangles"));
  CHECK_THAT(mesh.warnings[2], Contains("1 non-manifold edge "));
  CHECK_THAT(mesh.warnings[3], Contains("1 isolated vertex "));
}

TEST_CASE("The back of a two-sided polygon is a repeated one", "[mesh_io]") {
  const Mesh mesh = read("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 4 3 2 1\n");
  CHECK(mesh.triangles.rows() == 2);
  REQUIRE(mesh.warnings.size() == 1);
  CHECK_THAT(mesh.warnings[0], Contains("2 duplicate triangles"));
}

TEST_CASE("Bad OBJ files are refused with file and line", "[mesh_io]") {
  const auto [text, words] = GENERATE_COPY(table<std::string, std::vector<std::string>>({
      {"", {"a.obj", "empty"}},
      {"# nothing\n", {"no vertices"}},
      {triangle, {"no faces"}},
      {triangle + "f 1 1 2\n", {"no faces"}},
      {"v 0 0 nan\n", {"a.obj:1", "not finite"}},
      {triangle + "v 0 inf 0\nf 1 2 3\n", {"a.obj:4", "not finite"}},
      {"v 0 0 1e999\n", {"a.obj:1", "not finite"}},
      {"v 0 0 -1e308\n", {"a.obj:1", "absurd", "-1e308"}},
      {"v 0 0\n", {"a.obj:1", "2 coordinates"}},
      {"v 0 0 x\n", {"a.obj:1", "`x`"}},
      {triangle + "f 1 2 4\n", {"a.obj:4", "vertex 4", "has 3"}},
      {triangle + "f 1 2 0\n", {"a.obj:4", "out of range"}},
      {triangle + "f 1 2 -4\n", {"a.obj:4", "out of range"}},
      {triangle + "f 1 2 99999999999\n", {"a.obj:4", "not an index"}},
      {triangle + "f 1 2 3.5\n", {"a.obj:4", "not an index"}},
      {triangle + "f 1 2\n", {"a.obj:4", "2 corners"}},
      {triangle + "vt 0 0\nf 1/1 2/2 3/1\n", {"a.obj:5", "texture vertex 2"}},
      {triangle + "f 1/a 2/2 3/1\n", {"a.obj:4", "`a`"}},
  }));
  const std::string message = refusal("a.obj", text);
  INFO(text << " -> " << message);
  for (const std::string& word : words) CHECK_THAT(message, Contains(word));
}

TEST_CASE("Bad PLY files are refused with file and place", "[mesh_io]") {
  const auto replaced = [](const std::string& what, const std::string& by) {
    std::string text = ascii_ply;
    return text.replace(text.find(what), what.size(), by);
  };
  const auto [text, words] = GENERATE_COPY(table<std::string, std::vector<std::string>>({
      {"", {"empty"}},
      {"plx\n", {"a.ply:1", "not a PLY"}},
      {"ply\n", {"ends too early"}},
      {replaced("ascii", "morse"), {"a.ply:2", "morse"}},
      {replaced("float x", "real x"), {"a.ply:4", "real"}},
      {replaced("float x", "float w"), {"no x, y and z"}},
      {replaced("vertex_indices", "corners"), {"vertex_indices"}},
      {replaced("vertex 4", "vertex 400000000"), {"do not fit"}},
      {replaced("vertex 4", "vertex -4"), {"a.ply:3"}},
      {replaced("\r\n1 0 0 1 0", "\r\n1 nan 0 1 0"), {"a.ply:13", "not finite"}},
      {replaced("\r\n1 0 0 1 0", "\r\n1 q 0 1 0"), {"a.ply:13", "`q`"}},
      {replaced("\r\n1 0 0 1 0", "\r\n1 1e300 0 1 0"), {"a.ply:13", "absurd", "1e+300"}},
      {replaced("\r\n1 0 0 1 0", "\r\n1 1e18 0 1 0"), {"a.ply:13", "absurd", "1e+18", "1e+09 is the largest"}},
      {replaced("4 0 1 2 3", "4 0 1 2 7"), {"face 0", "vertex 7"}},
      {replaced("4 0 1 2 3", "4 0 1 2 -1"), {"-1"}},
      {replaced("4 0 1 2 3", "2 0 1"), {"2 corners"}},
      {replaced("4 0 1 2 3", "4 0 1 2"), {"ends too early"}},
      {replaced("4 0 1 2 3", "1e9 0 1 2 3"), {"does not fit"}},
      {replaced("face 1", "face 0"), {"no faces"}},
  }));
  const std::string message = refusal("a.ply", text);
  INFO(message);
  for (const std::string& word : words) CHECK_THAT(message, Contains(word));
}

TEST_CASE("Files that are not there or of unknown kind are refused", "[mesh_io]") {
  CHECK_THROWS_WITH(read_mesh("nowhere.obj"), Contains("nowhere.obj") && Contains("cannot be opened"));
  CHECK_THROWS_WITH(read_mesh("mesh.stl"), Contains("export it as .obj or .ply"));
  CHECK_THROWS_AS(read_mesh(std::filesystem::temp_directory_path()), Error);
  const Folder folder("mesh");
  std::filesystem::create_directory(folder.path / "a.obj");
  CHECK_THROWS_WITH(read_mesh(folder.path / "a.obj"), Contains("folder"));
}

TEST_CASE("No part of a mesh file crashes the readers", "[mesh_io]") {
  const auto attempt = [](const std::string& name, const std::string& text) {
    try {
      const Mesh mesh = name == "a.obj" ? parse_obj(text, name) : parse_ply(text, name);
      CHECK((mesh.triangles.size() == 0 || mesh.triangles.minCoeff() >= 0));
      CHECK((mesh.triangles.size() == 0 || mesh.triangles.maxCoeff() < mesh.x.rows()));
      CHECK(mesh.x.allFinite());
    } catch (const Error&) {
    }
  };
  const std::string obj =
      triangle + "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1/1 2/2/2 3/3/3\ng a b\nf -1//2 -2 -3/1\nf 1 \\\n2 3\n";
  for (const auto& [name, text] : {std::pair<std::string, std::string>("a.obj", obj),
                                   {"a.ply", ascii_ply},
                                   {"a.ply", binary_ply(false)},
                                   {"a.ply", binary_ply(true)}})
    for (std::size_t at = 0; at < text.size(); ++at) {
      attempt(name, text.substr(0, at));
      std::string torn = text;
      torn[at] = static_cast<char>(torn[at] ^ (1 << (at % 8)));
      attempt(name, torn);
      torn[at] = '\xFF';
      attempt(name, torn);
    }
}

TEST_CASE("Meshes made by others are read", "[mesh_io]") {
  const std::filesystem::path data = fake::open_data();
  if (!std::filesystem::exists(data / "makehuman")) {
    WARN("skipped: the open data is absent");
    return;
  }
  const Mesh shirt = read_mesh(data / "diffcloth/tshirt1900.obj");
  CHECK(shirt.x.rows() == 1921);
  CHECK(shirt.uv_triangles.rows() == shirt.triangles.rows());
  CHECK(shirt.warnings.empty());
  const Mesh body = read_mesh(data / "makehuman/body.obj");
  CHECK(body.x.rows() == 13380);
  CHECK(body.triangles.rows() == 26756);
  CHECK(is_closed(make_surface(static_cast<int>(body.x.rows()), body.triangles)));
  CHECK(read_mesh(data / "meshes/two-cubes-far.ply").triangles.rows() == 480);
}

}  // namespace selvedge::test_mesh_io
