#include <catch2/catch.hpp>

#include "physics/scene/features.hpp"
#include "physics/scene/stepper.hpp"
#include "tests/physics/meshes.hpp"

namespace selvedge::test_features {

using meshes::grid;

namespace {

Scene plain() { return meshes::make_scene(grid(3, 3, 1, 1)); }

PlanLine line(const Scene& scene, const std::string& feature) {
  for (const PlanLine& entry : plan_lines(scene))
    if (entry.feature == feature) return entry;
  FAIL("no line for " << feature);
  return {};
}

}  // namespace

TEST_CASE("features: a plain cloth needs membrane, bending, self-contact and friction, nothing else", "[features]") {
  const Features f = features_of(plain());
  CHECK((f.membrane && f.curvature_bending && f.self_contact && f.friction));
  CHECK_FALSE((f.obstacles || f.moving_obstacles || f.hinge_bending || f.curved_rest));
  CHECK_FALSE((f.stiffness_damping || f.mass_damping || f.wind || f.pins));
}

TEST_CASE("features: each follows its data", "[features]") {
  Scene scene = plain();
  Material& material = scene.cloths[0].material;
  material.bending_model = BendingModel::hinge;
  material.stiffness_damping = 1e-3;
  material.mass_damping = 0.1;
  scene.rest_is_flat = false;
  scene.wind.on = true;
  scene.pins = {0, 3};
  scene.obstacles = {Obstacle{"floor", {}, false}, Obstacle{"hand", {}, true}};
  const Features f = features_of(scene);
  CHECK((f.hinge_bending && f.curved_rest && f.stiffness_damping && f.mass_damping));
  CHECK((f.wind && f.pins && f.obstacles && f.moving_obstacles));
  CHECK_FALSE(f.curvature_bending);

  material.bending = 0;
  material.lame_mu = material.lame_lambda = 0;
  scene.wind.drag = 0;
  scene.obstacles[1].moving = false;
  const Features g = features_of(scene);
  CHECK_FALSE((g.hinge_bending || g.curved_rest || g.membrane || g.wind || g.moving_obstacles));
  material.membrane = MembraneModel::baraff_witkin;
  CHECK(features_of(scene).membrane);
}

TEST_CASE("features: friction needs something to touch", "[features]") {
  Scene scene = plain();
  scene.contact.self = false;
  CHECK_FALSE(features_of(scene).friction);
  scene.obstacles = {Obstacle{"floor", {}, false}};
  CHECK(features_of(scene).friction);
  scene.contact.friction = 0;
  CHECK_FALSE(features_of(scene).friction);
  scene.contact.self = true;
  CHECK(features_of(scene).friction);
  scene.contact.self_friction = 0;
  CHECK_FALSE(features_of(scene).friction);
}

TEST_CASE("features: bending needs an inside", "[features]") {
  Scene ribbon = meshes::make_scene(grid(1, 4, 0.1, 1));
  CHECK_FALSE(features_of(ribbon).curvature_bending);
  ribbon.cloths[0].material.bending_model = BendingModel::hinge;
  CHECK(features_of(ribbon).hinge_bending);
  Scene loose;
  CHECK_FALSE((features_of(loose).self_contact || features_of(loose).membrane || features_of(loose).friction));
}

TEST_CASE("plan: a line for every feature, in or out, with a reason that has the numbers", "[features]") {
  Scene scene = plain();
  meshes::add_cloth(scene, grid(2, 2, 1, 1), {});
  for (const PlanLine& entry : plan_lines(scene)) {
    CHECK_FALSE(entry.why.empty());
    CHECK((entry.why.find("left out") == std::string::npos) == entry.in);
  }
  CHECK(line(scene, "bending (curvature)").why == "curvature form, 2 cloths with bending > 0");
  CHECK(line(scene, "obstacles").why == "left out, the scene has none");
  CHECK(line(scene, "membrane").why == "2 cloths, 26 triangles");
  scene.pins = {4};
  CHECK(line(scene, "pins").why == "1 vertex held");
  CHECK(line(scene, "self-contact").in);
  scene.contact.self = false;
  CHECK(line(scene, "self-contact").why == "left out by the user; the file is labelled self: not audited");
  CHECK_FALSE(line(scene, "self-contact").in);
}

TEST_CASE("plan: springs have a line where there are any", "[features]") {
  Scene scene = plain();
  CHECK_FALSE(features_of(scene).springs);
  for (const PlanLine& entry : plan_lines(scene)) CHECK(entry.feature != "springs");
  scene.springs = {{0, 5, 0.1, 10}};
  CHECK(features_of(scene).springs);
  CHECK(line(scene, "springs").why == "1 pair of vertices joined");
}

TEST_CASE("plan: what a stepper ignores has a line where the scene has it, and no other", "[features]") {
  Scene scene = plain();
  const StepperTraits traits{.name = "some", .ignores = {"springs", "wind", "mass damping"}};
  CHECK(ignored_lines(scene, traits).empty());
  scene.springs = {{0, 5, 0.1, 10}};
  scene.cloths[0].material.mass_damping = 1;
  CHECK(ignored_lines(scene, {.name = "other"}).empty());
  const std::vector<PlanLine> lines = ignored_lines(scene, traits);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].feature == "mass damping");
  CHECK(lines[1].feature == "springs");
  CHECK(lines[1].why == "1 pair of vertices joined, which the stepper `some` ignores");
  CHECK_FALSE((lines[0].in || lines[1].in));
}

TEST_CASE("features: a scene without what a stepper ignores lacks all of it, and nothing else", "[features]") {
  Scene scene = plain();
  scene.springs = {{0, 5, 0.1, 10}};
  scene.wind.on = true;
  scene.cloths[0].material.mass_damping = scene.cloths[0].material.stiffness_damping = 1;
  std::vector<std::string> forces;
  for (const PlanLine& entry : plan_lines(scene)) forces.push_back(entry.feature);
  for (const std::string force :
       {"springs", "wind", "mass damping", "stiffness damping", "membrane", "bending (curvature)"}) {
    INFO(force);
    REQUIRE(line(scene, force).in);
    const Scene without = without_ignored(scene, {.name = "some", .ignores = {force}});
    for (const std::string& other : forces) {
      if (other == "springs" && force == "springs") continue;  // it has no line where there are none
      INFO(other);
      CHECK(line(without, other).in == (other != force && line(scene, other).in));
    }
    CHECK(without.springs.empty() == (force == "springs"));
  }
}

}  // namespace selvedge::test_features
