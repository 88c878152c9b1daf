#include <catch2/catch.hpp>

#include <cmath>
#include <sstream>

#include "collision/geometry/box_diagonal.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_setup_warnings {
using Catch::Matchers::Contains;

namespace {

// A square of that side and its two triangles.
std::string square(double side, double at = 0) {
  std::ostringstream text;
  for (const double z : {0., side})
    for (const double x : {0., side}) text << "v " << at + x << " " << at << " " << at + z << "\n";
  return text.str() + "f 1 3 2\nf 2 3 4\n";
}

std::string all(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

struct Scenes {
  fake::Folder folder{"setup_warnings"};
  Setup read(const std::string& yaml) const { return read_setup(fake::write(folder, "scene.yaml", yaml)); }
  std::string warnings(const std::string& yaml) const { return all(read(yaml).warnings); }
  std::string refusal(const std::string& yaml) const {
    return testing::refusal([&] { read(yaml); });
  }
};

}  // namespace

TEST_CASE("A file in centimetres that is read as metres is told by its extent", "[setup_warnings]") {
  const Scenes scenes;
  fake::write(scenes.folder, "big.obj", square(60));
  fake::write(scenes.folder, "small.obj", square(0.001));
  CHECK_THAT(scenes.warnings("cloths: [{name: shirt, mesh: big.obj}]\n"),
             Contains("`shirt` spans 84.9 m") && Contains("`unit: cm` makes it 0.849 m"));
  CHECK_THAT(scenes.warnings("cloths: [{name: shirt, mesh: small.obj}]\n"),
             Contains("`shirt` spans 0.00141 m") && Contains("`scale: 1000` makes it 1.41 m"));
  CHECK_THAT(scenes.warnings("cloths: [{name: shirt, mesh: small.obj, scale: 0.5}]\n"),
             Contains("`scale: 500` makes it 0.707 m"));
  fake::write(scenes.folder, "one.obj", square(1));
  const std::string rest = "cloths: [{name: shirt, mesh: one.obj, rest: {from: mesh, file: big.obj";
  CHECK_THAT(scenes.warnings(rest + "}}]\n"),
             Contains("cloth `shirt`: its rest shape is 60 times as large") && Contains("correct `unit` under `rest`"));
  CHECK(scenes.warnings(rest + ", unit: cm}}]\n").empty());
  const Setup cured = scenes.read("cloths: [{name: shirt, mesh: small.obj, scale: 1000}]\n");
  CHECK(cured.warnings.empty());
  CHECK(box_diagonal(cured.initial.x) == Approx(std::sqrt(2)));
  fake::write(scenes.folder, "loose.obj", square(1) + "v 90 0 0\n");
  CHECK_THAT(scenes.warnings("cloths: [{mesh: loose.obj}]\n"), !Contains("spans") && Contains("in no triangle"));
  fake::write(scenes.folder, "wide.obj", square(10));
  CHECK_THAT(scenes.warnings("cloths: [{name: shirt, mesh: wide.obj}]\n"), Contains("`unit: dm` makes it 1.41 m"));
  CHECK(scenes.warnings("cloths: [{mesh: {file: big.obj, unit: cm}}]\n").empty());
  CHECK(scenes.warnings("cloths: [{mesh: big.obj, scale: 0.01}]\n").empty());
  CHECK_THAT(scenes.warnings("cloths: [{rectangle: {size: [1, 1], resolution: 3}, translate: [0, 5, 0]}]\n"
                             "obstacles: [{name: floor, mesh: big.obj}]\n"),
             Contains("obstacle `floor` spans 84.9 m"));
}

TEST_CASE("Vertices at one place are counted, with the key that joins them", "[setup_warnings]") {
  const Scenes scenes;
  fake::write(scenes.folder, "panels.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 3 2\nf 4 6 5\n");
  CHECK_THAT(scenes.warnings("cloths: [{mesh: panels.obj}]\n"), Contains("2 vertices") && Contains("`weld: true`"));
  const Setup joined = scenes.read("cloths: [{mesh: {file: panels.obj, weld: true}}]\n");
  CHECK(joined.warnings.empty());
  CHECK(joined.scene.surface.vertex_count == 4);
  CHECK(joined.scene.surface.component_count == 1);
}

TEST_CASE("A scene too far from the origin for 32-bit floats is told and counted", "[setup_warnings]") {
  const Scenes scenes;
  fake::write(scenes.folder, "far.obj", square(1, 50000));
  CHECK_THAT(scenes.warnings("cloths: [{mesh: far.obj}]\n"), Contains("4 vertices") && Contains("`translate`"));
  CHECK(scenes.warnings("cloths: [{mesh: far.obj, translate: [-50000, -50000, -50000]}]\n").empty());
}

TEST_CASE("Pins inside a collider are named", "[setup_warnings]") {
  const Scenes scenes;
  const std::string cape = "cloths: [{name: cape, rectangle: {size: [0.6, 0.6], resolution: 21}, translate: [0, 0.5, ";
  const std::string rest =
      "], pins: [{group: top}]}]\nobstacles:\n  - name: shoulder\n    capsule: {radius: 6 cm, length: 0.7}\n"
      "    rotate: [0, 0, 90 deg]\n    translate: [0, 0.5, 0]\n";
  CHECK_THAT(scenes.warnings(cape + "0.3" + rest),
             Contains("21 pins of group top of cloth `cape` are inside the obstacle `shoulder`"));
  CHECK(scenes.warnings(cape + "0.4" + rest).empty());
}

TEST_CASE("What steps would take long over is told before them", "[setup_warnings]") {
  const Scenes scenes;
  const std::string sheet =
      "{name: a, rectangle: {size: [0.4, 0.3], resolution: 5}, pins: [{group: [top_left], motion: "
      "{keyframes: [{time: 0}, {time: 1, translate: [";
  const auto pulled = [&](double way) {
    return scenes.warnings("cloths: [" + sheet + std::to_string(way) + ", 0, 0]}]}}]}]\nrun: {fps: 10, frames: 20}\n");
  };
  CHECK_THAT(pulled(60), Contains("pins of group top_left of cloth `a` move 6 m in frame 1, and the cloth is 0.5 m"));
  CHECK(pulled(4.9).empty());

  const std::string lies = "cloths: [{name: a, rectangle: {size: [0.4, 0.3], resolution: 5}}]\n";
  CHECK_THAT(scenes.warnings(lies + "wind: {velocity: [1000, 0, 0]}\n"), Contains("wind of 1000 m/s"));
  CHECK_THAT(scenes.warnings(lies + "wind: {keyframes: [{time: 0, velocity: [0, 0, 0]}, {time: 1, velocity: [0, 150, "
                                    "0]}]}\n"),
             Contains("wind of 150 m/s"));
  CHECK(scenes.warnings(lies + "wind: {velocity: [40, 0, 0]}\n").empty());

  const auto joined = [&](const std::string& stiffness) {
    return scenes.warnings(
        lies + "springs: [{from: {vertices: [0]}, to: {vertices: [24]}, rest_length: 0.5, stiffness: " + stiffness +
        "}]\n");
  };
  CHECK_THAT(joined("1e15"), Contains("springs[0]") || Contains("springs.0"));
  CHECK_THAT(joined("1e15"), Contains("1e+15 N/m") && Contains("as good as rigid"));
  CHECK(joined("1e6").empty());
}

TEST_CASE("Finite but absurd numbers are refused with their place and value", "[setup_warnings]") {
  const Scenes scenes;
  fake::write(scenes.folder, "x.obj", "v 0 0 0\nv 1 0 0\nv 0 0 -2147483648\nf 1 2 3\n");
  CHECK_THAT(scenes.refusal("cloths: [{mesh: x.obj}]\n"), Contains("x.obj") && Contains("-2147483648"));
  CHECK_THAT(scenes.refusal("cloths:\n  - rectangle: {size: [1, 1], resolution: 3}\n"
                            "    pins: [{vertices: [0], motion: {keyframes: [{time: 0}, {time: 1, translate: "
                            "[9223372036854775807, 0, 0]}]}}]\n"),
             Contains("scene.yaml:3") && Contains("9223372036854775807") && Contains("absurd"));
  CHECK_THAT(scenes.refusal("cloths: [{rectangle: {size: [1, 1], resolution: 3}, scale: 1e30}]\n"),
             Contains("scene.yaml:1") && Contains("e+2"));
  CHECK_THAT(scenes.refusal("cloths: [{rectangle: {size: [1, 1], resolution: 3}}]\n"
                            "obstacles: [{sphere: {radius: 0.1}, scale: 1e200}]\n"),
             Contains("scene.yaml:2"));
  CHECK_THAT(scenes.refusal("cloths: [{rectangle: {size: [1, 1], resolution: 3}, copies: {count: 3, translate: "
                            "[900000, 0, 0]}}]\n"),
             Contains("cloth0_2"));
}

}  // namespace selvedge::test_setup_warnings
