#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"

// The repulsive layer behind steppers (`run.refu.on`), as `selvedge simulate` runs it.
namespace selvedge::test_refu_run {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// A closed box of these half sizes; `last` are the coordinates of its last vertex in place of its own.
std::string box_obj(double x, double y, double z, const std::string& last = "") {
  std::ostringstream text;
  for (int k = 0; k < 8; ++k)
    if (k < 7 || last.empty())
      text << "v " << (k & 4 ? x : -x) << " " << (k & 2 ? y : -y) << " " << (k & 1 ? z : -z) << "\n";
    else
      text << "v " << last << "\n";
  text
      << "f 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\nf 3 4 8\nf 3 8 7\nf 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 4\n";
  return text.str();
}

// A sheet at this height over the origin, of an untrained network, with or without a body in body.obj.
Setup sheet_setup(const Folder& folder, const std::string& stepper, double height, bool body, bool refu) {
  const fake::NarrowNetwork network = fake::narrow_network("contourcraft", 5e-3);
  write_weight_file(folder.path / "w.h5", {network.architecture, network.weights, "", {}, ""});
  std::ostringstream scene;
  scene << "cloths: [{name: sheet, rectangle: {size: [0.4, 0.4], resolution: 9}, translate: [0, " << height
        << ", 0]}]\n"
        << (body ? "obstacles: [{name: body, mesh: body.obj}]\n" : "") << "run: {frames: 3, stepper: " << stepper
        << ", learned: {weights: w.h5}, refu: {on: " << (refu ? "true" : "false") << "}}\n";
  return read_setup(fake::write(folder, "scene.yaml", scene.str()));
}

std::vector<Frame> frames_of(const Folder& folder, const Setup& setup, const std::string& out) {
  fake::run(setup, *make_stepper(setup), folder.path / out);
  const TrajectoryReader reader(folder.path / out / "run.h5");
  std::vector<Frame> frames;
  for (int f = 0; f < reader.frame_count(); ++f) frames.push_back(reader.frame(f));
  return frames;
}

}  // namespace

TEST_CASE("refu run: no vertex is left in a body, be it thick, flat or one point; the cloth lies in it at the start",
          "[refu_run]") {
  const Folder folder("refu_run_bodies");
  for (const auto& [size, height] : {std::pair{0.1, 0.0}, {0.1, 0.1}, {0.0, 0.0}}) {
    fake::write(folder, "body.obj", box_obj(0.1, size, 0.1));
    const std::vector<Frame> frames = frames_of(folder, sheet_setup(folder, "learned", height, true, true), "flat");
    REQUIRE(frames.size() == 4);
    for (std::size_t f = 1; f < frames.size(); ++f) {
      CHECK(frames[f].x.allFinite());
      CHECK(frames[f].inside_vertices == 0);
      CHECK(frames[f].x != frames[f - 1].x);
    }
  }
  fake::write(folder, "body.obj", box_obj(0, 0, 0));
  for (const Frame& frame : frames_of(folder, sheet_setup(folder, "learned", 0, true, true), "point"))
    CHECK(frame.x.allFinite());
}

TEST_CASE("refu run: a body without faces and one that is not finite are one clear error", "[refu_run]") {
  const Folder folder("refu_run_broken");
  fake::write(folder, "body.obj", box_obj(0.1, 0.1, 0.1, "0.1 nan 0.1"));
  CHECK_THROWS_WITH(sheet_setup(folder, "learned", 0, true, true), Contains("body.obj") && Contains("not finite"));
  fake::write(folder, "body.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  CHECK_THROWS_WITH(sheet_setup(folder, "learned", 0, true, true), Contains("body.obj") && Contains("no faces"));
}

TEST_CASE("refu run: the same bits behind the conventional stepper where nothing is inside, and without a body",
          "[refu_run]") {
  const Folder folder("refu_run_bits");
  fake::write(folder, "body.obj", box_obj(0.1, 0.05, 0.1));
  for (const auto& [stepper, body] : {std::pair{"conventional", true}, {"conventional", false}, {"learned", false}}) {
    const std::vector<Frame> plain = frames_of(folder, sheet_setup(folder, stepper, 0.06, body, false), "plain"),
                             refu = frames_of(folder, sheet_setup(folder, stepper, 0.06, body, true), "refu");
    REQUIRE(plain.size() == refu.size());
    for (std::size_t f = 0; f < plain.size(); ++f) CHECK(plain[f].x == refu[f].x);
  }
}

}  // namespace selvedge::test_refu_run
