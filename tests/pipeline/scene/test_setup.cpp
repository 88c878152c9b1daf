#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/scene/setup_cloth.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_setup {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

std::filesystem::path config(const std::string& name) { return source_root() / "configs" / name; }

Setup read(const Folder& folder, const std::string& scene) {
  return read_setup(fake::write(folder, "scene.yaml", scene));
}

void check_consistent(const Setup& setup) {
  const Scene& scene = setup.scene;
  CHECK(scene.rest_triangle.size() == static_cast<std::size_t>(scene.surface.triangles.rows()));
  CHECK(scene.rest.rows() == scene.surface.vertex_count);
  CHECK(setup.initial.x.rows() == scene.surface.vertex_count);
  CHECK(setup.initial.v.rows() == scene.surface.vertex_count);
  CHECK(setup.initial.x.allFinite());
  CHECK(std::is_sorted(scene.pins.begin(), scene.pins.end()));
  for (const RestTriangle& triangle : scene.rest_triangle) CHECK(area(triangle) > 0);
  const Drive drive = setup.drive_at(0.7);
  CHECK(drive.pins.rows() == static_cast<Eigen::Index>(scene.pins.size()));
  REQUIRE(drive.obstacles.size() == scene.obstacles.size());
  for (std::size_t o = 0; o < scene.obstacles.size(); ++o)
    CHECK(drive.obstacles[o].rows() == scene.obstacles[o].surface.vertex_count);
}

// Largest difference of an edge's length in the rest triangles and in x.
double metric_error(const Scene& scene, const Points& x) {
  double error = 0;
  for (int t = 0; t < scene.surface.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const RestTriangle& rest = scene.rest_triangle[static_cast<std::size_t>(t)];
      const Vec3 edge = row(x, scene.surface.triangles(t, (k + 1) % 3)) - row(x, scene.surface.triangles(t, k));
      error = std::max(error, std::abs((rest.col((k + 1) % 3) - rest.col(k)).norm() - edge.norm()));
    }
  return error;
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("Shipped scenes read without warnings", "[setup]") {
  for (const char* name : {"demo.yaml", "fall.yaml", "bench/hang.yaml", "bench/drop.yaml", "bench/tube.yaml"}) {
    INFO(name);
    const Setup setup = read_setup(config(name));
    CHECK(setup.warnings.empty());
    check_consistent(setup);
    CHECK(setup.scene.surface.nonmanifold_edges == 0);
    CHECK(setup.drive_at(0).acceleration.y() == -9.81);
    CHECK(metric_error(setup.scene, setup.initial.x) < 1e-12);  // all start unstressed
  }
}

TEST_CASE("The benchmark scenes have N x N vertices", "[setup]") {
  CHECK(read_setup(config("bench/hang.yaml"), {"cloths.0.rectangle.resolution=40"}).scene.surface.vertex_count == 1600);
  CHECK(read_setup(config("bench/drop.yaml"), {"cloths.0.rectangle.resolution=40"}).scene.surface.vertex_count == 1600);
  CHECK(read_setup(config("bench/tube.yaml"), {"cloths.sleeve.tube.resolution=40"}).scene.surface.vertex_count == 1600);
}

TEST_CASE("Scenes with other people's data read", "[setup]") {
  if (!std::filesystem::exists(fake::open_data() / "makehuman")) {
    WARN("skipped: the open data is absent");
    return;
  }
  for (const char* name : {"real/tshirt1900.yaml", "real/helper_skirt.yaml"}) {
    INFO(name);
    const Setup setup = read_setup(config(name));
    CHECK(setup.warnings.empty());
    check_consistent(setup);
    const Vec3 extent = (setup.initial.x.colwise().maxCoeff() - setup.initial.x.colwise().minCoeff()).transpose();
    CHECK(extent.maxCoeff() > 0.5);
    CHECK(extent.maxCoeff() < 2);
  }
}

TEST_CASE("Every shipped material is physical and found by name", "[setup]") {
  const Folder folder("setup");
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(config("materials"))) {
    const std::string name = entry.path().stem().string();
    INFO(name);
    const Material m =
        read(folder, "cloths: [{rectangle: {resolution: 3}, material: " + name + "}]").scene.cloths[0].material;
    CHECK(m.name == name);
    // The range over which real fabrics are spread.
    const double bending_length = std::cbrt(m.bending / (9.81 * m.density));
    CHECK(bending_length > 0.0076);
    CHECK(bending_length < 0.039);
    CHECK(m.density > 0.015);
    CHECK(m.density < 0.87);
    if (m.membrane == MembraneModel::baraff_witkin) {  // woven: shear is what gives
      CHECK(m.shear > 0);
      CHECK(m.shear < 0.5 * std::min(m.warp, m.weft));
    }
    ++count;
  }
  CHECK(count >= 12);
}

TEST_CASE("Every number of a shipped material has a unit or a source beside it, every material a row in the docs",
          "[setup]") {
  const std::string page = fake::whole(source_root() / "docs" / "materials.md");
  for (const auto& entry : std::filesystem::directory_iterator(config("materials"))) {
    INFO(entry.path().stem().string());
    CHECK_THAT(page, Contains("\n| `" + entry.path().stem().string() + "` |"));
    std::istringstream lines(fake::whole(entry.path()));
    for (std::string line; std::getline(lines, line);) {
      const std::size_t colon = line.find(": ");
      if (colon == std::string::npos || line[0] == '#' || line.find_first_of("0123456789", colon) == std::string::npos)
        continue;
      INFO(line);
      const bool prose = line.starts_with("description") || line.starts_with(' ');
      CHECK((prose || line.find(" # ", colon) != std::string::npos));
    }
  }
}

TEST_CASE("A material beside the scene comes before the program's, values before both", "[setup]") {
  const Folder folder("setup");
  std::filesystem::create_directory(folder.path / "materials");
  fake::write(folder, "materials/denim.yaml", "density: 1 kg/m2\nyoungs_modulus: 1000\npoisson: 0\n");
  const std::string sheet = "cloths: [{rectangle: {resolution: 3}, material: {name: denim, bending: 3e-6";
  const Material m = read(folder, sheet + "}}]").scene.cloths[0].material;
  CHECK(m.density == 1);
  CHECK(m.lame_mu == 500);
  CHECK(m.lame_lambda == 0);
  CHECK(m.bending == 3e-6);
  CHECK(read(folder, sheet + ", lame_mu: 7}}]").scene.cloths[0].material.lame_mu == 7);
  fake::write(folder, "materials/denim.yaml", "densty: 1\n");
  CHECK_THROWS_WITH(read(folder, sheet + "}}]"), Contains("denim.yaml:1") && Contains("did you mean `density`"));
}

TEST_CASE("Placement scales, turns, moves; the rest shape scales with it", "[setup]") {
  const Folder folder("setup");
  const Setup setup =
      read(folder,
           "cloths: [{rectangle: {resolution: [3, 2], size: [2, 1]}, scale: 0.5, rotate: [0, 90 deg, 0], "
           "translate: [0, 3, 0], velocity: [1, 0, 0]}]");
  CHECK(setup.initial.x.col(1).isConstant(3));
  CHECK(setup.initial.x.col(0).maxCoeff() == Approx(0.25));
  CHECK(setup.initial.x.col(2).maxCoeff() == Approx(0.5));
  CHECK(setup.initial.v.col(0).isConstant(1));
  CHECK(lumped_masses(setup.scene).sum() == Approx(0.5 * Material{}.density));
  CHECK(metric_error(setup.scene, setup.initial.x) < 1e-12);
}

TEST_CASE("Several cloths are numbered on end, each with its pins", "[setup]") {
  const Folder folder("setup");
  const Setup setup = read(folder,
                           "cloths:\n"
                           "  - {name: a, rectangle: {resolution: 3}, pins: [{vertices: 8}]}\n"
                           "  - {name: b, disc: {resolution: 1}, translate: [0, 1, 0], pins: [{group: center, motion: "
                           "{keyframes: [{time: 0}, {time: 1, translate: [0, 2, 0]}]}}, {box: {min: [-9, -9, -9], max: "
                           "[9, 9, 9]}}]}\n");
  CHECK(setup.scene.surface.vertex_count == 9 + 7);
  CHECK(setup.scene.cloths[1].first_vertex == 9);
  CHECK(setup.scene.cloths[1].first_triangle == 8);
  CHECK(setup.scene.pins == std::vector<int>{8, 9, 10, 11, 12, 13, 14, 15});
  const Drive drive = setup.drive_at(0.5);
  CHECK(drive.pins(0, 1) == 0);
  CHECK(drive.pins(1, 1) == Approx(2));  // the first pin that names the vertex moves it
  CHECK(drive.pins(2, 1) == 1);
  check_consistent(setup);
}

TEST_CASE("Copies lie where the one before would go, each with its pins", "[setup]") {
  const Folder folder("setup");
  const Setup setup = read(
      folder,
      "cloths: [{name: leaf, rectangle: {resolution: [3, 2], size: [2, 1]}, translate: [5, 0, 0], copies: {count: 3, "
      "translate: [0, 1, 0], rotate: [0, 45 deg, 0]}, pins: [{group: left}]}, {name: other, rectangle: "
      "{resolution: 2}}]");
  REQUIRE(setup.scene.cloths.size() == 4);
  CHECK(setup.scene.cloths[2].name == "leaf_2");
  CHECK(setup.scene.cloths[3].first_vertex == 18);
  CHECK(setup.scene.pins == std::vector<int>{0, 3, 6, 9, 12, 15});
  CHECK(row(setup.initial.x, 12).isApprox(Vec3(5, 2, 0) + Vec3(0.5, 0, 1), 1e-12));  // a quarter turn of (-1, 0, 0.5)
  CHECK(metric_error(setup.scene, setup.initial.x) < 1e-12);
  check_consistent(setup);
  CHECK_THROWS_WITH(read(folder, "cloths: [{name: a, disc: {}, copies: 2}, {name: a_1, disc: {}}]"),
                    Contains("name `a_1`"));
}

TEST_CASE("Pins start where their motion starts", "[setup]") {
  const Folder folder("setup");
  const Setup setup = read(folder,
                           "cloths: [{rectangle: {resolution: 2}, velocity: [0, 1, 0], pins: [{group: top, motion: "
                           "{keyframes: [{time: 0, translate: [0, 0, -1]}]}}]}]");
  CHECK(setup.initial.x(setup.scene.pins[0], 2) == Approx(-1.5));
  CHECK(setup.initial.v.row(setup.scene.pins[0]).isZero());
}

TEST_CASE("The texture coordinates are the rest shape on request", "[setup]") {
  const Folder folder("setup");
  // The square's pattern is twice as wide; its second triangle lies mirrored on another place of the sheet.
  fake::write(folder, "a.obj",
              square + "vt 0 0\nvt 2 0\nvt 2 1\nvt 9 0\nvt 7 1\nvt 9 1\nf 1/1 2/2 3/3\nf 1/4 3/5 4/6\n");
  const Setup setup = read(folder, "cloths: [{mesh: a.obj, rest: {from: uv, uv_unit: 10 cm}}]");
  RestTriangle first;
  first << 0, 0.2, 0.2, 0, 0, 0.1;
  CHECK(setup.scene.rest_triangle[0].isApprox(first));
  CHECK(area(setup.scene.rest_triangle[1]) == Approx(0.01));
  check_consistent(setup);
  fake::write(folder, "b.obj", square + "f 1 2 3\nf 1 3 4\n");
  CHECK_THROWS_WITH(read(folder, "cloths: [{mesh: b.obj, rest: uv}]"), Contains("texture coordinates"));
  CHECK_THROWS_WITH(read(folder, "cloths: [{tube: {}, rest: uv}]"), Contains("texture coordinates"));
}

TEST_CASE("The rest shape may come from another mesh of the same faces", "[setup]") {
  const Folder folder("setup");
  fake::write(folder, "a.obj", square + "f 1 2 3\nf 1 3 4\n");
  fake::write(folder, "rest.obj", "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3\nf 1 3 4\n");
  fake::write(folder, "other.obj", square + "f 1 2 3\n");
  const Setup setup =
      read(folder, "cloths: [{mesh: a.obj, rest: {from: mesh, file: rest.obj, unit: dm, flat: false}}]");
  CHECK(metric_error(setup.scene, setup.initial.x) < 1e-12);
  CHECK_FALSE(setup.scene.rest_is_flat);
  CHECK_THROWS_WITH(read(folder, "cloths: [{mesh: a.obj, rest: {from: mesh, file: other.obj}}]"),
                    Contains("other vertices"));
}

TEST_CASE("Flattened triangles keep their lengths and lay the weft along v", "[setup]") {
  Points x(3, 3);
  x << 0.1, 0.2, 0.3, 1.1, 0.5, -0.4, 0.3, 1.4, 0.2;
  Triangles one(1, 3);
  one << 0, 1, 2;
  const RestTriangle rest = flattened(x, one, Vec3::UnitY())[0];
  CHECK(area(rest) > 0);
  for (int k = 0; k < 3; ++k)
    CHECK((rest.col((k + 1) % 3) - rest.col(k)).norm() == Approx((x.row((k + 1) % 3) - x.row(k)).norm()));
  // d(position)/d(v) points as far up as the plane allows, d(position)/d(u) is level.
  Eigen::Matrix<double, 3, 2> edges;
  edges << (x.row(1) - x.row(0)).transpose(), (x.row(2) - x.row(0)).transpose();
  Eigen::Matrix2d flat;
  flat << rest.col(1) - rest.col(0), rest.col(2) - rest.col(0);
  const Eigen::Matrix<double, 3, 2> directions = edges * flat.inverse();
  CHECK(std::abs(directions(1, 0)) < 1e-14);
  CHECK(directions(1, 1) > 0);
}

TEST_CASE("Faulty meshes simulate with warnings: what has no mass holds nothing", "[setup]") {
  const Folder folder("setup");
  fake::write(folder, "a.obj", square + "v 5 5 5\nv 2 0 0\nf 1 2 3\nf 1 3 4\nf 1 2 6\nf 1 1 2\nf 3 1 2\n");
  const Setup setup = read(folder, "cloths: [{mesh: a.obj}]\ncontact: {thickness: 0.8, rigid_zones: true}\n");
  CHECK(setup.scene.contact.rigid_zones);
  CHECK(setup.scene.pins == std::vector<int>{4, 5});
  const auto warned = [&](const std::string& words) {
    return std::any_of(setup.warnings.begin(), setup.warnings.end(),
                       [&](const std::string& w) { return w.find(words) != std::string::npos; });
  };
  CHECK(warned("1 degenerate triangle "));
  CHECK(warned("1 duplicate triangle "));
  CHECK(warned("1 isolated vertex "));
  CHECK(warned("1 triangle of zero rest area is left out, and 1 vertex without mass follows"));
  CHECK(warned("1 vertex without mass is held in place"));
  CHECK(warned("smallest altitude of 2 triangles"));
}

TEST_CASE("Obstacles are placed, move, and say whether they do", "[setup]") {
  const Folder folder("setup");
  fake::write(folder, "a.obj", square + "f 1 2 3\nf 1 3 4\n");
  const Setup setup =
      read(folder,
           "cloths: [{rectangle: {resolution: 2}}]\n"
           "obstacles:\n"
           "  - {plane: {size: 2}, translate: [0, -1, 0]}\n"
           "  - {name: quad, mesh: {file: a.obj, unit: 2}, scale: 3}\n"
           "  - {box: {size: [1, 1, 1], edge: 1}, translate: [5, 0, 0], motion: {keyframes: [{time: 0}, "
           "{time: 1, rotate: [0, 0, 90 deg], translate: [0, 1, 0]}]}}\n");
  CHECK(setup.scene.obstacles[0].name == "obstacle0");
  CHECK(setup.scene.obstacles[1].name == "quad");
  CHECK_FALSE(setup.scene.obstacles[0].moving);
  CHECK(setup.scene.obstacles[2].moving);
  CHECK(setup.initial.obstacles[0].col(1).isConstant(-1));
  CHECK(setup.initial.obstacles[1].maxCoeff() == Approx(6));
  // A quarter turn of a cube about its own middle.
  const Points end = setup.drive_at(1).obstacles[2];
  CHECK(end.colwise().minCoeff().isApprox(Eigen::RowVector3d(4.5, 0.5, -0.5), 1e-12));
  CHECK(end.colwise().maxCoeff().isApprox(Eigen::RowVector3d(5.5, 1.5, 0.5), 1e-12));
}

TEST_CASE("Mesh sequences move linearly, and must keep their faces", "[setup]") {
  const Folder folder("setup");
  const std::string faces = "f 1 2 3\nf 1 3 4\n",
                    scene = "cloths: [{rectangle: {resolution: 2}}]\nobstacles: [{sequence: ";
  fake::write(folder, "b_007.obj", square + faces);
  fake::write(folder, "b_008.obj", "v 0 0 4\nv 1 0 4\nv 1 1 4\nv 0 1 4\n" + faces);
  for (const char* how :
       {"{pattern: b_%03d.obj, first: 7, fps: 10, unit: cm}", "{files: [b_007.obj, b_008.obj], fps: 10, unit: cm}"}) {
    const Setup setup = read(folder, scene + how + "}]\n");
    CHECK(setup.scene.obstacles[0].moving);
    CHECK(setup.drive_at(0.025).obstacles[0](1, 2) == Approx(0.01));
    CHECK(setup.drive_at(7).obstacles[0](1, 2) == Approx(0.04));
    CHECK(setup.drive_at(-1).obstacles[0](1, 2) == 0);
  }
  fake::write(folder, "b_009.obj", square + "f 1 2 3\n");
  CHECK_THROWS_WITH(read(folder, scene + "{pattern: b_%03d.obj, first: 7}}]\n"),
                    Contains("b_009.obj") && Contains("faces"));
  CHECK_NOTHROW(read(folder, scene + "{pattern: b_%03d.obj, first: 7, count: 2}}]\n"));
  CHECK_THROWS_WITH(read(folder, scene + "{pattern: b_%03d.obj, first: 7, count: 4}}]\n"), Contains("b_0"));
  CHECK_THROWS_WITH(read(folder, scene + "{pattern: b_%03d.obj}}]\n"), Contains("b_000.obj") && Contains("first: 7"));
}

TEST_CASE("An earlier run's cloth or obstacle is an obstacle", "[setup]") {
  const Folder folder("setup");
  const Setup first = read(folder,
                           "cloths: [{name: sheet, rectangle: {resolution: 3}}]\n"
                           "obstacles: [{name: ball, sphere: {edge: 0.2}}]\n");
  const TrajectoryInfo info = trajectory_info(first.scene, first.config, "conventional", 10);
  {
    TrajectoryWriter writer(folder.path / "run.h5", info);
    for (int f = 0; f < 3; ++f) {
      Frame frame;
      frame.time = 0.1 * f;
      frame.x = first.initial.x.cast<float>();
      frame.x.col(1).array() += static_cast<float>(f);
      frame.obstacles = {first.initial.obstacles[0].cast<float>()};
      writer.append(frame);
    }
    writer.close();
  }
  const std::string scene = "cloths: [{disc: {resolution: 1}}]\nobstacles: [{trajectory: ";
  const Setup cloth = read(folder, scene + "{file: run.h5, part: sheet}}]\n");
  CHECK(cloth.scene.obstacles[0].surface.vertex_count == 9);
  CHECK(cloth.drive_at(0.15).obstacles[0](0, 1) == Approx(1.5));
  const Setup ball = read(folder, scene + "run.h5}]\n");
  CHECK(ball.initial.obstacles[0].isApprox(first.initial.obstacles[0], 1e-6));
  CHECK_THROWS_WITH(read(folder, scene + "{file: run.h5, part: shet}}]\n"), Contains("did you mean `sheet`"));
  fake::write(folder, "bad.h5", "no trajectory");
  CHECK_THROWS_AS(read(folder, scene + "bad.h5}]\n"), Error);
}

TEST_CASE("Wind may be keyframed, and is on only where it does something", "[setup]") {
  const Folder folder("setup");
  const std::string sheet = "cloths: [{rectangle: {resolution: 2}}]\n";
  const Setup keyed =
      read(folder, sheet + "wind: {keyframes: [{time: 0, velocity: [0, 0, 0]}, {time: 2, velocity: [4, 0, 0]}]}\n");
  CHECK(keyed.scene.wind.on);
  CHECK(keyed.drive_at(0.5).wind == Vec3(1, 0, 0));
  CHECK(read(folder, sheet + "wind: {velocity: [1, 0, 0]}\n").drive_at(3).wind == Vec3(1, 0, 0));
  CHECK(read(folder, sheet + "wind: {}\n").scene.wind.on);  // still air drags
  CHECK_FALSE(read(folder, sheet + "wind: {drag: 0, lift: 0}\n").scene.wind.on);
  CHECK_FALSE(read(folder, sheet).scene.wind.on);
}

TEST_CASE("A start may be stretched, flattened and crumpled; the rest shape stays", "[setup]") {
  const Folder folder("start");
  const std::string cloth = "cloths: [{rectangle: {size: [1, 0.5], resolution: 5}, translate: [0, 1, 0], start: ";
  const Setup made = read(folder, cloth + "{}}]");
  const Setup twice = read(folder, cloth + "{stretch: [2, 1, -1]}}]");
  CHECK(metric_error(twice.scene, made.initial.x) < 1e-12);
  const Eigen::RowVector3d factors(2, 1, -1), middle(0, 1, 0);
  CHECK((twice.initial.x.rowwise() - middle -
         ((made.initial.x.rowwise() - middle).array().rowwise() * factors.array()).matrix())
            .norm() < 1e-12);
  const Setup crumpled = read(folder, cloth + "{crumple: 10 cm, seed: 3}}]");
  const Points moved = crumpled.initial.x - made.initial.x;
  CHECK(moved.cwiseAbs().maxCoeff() <= 0.1);
  CHECK(moved.cwiseAbs().maxCoeff() > 0.09);
  CHECK(crumpled.initial.x != read(folder, cloth + "{crumple: 10 cm, seed: 4}}]").initial.x);
  CHECK(metric_error(crumpled.scene, made.initial.x) < 1e-12);
  for (const std::string start : {"{stretch: [1, 1, 1e9]}", "{crumple: 1000 m}", "{stretch: [-1e5, 1, 1]}"})
    CHECK_THROWS_WITH(read(folder, cloth + start + "}]"), Contains("start") && Contains("10 times is the most"));
}

TEST_CASE("What no machine can hold is refused before memory is taken", "[setup]") {
  const Folder folder("too_large");
  const auto refused = [&](const std::string& text, const std::string& words) {
    INFO(text);
    CHECK_THROWS_WITH(read(folder, text), Contains(words));
  };
  refused("cloths: [{rectangle: {size: 0.1, resolution: 3}, copies: {count: 1000000000}}]", "10000");
  refused("cloths: [{rectangle: {size: 0.1, resolution: 100}, copies: {count: 9000}}]",
          "asks for 90000000 vertices; 4000000 are the most");
  refused("cloths: [{rectangle: {size: 1, edge: 1e-6}}]", "4000000 are the most");
  refused("cloths: [{rectangle: {size: 1, resolution: 3}}]\nobstacles: [{sphere: {radius: 1, edge: 1e-5}}]",
          "4000000 are the most");
  refused("cloths: [{rectangle: {size: 1, resolution: 3}}]\ncontact: {thickness: 1000 m}", "thickness");
}

TEST_CASE("A cloth that starts in one point is opened, and a warning says so", "[setup]") {
  const Folder folder("start");
  const Setup setup =
      read(folder, "cloths: [{name: dot, rectangle: {size: [1, 1], resolution: 5}, start: {stretch: [0, 0, 0]}}]");
  REQUIRE(setup.warnings.size() == 1);
  CHECK_THAT(setup.warnings[0], Contains("`dot` starts in one point") && Contains("seed 1"));
  const Points& x = setup.initial.x;
  CHECK((x.colwise().maxCoeff() - x.colwise().minCoeff()).maxCoeff() > 1e-4);
  CHECK(x.cwiseAbs().maxCoeff() < 3e-4);
}

}  // namespace selvedge::test_setup
