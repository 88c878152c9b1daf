#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

#include "collision/exact/inside.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/garments/garment_hdf5.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/motions/clip_procedural.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_setup_garment {

using Catch::Matchers::Contains;
using fake::farthest;
using fake::Folder;

namespace {

// A band round the trunk that is the mannequin's own surface, all of it pinned.
fake::Piece write_band(const Folder& folder) {
  const BodyModel& body = fake::mannequin();
  fake::Piece piece = fake::trunk(body, -0.05, 0.3, 0);
  Garment band{"band", attached(piece.x, piece.triangles, body, Fit::tight), {}, {}, {}, body.name};
  band.pins.resize(piece.from.size());
  std::iota(band.pins.begin(), band.pins.end(), 0);
  band.groups = {{"first", {0, 1, 2}}, {"last", {static_cast<int>(piece.from.size()) - 1}}};
  write_garment(folder.path / "band.h5", band);
  return piece;
}

Setup read(const Folder& folder, const std::string& cloth, const std::string& body, const std::string& more = "") {
  return read_setup(fake::write(folder, "scene.yaml",
                                "cloths:\n  - " + cloth + "\nobstacles:\n  - " + body + "\n" + more +
                                    "contact: {thickness: 3 mm}\nrun: {fps: 30, frames: 20}\n"));
}

}  // namespace

TEST_CASE("A garment's pins go where its body goes, in its shape, clip, placement and motion", "[setup_garment]") {
  const Folder folder("garment_pins");
  const fake::Piece piece = write_band(folder);
  for (const std::string body :
       {"{name: person, body: {clip: walk, room: 0}}",
        "{name: person, body: {shape: [1, -1, 0.5], clip: run, room: 0}}", "{name: person, body: {}}",
        "{name: person, body: {clip: walk, room: 0}, scale: 1.2, rotate: [0, 1, 0.2], translate: [1, 2, 3], motion: "
        "{keyframes: "
        "[{time: 0}, {time: 1, translate: [0, 1, 0], rotate: [0, 0, 1]}]}}"}) {
    INFO(body);
    const Setup setup = read(folder, "{garment: band.h5}", body);
    REQUIRE(setup.scene.pins.size() == piece.from.size());
    for (const double time : {0.0, 0.37, 1.2}) {
      const Drive drive = setup.drive_at(time);
      CHECK(farthest(drive.pins, drive.obstacles.at(0)(piece.from, Eigen::all)) < 1e-12);
    }
    CHECK(farthest(setup.initial.x, setup.initial.obstacles.at(0)(piece.from, Eigen::all)) < 1e-12);
    CHECK(setup.initial.v.isZero());  // all are pins
    CHECK(setup.warnings.empty());
  }
}

TEST_CASE("Where a body gives way to itself, the garment's pins go along", "[setup_garment]") {
  const Folder folder("garment_soft_tissue");
  const fake::Piece piece = write_band(folder);
  const Setup plain = read(folder, "{garment: band.h5}", "{name: person, body: {clip: squat, room: 0}}");
  const Setup setup = read(folder, "{garment: band.h5}", "{name: person, body: {clip: squat}}");
  double given = 0, apart = 0;
  for (const double time : {0.0, 1.0, 2.0, 2.5}) {
    const Drive drive = setup.drive_at(time);
    const Points skin = drive.obstacles.at(0)(piece.from, Eigen::all);
    given = std::max(given, farthest(skin, plain.drive_at(time).pins));
    apart = std::max({apart, farthest(skin, drive.pins), farthest(skin, drive.skinned_targets)});
  }
  CAPTURE(given, apart);
  CHECK(given > 0.01);
  CHECK(apart < 0.5 * given);
}

TEST_CASE("A body leaves room for as many garments as it wears", "[setup_garment]") {
  const Folder folder("garment_room");
  write_band(folder);
  const auto body = [&](const std::string& cloths, const std::string& room) -> Points {
    return read(folder, cloths, "{name: person, body: {clip: squat" + room + "}}").drive_at(2).obstacles.at(0);
  };
  const std::string one = "{name: a, garment: band.h5}", two = one + "\n  - {name: b, garment: band.h5}";
  CHECK(body(two, "") == body(one, ", room: 1.5 cm"));
  CHECK(body(one, "") == body(two, ", room: 1 cm"));
  CHECK(body(two, "") != body(one, ""));
}

TEST_CASE("What is pinned to one part of a body is not run through by another that comes close", "[setup_garment]") {
  const Folder folder("garment_squeezed");
  const BodyModel& mannequin = fake::mannequin();
  const fake::Piece belt = fake::trunk(mannequin, 0.0, 0.12, 0.028);
  Garment garment{"belt", attached(belt.x, belt.triangles, mannequin, Fit::tight), {}, {}, {}, mannequin.name};
  garment.pins.resize(belt.from.size());
  std::iota(garment.pins.begin(), garment.pins.end(), 0);
  write_garment(folder.path / "belt.h5", garment);
  // Hands that come down on the hips, before they go through them.
  const Setup setup = read(folder, "{garment: belt.h5}",
                           "{name: person, body: {clip: arms_through_thighs, blend_in: 1 s, room: 1.5 cm}}");
  for (const double frame : {0, 51, 52, 53}) {
    const Drive drive = setup.drive_at(frame / 30);
    const std::vector<char> in = inside(setup.scene.obstacles[0].surface, drive.obstacles[0], drive.pins);
    CHECK(std::ranges::count(in, 1) == 0);
  }
  // What cloth is drawn to is squeezed as well where there are layers.
  const auto apart = [&](const std::string& cloths) {
    const Drive drive =
        read(folder, cloths, "{body: {clip: arms_through_thighs, blend_in: 1 s, room: 1.5 cm}}").drive_at(53 / 30.0);
    return farthest(drive.skinned_targets, drive.pins);
  };
  CHECK(apart("{garment: belt.h5}") > 0.01);
  CHECK(apart("{name: a, garment: belt.h5}\n  - {name: b, garment: belt.h5}") == 0);
}

TEST_CASE("A garment rests as it was made, resized by the body's shape and scale", "[setup_garment]") {
  const Folder folder("garment_rest");
  const fake::Piece piece = write_band(folder);
  const Setup setup = read(folder, "{garment: {file: band.h5, on: person}, rest: {flat: false}}",
                           "{name: person, scale: 2, body: {shape: [0, 2], clip: squat, room: 0}}");
  const Points expected = 2 * shaped(fake::mannequin().skin, Eigen::Vector2d(0, 2))(piece.from, Eigen::all);
  CHECK(farthest(setup.scene.rest, expected) < 1e-12);
  CHECK_FALSE(setup.scene.rest_is_flat);
  double error = 0;
  for (int t = 0; t < piece.triangles.rows(); ++t) {
    const RestTriangle& rest = setup.scene.rest_triangle[static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = row(expected, piece.triangles(t, (k + 1) % 3)) - row(expected, piece.triangles(t, k));
      error = std::max(error, std::abs((rest.col((k + 1) % 3) - rest.col(k)).norm() - edge.norm()));
    }
  }
  CHECK(error < 1e-12);
  const Setup again = read_setup(fake::write(folder, "again.yaml", setup.config));
  CHECK(again.initial.x == setup.initial.x);
}

TEST_CASE("Whose pins follow the body, and how fast a garment starts", "[setup_garment]") {
  const Folder folder("garment_follow");
  const fake::Piece piece = write_band(folder);
  const std::string walking =
      "{body: {clip: walk, room: 0}, motion: {keyframes: [{time: 0}, {time: 1, translate: [2, 0, 0]}]}}";
  const Setup free = read(folder, "{garment: {file: band.h5, pins: false}}", walking);
  CHECK(free.scene.pins.empty());
  const double fps = make_clip("walk", joint_positions(fake::mannequin(), {})).fps;
  const Points motion = fps * (free.drive_at(1 / fps).obstacles[0] - free.drive_at(0).obstacles[0]);
  CHECK(farthest(free.initial.v, motion(piece.from, Eigen::all)) < 1e-9);
  CHECK(free.initial.v.col(0).mean() == Approx(2).margin(0.1));
  const Setup still = read(folder, "{garment: {file: band.h5, pins: false}, start: {moving: false}}", walking);
  CHECK(still.initial.v.isZero());

  // The scene's own pins come first; the garment's stay for the others.
  const Setup held = read(folder,
                          "{garment: band.h5, pins: [{group: first, motion: {keyframes: [{time: 0}, {time: 1, "
                          "translate: [0, 5, 0]}]}}]}",
                          walking);
  const Drive later = held.drive_at(1);
  CHECK(farthest(later.pins.topRows(3), held.initial.x.topRows(3).rowwise() + Eigen::RowVector3d(0, 5, 0)) < 1e-12);
  CHECK(farthest(later.pins.bottomRows(3), later.obstacles[0](piece.from, Eigen::all).bottomRows(3)) < 1e-12);

  const Setup some =
      read(folder, "{garment: {file: band.h5, pins: false}, pins: [{group: last, follow: body}]}", walking);
  REQUIRE(some.scene.pins.size() == 1);
  const Drive drive = some.drive_at(0.8);
  CHECK(farthest(drive.pins, drive.obstacles[0].row(piece.from.back())) < 1e-12);
}

TEST_CASE("What is wrong with a garment is named by file, line and cure", "[setup_garment]") {
  const Folder folder("garment_faulty");
  write_band(folder);
  const std::string person = "{name: person, body: {}}";
  const auto complaint = [&](const std::string& cloth, const std::string& bodies) {
    try {
      read(folder, cloth, bodies);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(complaint("{garment: {file: band.h5, on: persn}}", person),
             Contains("scene.yaml:2") && Contains("no body") && Contains("did you mean `person`"));
  CHECK_THAT(complaint("{garment: band.h5}", "{sphere: {}}"), Contains("no body to be worn by"));
  CHECK_THAT(complaint("{garment: band.h5}", person + "\n  - {name: other, body: {}}"),
             Contains("who wears it") && Contains("person, other"));
  CHECK_THAT(complaint("{garment: {on: person}}", person), Contains("file"));
  CHECK_THAT(complaint("{garment: shirt.h5}", person), Contains("missing file"));
  fake::write(folder, "shirt.stl", "");
  CHECK_THAT(complaint("{garment: shirt.stl}", person), Contains("scene.yaml:2") && Contains("`selvedge dress`"));
  fake::write(folder, "far.obj", "v 9 9 9\nv 9.1 9 9\nv 9 9.1 9\nf 1 2 3\n");
  CHECK_THAT(complaint("{garment: far.obj}", person), Contains("is not worn") && Contains("`unit`"));
  fake::write(folder, "text.h5", "no HDF5");
  CHECK_THAT(complaint("{garment: text.h5}", person), Contains("text.h5") && Contains("this is no HDF5 file"));
  for (const std::string key :
       {"translate: [0, 1, 0]", "rotate: [0, 1, 0]", "scale: 2", "velocity: [1, 0, 0]", "copies: {count: 2}"})
    CHECK_THAT(complaint("{garment: band.h5, " + key + "}", person), Contains("where its body is"));
  CHECK_THAT(complaint("{rectangle: {resolution: 4}, pins: [{group: left, follow: body}]}", person),
             Contains("no body wears"));
  CHECK_THAT(
      complaint("{garment: band.h5, pins: [{group: first, follow: body, motion: {keyframes: [{time: 0}]}}]}", person),
      Contains("beside `follow`"));
  CHECK_THAT(complaint("{garment: band.h5, rest: uv}", person), Contains("texture coordinates"));

  Garment other = read_garment(folder.path / "band.h5");
  other.skin.shape_directions.conservativeResize(Eigen::NoChange, 1);
  other.made_for = "SMPL_NEUTRAL";
  write_garment(folder.path / "other.h5", other);
  CHECK_THAT(complaint("{garment: other.h5}", "{body: {shape: [1, 1]}}"), Contains("1 shapes"));
  const Setup setup = read(folder, "{garment: other.h5}", "{name: person, body: {shape: [1]}}");
  REQUIRE(setup.warnings.size() == 1);
  CHECK_THAT(setup.warnings[0], Contains("SMPL_NEUTRAL") && Contains("`person` is `mannequin 1`"));
  SkinWeights few(other.skin.rest.rows(), 2);
  for (int v = 0; v < few.rows(); ++v) few.insert(v, 1) = 1;
  other.skin.weights = few;
  write_garment(folder.path / "few.h5", other);
  CHECK_THAT(complaint("{garment: few.h5}", person), Contains("2 joints") && Contains("has 24"));
}

TEST_CASE("A skirt on a walking mannequin stays clean and its waist stays on the body", "[setup_garment]") {
  const Folder folder("garment_walk");
  const auto waist =
      static_cast<Eigen::Index>(fake::write_skirt(folder, {.low = -0.35, .around = 40, .rings = 14}).pins.size());
  const Setup setup =
      read(folder, "{garment: skirt.h5, material: {stiffness_damping: 2 ms}}", "{body: {clip: walk, room: 0}}");
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  State state = setup.initial;
  int pairs = 0, inside = 0, passed = 0;
  simulate(setup.scene, *stepper, setup.drive_at, 1 / setup.run.fps, setup.run.frames, state,
           [&](const FrameEvent& event) {
             REQUIRE(event.report.audit);
             INFO(event.state.frame);
             CHECK(farthest(event.state.x.topRows(waist), event.drive.pins) < 1e-12);
             CHECK((event.report.audit->intersecting_pairs() == 0 || event.state.frame < 5));
             pairs = event.report.audit->intersecting_pairs();
             inside = event.report.audit->inside_vertices;
             passed += event.report.collision.passed_through;
             return true;
           });
  CHECK(state.frame == 20);
  CHECK(pairs + inside + passed == 0);
}

TEST_CASE("A garment brings its stitches along: behind other cloths, as long as its body's scale has them",
          "[setup_garment]") {
  const Folder folder("garment_stitches");
  write_band(folder);
  Garment band = read_garment(folder.path / "band.h5");
  band.stitches = {{0, 7, 0.004}, {5, 2, 0.01}};
  write_garment(folder.path / "band.h5", band);
  const Setup setup =
      read(folder, "{rectangle: {resolution: 3}, translate: [3, 0, 0]}\n  - {name: band, garment: band.h5}",
           "{body: {}, scale: 0.5}",
           "springs: [{from: {cloth: band, vertices: 1}, to: {cloth: band, vertices: 9}, "
           "rest_length: 1 cm, stiffness: 20}]\n");
  const std::vector<Spring>& springs = setup.scene.springs;
  REQUIRE(springs.size() == 3);
  CHECK((springs[0].a == 9 && springs[0].b == 16 && springs[0].rest_length == Approx(0.002)));
  CHECK((springs[1].a == 14 && springs[1].b == 11 && springs[1].rest_length == Approx(0.005)));
  CHECK((springs[0].stiffness == Spring{}.stiffness && springs[2].stiffness == 20 && springs[2].a == 10));
  REQUIRE(setup.warnings.size() == 1);
  CHECK_THAT(setup.warnings[0], Contains("stitches of band: 1 spring is shorter"));
}

TEST_CASE("Pockets of a garment by code stay where they are stitched", "[setup_garment]") {
  const Folder folder("garment_pockets");
  const Setup setup = read(folder, "{garment: {cut: vest, edge: 32 mm}}", "{body: {}}");
  REQUIRE(setup.scene.springs.size() >= 14);
  CHECK(setup.warnings.empty());
  State state = setup.initial;
  simulate(setup.scene, *make_stepper(setup), setup.drive_at, 1 / setup.run.fps, 8, state,
           [](const FrameEvent& event) { return event.report.audit && event.report.audit->intersecting_pairs() == 0; });
  REQUIRE(state.frame == 8);
  double apart = 0;
  for (const Spring& spring : setup.scene.springs)
    apart = std::max(apart, std::abs((row(state.x, spring.b) - row(state.x, spring.a)).norm() - spring.rest_length));
  CHECK(apart < 1e-3);
}

TEST_CASE("A garment's key that does nothing beside others is an error", "[setup_garment]") {
  const Folder folder("garment_keys");
  write_band(folder);
  const auto complaint = [&](const std::string& garment) -> std::string {
    try {
      read(folder, "{garment: {" + garment + "}}", "{name: person, body: {}}");
    } catch (const std::exception& error) {
      return error.what();
    }
    return {};
  };
  CHECK_THAT(complaint("file: band.h5, edge: 2 cm"), Contains("garment.edge`") && Contains("beside `file`"));
  CHECK_THAT(complaint("file: band.h5, form: full"), Contains("garment.form`") && Contains("goes with `outfit` alone"));
  CHECK_THAT(complaint("cut: shorts, layers: alone"), Contains("garment.layers`"));
  CHECK_THAT(complaint("cut: shorts, unit: cm"), Contains("garment.unit`") && Contains("goes with `file` alone"));
  CHECK_THAT(complaint("outfit: summer, over: [shorts]"), Contains("garment.over`"));
  CHECK_THAT(complaint("outfit: summer, weld: true"), Contains("garment.weld`"));
  CHECK_THAT(complaint("cut: shorts, up: z"), Contains("garment.up`"));
  CHECK_THAT(complaint("file: band.h5, weld: true"), Contains("selvedge dress --weld"));
  CHECK_THAT(complaint("file: band.h5, up: z"), Contains("leave `unit`, `up` and `fit` out"));
  // Defaults, as the configuration of a run has them, are none.
  CHECK(complaint("file: band.h5, unit: m, up: y, fit: loose, form: small, layers: over, weld: false").empty());
  const auto vertices = [&](const std::string& garment) {
    return read(folder, "{garment: {" + garment + "}}", "{name: person, body: {}}").scene.surface.vertex_count;
  };
  CHECK(vertices("outfit: summer, edge: 4.5 cm") < vertices("outfit: summer"));
}

TEST_CASE("A garment's mesh is welded and turned as its section says, and warned of where it is not",
          "[setup_garment]") {
  const Folder folder("garment_mesh_keys");
  const std::string person = "{name: person, body: {}}";
  const fake::Piece piece = fake::trunk(fake::mannequin(), -0.05, 0.3, 0.01);
  // In centimetres, z up, each triangle by itself.
  Points x(3 * piece.triangles.rows(), 3);
  Triangles triangles(piece.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector3d p = piece.x.row(piece.triangles(t, k));
      x.row(3 * t + k) << 100 * p.x(), -100 * p.z(), 100 * p.y();
      triangles(t, k) = static_cast<int>(3 * t + k);
    }
  write_obj(folder.path / "band.obj", x, triangles);
  const auto setup = [&](const std::string& keys) {
    return read(folder, "{garment: {file: band.obj" + keys + "}}", person);
  };
  CHECK_THROWS_WITH(setup(""),
                    Contains("is not worn") && Contains("write `unit: cm, up: z`, with which it lies on the body"));
  const Setup loose = setup(", unit: cm, up: z");
  const std::string joined = std::to_string(x.rows() - piece.x.rows());
  REQUIRE_FALSE(loose.warnings.empty());
  CHECK(loose.warnings[0] ==
        "cloth `cloth0`: the seams are not welded: `weld: true` under `garment` joins " + joined + " vertices");
  const Setup welded = setup(", unit: cm, up: z, weld: true");
  CHECK(welded.warnings.empty());
  CHECK(welded.scene.surface.component_count == 1);
  CHECK(welded.scene.surface.vertex_count == piece.x.rows());
  CHECK(welded.scene.surface.triangles.rows() == piece.triangles.rows());
  // Pins have the numbers of the file.
  const Setup pinned =
      read(folder,
           "{garment: {file: band.obj, unit: cm, up: z, weld: true, pins: false}, pins: [{vertices: [" +
               std::to_string(x.rows() - 1) + "]}]}",
           person);
  REQUIRE(pinned.scene.pins.size() == 1);
  CHECK(pinned.scene.pins[0] == welded.scene.surface.triangles(triangles.rows() - 1, 2));
  CHECK(setup(", unit: cm, up: z, weld: true, weld_within: 0.1 mm").scene.surface.vertex_count == piece.x.rows());
  CHECK_THROWS_WITH(setup(", unit: cm, up: z, weld_within: 0.1 mm"), Contains("without `weld`"));
}

TEST_CASE("An outfit is looked up beside the scene before the program's own", "[setup_garment]") {
  const Folder folder("garment_outfits");
  std::string text = whole_file(config_folder() / "outfits.yaml");
  text.replace(text.find("summer"), 6, "mine");
  fake::write(folder, "outfits.yaml", text);
  CHECK_THROWS_WITH(read(folder, "{garment: {outfit: summer}}", "{name: person, body: {clip: walk}}"),
                    Contains("unknown outfit `summer`") && Contains("outfits: mine, office"));
}

}  // namespace selvedge::test_setup_garment
