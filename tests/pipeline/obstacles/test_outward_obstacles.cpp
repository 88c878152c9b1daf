#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/tools/check.hpp"
#include "pipeline/tools/push_mesh.hpp"
#include "pipeline/tools/untangle_mesh.hpp"
#include "tests/collision/solids.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_outward_obstacles {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Triangles flipped(Triangles triangles) {
  triangles.col(1).swap(triangles.col(2));
  return triangles;
}

// An arm along y, 13 cm thick, as given or inside out.
std::filesystem::path write_arm(const Folder& folder, const std::string& name, bool inward, double lift = 0) {
  testing::Solid arm = testing::rod(24, 0.13, 0.5);
  Points x(arm.x.rows(), 3);
  x << arm.x.col(1), arm.x.col(2).array() + lift, arm.x.col(0);
  const Triangles& triangles = arm.surface.triangles;
  write_obj(folder.path / name, x, inward ? flipped(triangles) : triangles);
  return folder.path / name;
}

std::string sleeve_on(const std::string& obstacle) {
  return "cloths:\n  - name: sleeve\n    tube: {radius: 0.12, height: 0.05, resolution: [24, 3]}\n"
         "    translate: [0, 0.22, 0]\nobstacles:\n  - {name: arm, " +
         obstacle + "}\nrun: {frames: 8}\n";
}

Setup sleeved(const Folder& folder, const std::string& obstacle) {
  return read_setup(fake::write(folder, "scene.yaml", sleeve_on(obstacle)));
}

int warnings_with(const std::vector<std::string>& warnings, const std::string& text) {
  return static_cast<int>(
      std::ranges::count_if(warnings, [&](const std::string& warning) { return fake::has(warning, text); }));
}

}  // namespace

TEST_CASE("A sleeve that starts inside of an inside-out arm comes out as of the same arm", "[outward]") {
  const Folder folder("inside_out");
  write_arm(folder, "out.obj", false);
  write_arm(folder, "in.obj", true);
  const Setup right = sleeved(folder, "mesh: out.obj"), turned = sleeved(folder, "mesh: in.obj");
  CHECK(right.warnings.empty());
  REQUIRE(turned.warnings.size() == 1);
  CHECK_THAT(turned.warnings[0], Contains("in.obj: the surface") && Contains("turned outwards, 96 triangles"));
  CHECK(turned.scene.obstacles[0].surface.triangles == right.scene.obstacles[0].surface.triangles);
  const RunSummary as_given = fake::run(right, *make_stepper(right), folder.path / "right"),
                   as_turned = fake::run(turned, *make_stepper(turned), folder.path / "turned");
  CHECK(as_given.worst_inside > 0);
  const TrajectoryReader a(folder.path / "right" / "run.h5"), b(folder.path / "turned" / "run.h5");
  REQUIRE(a.frame_count() == b.frame_count());
  const Frame last = b.frame(b.frame_count() - 1);
  CHECK(last.x == a.frame(a.frame_count() - 1).x);
  CHECK(last.inside_vertices + last.obstacle_pairs == 0);
  CHECK(b.info().obstacles[0].triangles == right.scene.obstacles[0].surface.triangles);  // what was simulated
}

TEST_CASE("Every way in turns a closed surface outwards and says so", "[outward]") {
  const Folder folder("ways_in");
  const Triangles right = read_mesh(write_arm(folder, "out.obj", false)).triangles;
  write_arm(folder, "in.obj", true);
  write_arm(folder, "in_0.obj", true);
  write_arm(folder, "in_1.obj", true, 0.01);
  for (const std::string obstacle :
       {"sequence: {pattern: in_%d.obj}", "sequence: {files: [in_0.obj, in_1.obj]}",
        "revolution: {profile: [{at: [0, 0]}, {at: [0.1, 0]}, {at: [0.1, 0.5]}, {at: [0, 0.5]}], edge: 0.05}",
        "revolution: {profile: [{at: [0, 0.5]}, {at: [0.1, 0.5]}, {at: [0.1, 0]}, {at: [0, 0]}], edge: 0.05}"}) {
    INFO(obstacle);
    const Setup setup = sleeved(folder, obstacle);
    const Surface& surface = setup.scene.obstacles[0].surface;
    const bool made = obstacle.starts_with("revolution");
    if (!made) CHECK(surface.triangles == right);
    if (!made) CHECK(warnings_with(setup.warnings, "turned outwards") == 1);
    double volume = 0;
    const Points& x = setup.initial.obstacles[0];
    for (const auto& t : surface.triangles.rowwise()) volume += row(x, t[0]).dot(row(x, t[1]).cross(row(x, t[2]))) / 6;
    CHECK(volume > 0);
  }
  Setup first = sleeved(folder, "mesh: out.obj");
  fake::run(first, *make_stepper(first), folder.path / "run");
  CHECK(sleeved(folder, "trajectory: {file: run/run.h5, part: arm}").scene.obstacles[0].surface.triangles == right);
}

TEST_CASE("Commands turn the body they are given and say so", "[outward]") {
  const Folder folder("bodies_inside_out");
  const std::string sheet = "v -0.3 0.2 -0.3\nv 0.3 0.2 -0.3\nv 0 0.2 0.3\nv 0 0.25 0\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
  const auto file = fake::write(folder, "sheet.obj", sheet);
  const auto in = write_arm(folder, "in.obj", true), out = write_arm(folder, "out.obj", false);
  CheckRequest check_request;
  check_request.file = file;
  check_request.bodies = {in};
  const CheckReport checked = check(check_request);
  CHECK(checked.inside_vertices == 1);
  CHECK(warnings_with(checked.warnings, "in.obj: the surface faced inwards") == 1);

  UntangleRequest untangle_request;
  untangle_request.file = file;
  untangle_request.out = folder.path / "parted.obj";
  untangle_request.bodies = {in};
  const UntangleReport parted = untangle_mesh(untangle_request);
  CHECK(warnings_with(parted.warnings, "turned outwards") == 1);
  untangle_request.bodies = {out};
  const UntangleReport right = untangle_mesh(untangle_request);
  CHECK(warnings_with(right.warnings, "turned outwards") == 0);
  CHECK(parted.result.x == right.result.x);

  PushRequest push_request;
  push_request.file = file;
  push_request.body = in;
  const PushReport pushed = push_mesh(push_request);
  CHECK(warnings_with(pushed.warnings, "turned outwards") == 1);
  push_request.body = out;
  CHECK(pushed.before.energy == push_mesh(push_request).before.energy);
}

TEST_CASE("Of a two-sided body one side counts, and it has an inside", "[outward]") {
  // The backs with vertices of their own, and a soup in which no triangle shares a vertex.
  const Folder folder("two_sided");
  const Mesh arm = read_mesh(write_arm(folder, "arm.obj", false));
  const auto n = static_cast<int>(arm.x.rows()), m = static_cast<int>(arm.triangles.rows());
  Points x(2 * n, 3), soup_x(6 * m, 3);
  x << arm.x, arm.x;
  Triangles both(2 * m, 3), soup(2 * m, 3);
  both << arm.triangles, flipped(arm.triangles).array() + n;
  for (int t = 0; t < 2 * m; ++t)
    for (int k = 0; k < 3; ++k) {
      soup(t, k) = 3 * t + k;
      soup_x.row(soup(t, k)) = x.row(both(t, k));
    }
  write_obj(folder.path / "both.obj", x, both);
  write_obj(folder.path / "soup.obj", soup_x, soup);
  for (const std::string name : {"both.obj", "soup.obj"}) {
    INFO(name);
    const Setup setup = sleeved(folder, "mesh: " + name);
    REQUIRE(setup.warnings.size() == 1);
    CHECK_THAT(setup.warnings[0], Contains(name + ": the surface is two-sided; " + std::to_string(m) + " triangles"));
    const RunSummary summary = fake::run(setup, *make_stepper(setup), folder.path / (name + ".run"));
    CHECK(summary.worst_inside > 0);  // the sleeve starts in the arm
    CHECK(TrajectoryReader(folder.path / (name + ".run") / "run.h5").frame(8).inside_vertices == 0);
  }
  // Two blocks side by side share a face, back to back, and keep it.
  const testing::Solid left = testing::block({-0.2, -0.1, -0.1}, {0, 0.1, 0.1}, 2);
  const testing::Solid other = testing::block({0, -0.1, -0.1}, {0.2, 0.1, 0.1}, 2);
  Triangles triangles(left.surface.triangles.rows() + other.surface.triangles.rows(), 3);
  triangles << left.surface.triangles, other.surface.triangles.array() + left.surface.vertex_count;
  Points blocks(left.x.rows() + other.x.rows(), 3);
  blocks << left.x, other.x;
  write_obj(folder.path / "blocks.obj", blocks, triangles);
  const Setup beside = sleeved(folder, "mesh: blocks.obj");
  CHECK(beside.scene.obstacles[0].surface.triangles.rows() == triangles.rows());
  CHECK(warnings_with(beside.warnings, "two-sided") == 0);
}

TEST_CASE("What is open and might be meant as solid is said to be open, by mesh", "[outward]") {
  const Folder folder("open_obstacles");
  const auto arm = fake::whole(write_arm(folder, "arm.obj", false));
  const auto lines_without = [&](int faces) {  // the last ones
    std::string text = arm;
    for (int k = 0; k < faces; ++k) text.erase(text.rfind("f "));
    return text;
  };
  fake::write(folder, "pot.obj", "g pot\n" + lines_without(3));
  const Setup pot = sleeved(folder, "mesh: pot.obj");
  CHECK(warnings_with(pot.warnings, "pot.obj, mesh `pot`: the surface is open (") == 1);
  fake::write(folder, "floor.obj", "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nf 1 3 2\n");
  CHECK(sleeved(folder, "mesh: floor.obj").warnings.empty());
}

}  // namespace selvedge::test_outward_obstacles
