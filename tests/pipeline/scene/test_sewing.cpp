#include <catch2/catch.hpp>

#include <algorithm>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "physics/energies/measures.hpp"
#include "physics/scene/features.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/frame.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_sewing {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Setup read(const Folder& folder, const std::string& scene) {
  return read_setup(fake::write(folder, "scene.yaml", scene));
}

// An OBJ file in the making. Texture coordinates are the vertices' places on their panels, in cm.
struct Obj {
  std::string text;
  int vertices = 0;

  int vertex(const Vec3& at, double u, double v) {
    text += fmt::format("v {} {} {}\nvt {} {}\n", at.x(), at.y(), at.z(), 100 * u, 100 * v);
    return vertices++;
  }
  void face(std::initializer_list<int> corners) {
    text += "f";
    for (const int c : corners) text += fmt::format(" {}/{}", c + 1, c + 1);
    text += "\n";
  }
  // columns x rows cells, upright; returns the first vertex, those of a row on end from left to right, rows from below.
  int panel(const std::string& name, int columns, int rows, double width, double height, const Vec3& corner,
            bool turned) {
    const int first = vertices;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) {
        const double u = width * i / columns, v = height * j / rows;
        vertex(corner + Vec3(u, v, 0), u, v);
      }
    text += "g " + name + "\n";
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const int a = first + j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = c - 1;
        turned ? face({a, d, c, b}) : face({a, b, c, d});
      }
    return first;
  }
};

constexpr int columns = 6, rows = 9, panel_size = 70;

// Front and back of a tube, 4 cm apart; both sides sewn.
std::string tube_file(bool back_turned = true) {
  Obj obj;
  obj.panel("front", columns, rows, 0.2, 0.3, {-0.1, 0, 0.02}, false);
  obj.panel("back", columns, rows, 0.2, 0.3, {-0.1, 0, -0.02}, back_turned);
  return obj.text;
}

// The vertices of a side of a tube's panel, from below.
std::string side(int panel, bool right) {
  std::string list;
  for (int j = 0; j <= rows; ++j)
    list +=
        fmt::format("{}{}", list.empty() ? "" : ", ", panel * panel_size + j * (columns + 1) + (right ? columns : 0));
  return "[" + list + "]";
}

std::string tube_scene(const std::string& more = "", const std::string& rest = "{from: uv, uv_unit: 1 cm}") {
  return "cloths:\n  - name: tube\n    mesh: tube.obj\n    rest: " + rest +
         "\n    seams:\n      - {from: {vertices: " + side(0, false) + "}, to: {vertices: " + side(1, false) +
         "}}\n      - {from: {vertices: " + side(0, true) + "}, to: {vertices: " + side(1, true) + "}}\n" + more;
}

bool warned(const Setup& setup, const std::string& words) {
  return std::ranges::any_of(setup.warnings, [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

State run(const Setup& setup, int frames) {
  const auto stepper = make_stepper(setup);
  State state = setup.initial, to;
  for (int f = 1; f <= frames; ++f) {
    const StepReport report =
        testing::frame(setup.scene, *stepper, state, setup.drive_at(f / setup.run.fps), 1 / setup.run.fps, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.collision.pairs_after == 0);
    CHECK(report.collision.passed_through == 0);
    state = to;
  }
  return state;
}

const std::string two_sheets =
    "cloths:\n"
    "  - {name: a, rectangle: {resolution: 3, size: 0.2}, pins: [{group: boundary}]}\n"
    "  - {name: b, rectangle: {resolution: 3, size: 0.2}, translate: [0, -3 mm, 0], copies: {count: 2, translate: [0, "
    "-3 mm, 0]}}\n";

}  // namespace

TEST_CASE("sewing: springs join vertices one by one as listed, copies by their names", "[sewing]") {
  const Folder folder("sewing");
  const Setup setup = read(folder, two_sheets +
                                       "springs:\n"
                                       "  - {from: {cloth: a, vertices: [7, 3, 3]}, to: {cloth: b_1, vertices: [0, 8, "
                                       "1]}, rest_length: 4 mm, stiffness: 2 kN/m}\n"
                                       "  - {from: {cloth: b_0, group: left}, to: {cloth: b_1, group: right}}\n");
  const std::vector<Spring>& springs = setup.scene.springs;
  REQUIRE(springs.size() == 6);
  CHECK((springs[0].a == 7 && springs[0].b == 18 && springs[0].rest_length == 4e-3 && springs[0].stiffness == 2000));
  CHECK((springs[1].a == 3 && springs[1].b == 26));
  CHECK((springs[2].a == 3 && springs[2].b == 19));
  for (int k = 0; k < 3; ++k) {
    CHECK((springs[3 + k].a == 9 + 3 * k && springs[3 + k].b == 20 + 3 * k));
    CHECK(
        (springs[3 + k].rest_length == ContactSettings{}.thickness && springs[3 + k].stiffness == Spring{}.stiffness));
  }
  CHECK(features_of(setup.scene).springs);
  CHECK(setup.warnings.empty());
  fake::write(folder, "again.yaml", setup.config);
  const Setup again = read_setup(folder.path / "again.yaml");
  CHECK(again.scene.springs.size() == 6);
  CHECK(again.config == setup.config);
}

TEST_CASE("sewing: stitches go to the nearest vertex and keep their distance", "[sewing]") {
  const Folder folder("sewing");
  const Setup setup = read(folder,
                           "cloths:\n"
                           "  - {name: a, rectangle: {resolution: 3, size: 0.2}}\n"
                           "  - {name: b, rectangle: {resolution: 5, size: 0.2}, translate: [0.01, 0.03, 0]}\n"
                           "springs:\n"
                           "  - {from: a, to: b, pair: nearest}\n"
                           "  - {from: {cloth: a, vertices: 0}, to: {cloth: b, group: right}, pair: nearest, "
                           "rest_length: 1 cm}\n");
  const std::vector<Spring>& springs = setup.scene.springs;
  REQUIRE(springs.size() == 10);
  for (int i = 0; i < 9; ++i) {
    CHECK(springs[i].a == i);
    CHECK(springs[i].b == 9 + 2 * (i % 3) + 5 * 2 * (i / 3));
    CHECK(springs[i].rest_length == Approx(std::hypot(0.01, 0.03)));
  }
  CHECK((springs[9].a == 0 && springs[9].b == 9 + 4 && springs[9].rest_length == 0.01));
}

TEST_CASE("sewing: springs shorter than the thickness are warned of, unless cloth does not meet cloth", "[sewing]") {
  const Folder folder("sewing");
  const std::string scene = two_sheets +
                            "springs: [{from: {cloth: a, vertices: [1, 2]}, to: {cloth: b_0, vertices: [1, 2]}, "
                            "rest_length: 1 mm}]\n";
  CHECK(warned(read(folder, scene), "springs.0: 2 springs are shorter at rest than contact.thickness 0.002 m"));
  CHECK_FALSE(warned(read(folder, scene + "contact: {thickness: 1 mm}\n"), "springs"));
  CHECK_FALSE(warned(read(folder, scene + "contact: {self: false}\n"), "springs"));
}

TEST_CASE("sewing: springs that cannot be are errors with the place", "[sewing]") {
  const Folder folder("sewing");
  const auto with = [&](const std::string& spring) { read(folder, two_sheets + "springs:\n  - {" + spring + "}\n"); };
  CHECK_THROWS_WITH(with("from: {cloth: a, vertices: [1, 2]}, to: {cloth: b_0, vertices: 1}"),
                    Contains("`springs.0` pairs 2 vertices with 1") && Contains("scene.yaml:5"));
  CHECK_THROWS_WITH(with("from: {cloth: a, vertices: 9}, to: {cloth: b_0, vertices: 1}"),
                    Contains("`springs.0.from.vertices` names vertex 9"));
  CHECK_THROWS_WITH(with("from: {cloth: a, vertices: 1}, to: {cloth: b, vertices: 1}"),
                    Contains("names `b`") && Contains("known: a, b_0, b_1"));
  CHECK_THROWS_WITH(with("from: {vertices: 1}, to: {cloth: b_0, vertices: 1}"),
                    Contains("does not say of which cloth"));
  CHECK_THROWS_WITH(with("from: {cloth: a, vertices: [0, 1]}, to: {cloth: a, vertices: [2, 1]}"),
                    Contains("a vertex with itself, the one at place 1"));
  CHECK_THROWS_WITH(with("from: a, to: a, pair: nearest"), Contains("a vertex with itself"));
  CHECK_THROWS_WITH(with("from: a, to: b_0, stiffness: 0"), Contains("above 0"));
}

TEST_CASE("sewing: cloths on one button hang, in two threads as in one", "[sewing][threads]") {
  const Folder folder("sewing");
  const Setup setup = read(folder, two_sheets +
                                       "springs:\n"
                                       "  - {from: {cloth: a, group: center}, to: {cloth: b_0, group: center}}\n"
                                       "  - {from: {cloth: b_0, vertices: 0}, to: {cloth: b_1, vertices: 0}}\n"
                                       "run: {fps: 60}\n");
  State ends[2];
  for (int k = 0; k < 2; ++k) with_threads(k + 1, [&] { ends[k] = run(setup, 60); });
  CHECK(same_bits(ends[0].x, ends[1].x));
  for (const Spring& spring : setup.scene.springs)
    CHECK((row(ends[0].x, spring.b) - row(ends[0].x, spring.a)).norm() == Approx(2e-3).margin(2e-4));
  CHECK(ends[0].x.middleRows(9, 9).col(1).minCoeff() < -0.02);
}

TEST_CASE("sewing: a rectangle cut in two and sewn is the rectangle, and moves as it does", "[sewing]") {
  const Folder folder("sewing");
  // The right half's left edge, cut off, is numbered last, so that sewing closes no gaps.
  Obj whole, cut;
  for (Obj* obj : {&whole, &cut}) {
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i) obj->vertex({0.1 * i, 0.1 * j, 0}, 0.1 * i, 0.1 * j);
    for (int j = 0; j < 4 && obj == &cut; ++j) obj->vertex({0.2, 0.1 * j, 0}, 0.2, 0.1 * j);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) {
        const auto corner = [&](int k, int l) { return obj == &cut && i >= 2 && k == 2 ? 20 + l : 5 * l + k; };
        obj->face({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
      }
  }
  fake::write(folder, "whole.obj", whole.text);
  fake::write(folder, "cut.obj", cut.text);
  fake::write(folder, "pairs.txt", "# left right\n2 20\n21 7\n\n  12 22 # the middle\n17 23\n");
  const std::string pins = ", pins: [{vertices: [15, 19]}]}]\n";
  const Setup one = read(folder, "cloths: [{mesh: whole.obj, rest: {from: uv, uv_unit: 1 cm}" + pins);
  const Setup sewn =
      read(folder, "cloths: [{mesh: cut.obj, rest: {from: uv, uv_unit: 1 cm}, seams: [{file: pairs.txt}]" + pins);
  CHECK(sewn.warnings.empty());
  CHECK(sewn.scene.surface.triangles == one.scene.surface.triangles);
  CHECK(sewn.scene.rest_triangle == one.scene.rest_triangle);
  CHECK(same_bits(sewn.scene.rest, one.scene.rest));
  CHECK(sewn.scene.pins == one.scene.pins);
  CHECK(same_bits(run(sewn, 5).x, run(one, 5).x));
  // Listed, and by the nearest.
  for (const char* how : {"from: {vertices: [2, 7, 12, 17]}, to: {vertices: [20, 21, 22, 23]}",
                          "from: {vertices: [23, 22, 21, 20]}, to: {vertices: [1, 2, 7, 12, 17]}, pair: nearest"})
    CHECK(read(folder, "cloths: [{mesh: cut.obj, seams: [{" + std::string(how) + "}]" + pins).scene.surface.triangles ==
          one.scene.surface.triangles);
}

TEST_CASE("sewing: what a scene lists has the numbers of the file, also where the mesh is welded", "[sewing]") {
  const Folder folder("sewing_welded");
  // Three panels in a row: the first two meet in two vertices, the third has a gap.
  Obj obj;
  const int first = obj.panel("a", 1, 1, 0.1, 0.1, {0, 0, 0}, false),
            second = obj.panel("b", 1, 1, 0.1, 0.1, {0.1, 0, 0}, false),
            third = obj.panel("c", 1, 1, 0.1, 0.1, {0.21, 0, 0}, false);
  REQUIRE((first == 0 && second == 4 && third == 8));
  fake::write(folder, "row.obj", obj.text);
  fake::write(folder, "pairs.txt", "5 8\n7 10\n1 4\n");  // the last pair is welded already
  const std::string list =
      "pins: [{vertices: [4, 7]}]}]\n"
      "springs: [{from: {cloth: row, vertices: [4, 7]}, to: {cloth: row, vertices: [9, 11]}}]\n";
  const Setup welded = read(folder, "cloths: [{name: row, mesh: {file: row.obj, weld: true}, " + list);
  CHECK(welded.scene.surface.vertex_count == 10);
  CHECK(welded.scene.pins == std::vector<int>{1, 5});
  REQUIRE(welded.scene.springs.size() == 2);
  CHECK((welded.scene.springs[0].a == 1 && welded.scene.springs[0].b == 7));
  CHECK((welded.scene.springs[1].a == 5 && welded.scene.springs[1].b == 9));
  for (const char* seams : {"{file: pairs.txt}", "{from: {vertices: [5, 7]}, to: {vertices: [8, 10]}}"}) {
    const Setup sewn = read(
        folder, fmt::format("cloths: [{{name: row, mesh: {{file: row.obj, weld: true}}, seams: [{}], {}", seams, list));
    CHECK(sewn.scene.surface.vertex_count == 8);
    CHECK(sewn.scene.pins == std::vector<int>{1, 5});
    CHECK((sewn.scene.springs[0].b == 6 && sewn.scene.springs[1].b == 7));
  }
  CHECK_THROWS_WITH(read(folder, "cloths: [{mesh: {file: row.obj, weld: true}, pins: [{vertices: [12]}]}]"),
                    Contains("allowed: 0 to 11"));
}

TEST_CASE("sewing: two panels become a tube that starts in the middle and keeps the panels' rest shape", "[sewing]") {
  const Folder folder("sewing");
  fake::write(folder, "tube.obj", tube_file());
  const Setup setup = read(folder, tube_scene());
  const Surface& surface = setup.scene.surface;
  CHECK(surface.vertex_count == 2 * panel_size - 2 * (rows + 1));
  CHECK((surface.component_count == 1 && surface.nonmanifold_edges == 0 && surface.isolated_vertices == 0));
  CHECK(boundary_loops(surface).size() == 2);
  CHECK(setup.scene.rest.rows() == surface.vertex_count);
  CHECK(setup.initial.x(0, 2) == Approx(0).margin(1e-15));  // sewn
  CHECK(setup.initial.x(1, 2) == Approx(0.02));
  CHECK(setup.initial.x(panel_size, 2) == Approx(-0.02));  // the first of the back that is not
  for (int t = 0; t < surface.triangles.rows(); ++t)
    CHECK(std::abs(area(setup.scene.rest_triangle[t])) == Approx(0.5 * 0.2 / columns * 0.3 / rows));
  CHECK(lumped_masses(setup.scene).sum() == Approx(0.12 * Material{}.density));
  REQUIRE(setup.warnings.size() == 1);
  const double stretch = std::hypot(0.2 / columns, 0.02) / (0.2 / columns);
  CHECK_THAT(setup.warnings[0], Contains("`tube`: sewn vertices are up to 0.04 m apart") &&
                                    Contains(fmt::format("factor of up to {:.3g}", stretch)));
  // The panels as they lie have the same rest shape.
  const Setup initial = read(folder, tube_scene("", "initial"));
  for (std::size_t t = 0; t < setup.scene.rest_triangle.size(); ++t)
    CHECK(std::abs(area(initial.scene.rest_triangle[t])) == Approx(std::abs(area(setup.scene.rest_triangle[t]))));
}

TEST_CASE("sewing: a sewn tube hangs whole, and its rest shape stays unstressed", "[sewing]") {
  const Folder folder("sewing");
  fake::write(folder, "tube.obj", tube_file());
  // The top: numbers of the file, of which those of the back's sides are sewn to the front's.
  const Setup setup =
      read(folder, tube_scene(fmt::format("    pins: [{{vertices: [{}, {}, {}, {}]}}]\nrun: {{fps: 60}}\n", rows * 7,
                                          panel_size - 1, panel_size + rows * 7, 2 * panel_size - 4)));
  CHECK(setup.scene.pins.size() == 3);
  CHECK(setup.scene.pins[0] == rows * 7);
  CHECK(setup.scene.pins[1] == panel_size - 1);
  CHECK(row(setup.initial.x, setup.scene.pins[2]).isApprox(Vec3(0, 0.3, -0.02)));
  const State end = run(setup, 60);
  CHECK(end.x.col(1).minCoeff() > -0.02);
  CHECK(principal_stretches(setup.scene, end.x).col(1).maxCoeff() < 1.1);
  const Points still = Points::Zero(end.x.rows(), 3);
  CHECK(energies(setup.scene, end.x, still, Vec3::Zero()).membrane <
        0.01 * energies(setup.scene, setup.initial.x, still, Vec3::Zero()).membrane);
}

TEST_CASE("sewing: groups, boxes, springs and outcomes go with the seams, copies are sewn too", "[sewing]") {
  const Folder folder("sewing");
  fake::write(folder, "tube.obj", tube_file());
  const Setup setup =
      read(folder, tube_scene(fmt::format("    copies: {{count: 2, translate: [1, 0, 0]}}\n"
                                          "    pins: [{{group: back}}, {{box: {{min: [-2, 0.29, -1], max: [2, 1, "
                                          "1]}}}}]\n"
                                          "springs: [{{from: {{cloth: tube_1, vertices: [{}, 1]}}, to: "
                                          "{{cloth: tube_0, vertices: [{}, {}]}}, rest_length: 1}}]\n"
                                          "outcome: [{{name: x, drift: {{of: {{cloth: tube_1, vertices: {}}}}}}}]\n",
                                          panel_size, panel_size + 1, 2 * panel_size - 1, panel_size)));
  const int count = 2 * panel_size - 2 * (rows + 1);
  CHECK(setup.scene.cloths[1].first_vertex == count);
  CHECK(setup.scene.pins.size() == 2 * (panel_size + columns - 1));  // the back and the front's top between its corners
  const std::vector<Spring>& springs = setup.scene.springs;
  CHECK(
      (springs[0].a == count && springs[0].b == panel_size));  // the back's first is the front's, its second comes next
  CHECK((springs[1].a == count + 1 && springs[1].b == panel_size - 1));
  CHECK(std::get<Drift>(setup.outcomes[0].measure).vertices == std::vector<int>{count});
  CHECK(setup.initial.x.bottomRows(count).isApprox(setup.initial.x.topRows(count).rowwise() +
                                                   Eigen::RowVector3d(1, 0, 0)));
}

TEST_CASE("sewing: three panels in a corner become one vertex, in the middle of all", "[sewing]") {
  const Folder folder("sewing");
  Obj obj;
  const double third = 2 * M_PI / 3;
  for (int p = 0; p < 3; ++p) {  // rhombs about the origin, drawn away from it
    const auto at = [&](double angle, double r) { return Vec3(r * std::cos(angle), r * std::sin(angle), 0); };
    const Vec3 away = at(third * p, 0.03), left = at(third * (p - 0.5), 0.1), right = at(third * (p + 0.5), 0.1);
    const int centre = obj.vertex(away, 0, 0), a = obj.vertex(away + left, 1e-1, 0),
              tip = obj.vertex(away + left + right, 5e-2, 9e-2), b = obj.vertex(away + right, -5e-2, 9e-2);
    obj.face({centre, a, tip, b});
  }
  fake::write(folder, "corner.obj", obj.text);
  const Setup setup =
      read(folder,
           "cloths: [{mesh: corner.obj, seams: [{from: {vertices: [0, 3]}, to: {vertices: [4, 5]}}, {from: "
           "{vertices: [4, 7]}, to: {vertices: [8, 9]}}, {from: {vertices: [8, 11]}, to: {vertices: [0, "
           "1]}}], pins: [{vertices: [8, 9]}]}]\n");
  CHECK(setup.scene.surface.vertex_count == 7);
  CHECK(boundary_loops(setup.scene.surface).size() == 1);
  CHECK(row(setup.initial.x, 0).norm() < 1e-15);
  CHECK(setup.scene.surface.triangles_of(0).size() == 6);
  CHECK(setup.scene.pins == std::vector<int>{0, 5});
}

TEST_CASE("sewing: what does not leave a manifold is an error with the pair", "[sewing]") {
  const Folder folder("sewing");
  fake::write(folder, "tube.obj", tube_file());
  const auto with = [&](const std::string& seam) {
    return read(folder, "cloths: [{mesh: tube.obj, seams: [{" + seam + "}]}]\n");
  };
  CHECK_THROWS_WITH(with("from: {vertices: 0}, to: {vertices: 1}"),
                    Contains("`cloths.0.seams.0` sews vertices 0 and 1") && Contains("of triangle 0 become one"));
  CHECK_THROWS_WITH(with("from: {vertices: 0}, to: {vertices: 70}"),
                    Contains("vertices 0 and 70") && Contains("meet in a point"));
  CHECK_THROWS_WITH(with("from: {vertices: 10}, to: {vertices: [80]}"),
                    Contains("10 and 80") && Contains("meet in a point"));
  CHECK_THROWS_WITH(with("from: {vertices: [9, 10, 16, 17]}, to: {vertices: [79, 80, 86, 87]}"),
                    Contains("two triangles"));
  CHECK_THROWS_WITH(with("from: {vertices: [9, 10]}, to: {vertices: [79, 80]}"),
                    Contains("more than two triangles meet in an edge"));
  CHECK_THROWS_WITH(with("from: {vertices: [0, 7]}, to: {vertices: [70]}"), Contains("pairs 2 vertices with 1"));
  CHECK_THROWS_WITH(with("from: {vertices: [0, 7]}, to: {vertices: [70, 140]}"),
                    Contains("names vertex 140") && Contains("0 to 139"));
  CHECK_THROWS_WITH(with("from: {vertices: [0, 7]}, to: {vertices: [0, 7]}"), Contains("itself"));
  CHECK_THROWS_WITH(with("from: {vertices: [0, 7]}"), Contains("needs `from` and `to`"));
  CHECK_THROWS_WITH(with("file: tube.obj, to: {vertices: 1}"), Contains("needs `from` and `to`, or `file`"));
  CHECK_THROWS_WITH(with("from: {}, to: {vertices: 1}"), Contains("exactly one"));
  for (const char* line : {"1", "1 2 3", "1 x", "a b"}) {
    fake::write(folder, "pairs.txt", "0 70\n" + std::string(line) + "\n");
    CHECK_THROWS_WITH(with("file: pairs.txt"), Contains("pairs.txt:2") && Contains("not a pair"));
  }
  fake::write(folder, "pairs.txt", "0 140\n");
  CHECK_THROWS_WITH(with("file: pairs.txt"), Contains("pairs.txt:1") && Contains("names vertex 140"));
  fake::write(folder, "pairs.txt", "\n3 3\n");
  CHECK_THROWS_WITH(with("file: pairs.txt"), Contains("pairs.txt:2") && Contains("itself"));
  CHECK_THROWS_AS(with("file: none.txt"), Error);
}

TEST_CASE("sewing: panels that face opposite ways are warned of", "[sewing]") {
  const Folder folder("sewing");
  fake::write(folder, "tube.obj", tube_file(false));
  CHECK(warned(read(folder, tube_scene()),
               fmt::format("`tube`: panels face opposite ways along {} sewn edges", 2 * rows)));
}

}  // namespace selvedge::test_sewing
