#include <catch2/catch.hpp>

#include <cstring>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "physics/frame/frame_audits.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/weights/carried_model_hdf5.hpp"
#include "tests/frame.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"

// What stepper.hpp asks of every stepper, of every kind that a scene file may name.
namespace selvedge::test_known_steppers {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

constexpr double dt = 1.0 / 30;

bool same_rows(const MemoryRows& a, const MemoryRows& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0);
}

bool same(const State& a, const State& b) {
  bool equal = a.time == b.time && a.frame == b.frame && same_rows(a.x, b.x) && same_rows(a.v, b.v) &&
               same_rows(joined_rows(a.obstacles), joined_rows(b.obstacles)) && a.pinched == b.pinched &&
               a.clean == b.clean && a.cut_out == b.cut_out && a.memory.size() == b.memory.size();
  for (std::size_t k = 0; equal && k < a.memory.size(); ++k)
    equal = a.memory[k].name == b.memory[k].name && same_rows(a.memory[k].rows, b.memory[k].rows);
  return equal;
}

// A sheet that hangs by a corner and falls on a ball that moves.
Setup scene_for(const std::string& kind, const Folder& folder, std::vector<std::string> overrides = {},
                const fake::NarrowNetwork& network = fake::narrow_network("contourcraft")) {
  if (kind == "learned" || kind == "hybrid") {
    write_weight_file(folder.path / "w.h5", {network.architecture, network.weights, "", {}, ""});
    overrides.push_back("run.learned.weights=w.h5");
  }
  if (kind == "carried_fitted") {
    write_taught_carried(folder.path / "w.h5", {{}, {"walk"}, 1, 36});
    overrides.push_back("run.learned.weights=w.h5");
  }
  overrides.push_back("run.stepper=" + kind);
  return read_setup(
      fake::write(folder, "scene.yaml",
                  "cloths: [{name: sheet, rectangle: {size: [0.3, 0.3], resolution: 6}, translate: [0, 0.3, 0], pins: "
                  "[{group: [top_left]}]}]\n"
                  "obstacles: [{name: ball, sphere: {radius: 0.1, edge: 0.04}, motion: {keyframes: [{time: 0}, {time: "
                  "1, translate: [0.3, 0, 0]}]}}]\ncontact: {thickness: 4 mm}\nrun: {fps: 30}\n"),
      overrides);
}

State after(Stepper& stepper, const Setup& setup, State state, int frames) {
  State to;
  for (int f = 0; f < frames; ++f) {
    REQUIRE(testing::frame(setup.scene, stepper, state, setup.drive_at(state.time + dt), dt, to).status ==
            StepStatus::accepted);
    state = to;
  }
  return state;
}

Eigen::Index rows_for(const Scene& scene, RowsOf rows_of, Eigen::Index else_rows) {
  Eigen::Index nodes = 0;
  for (const Obstacle& obstacle : scene.obstacles) nodes += obstacle.surface.vertex_count;
  switch (rows_of) {
    case RowsOf::vertices:
      return scene.surface.vertex_count;
    case RowsOf::triangles:
      return scene.surface.triangles.rows();
    case RowsOf::obstacle_vertices:
      return nodes;
    case RowsOf::cloths:
      return std::ssize(scene.cloths);
    default:
      return else_rows;
  }
}

}  // namespace

TEST_CASE("known steppers: a step fills what a state must have", "[known_steppers]") {
  for (const std::string& kind : known_kinds().names()) {
    INFO(kind);
    const Folder folder("contract_" + kind);
    const Setup setup = scene_for(kind, folder);
    const auto stepper = make_stepper(setup);
    CHECK(stepper->traits().name == kind);
    const State from = after(*stepper, setup, setup.initial, 4);
    State to;
    to.cut_out = {5};
    to.memory = {{"left.over", MemoryRows::Zero(1, 1)}};
    const Drive drive = setup.drive_at(from.time + dt);
    const StepReport report = testing::frame(setup.scene, *stepper, from, drive, dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.by.starts_with(kind));
    CHECK(report.substeps > 0);
    CHECK(to.time == Approx(from.time + dt));
    CHECK(to.frame == from.frame + 1);
    CHECK((to.x.rows() == from.x.rows() && to.x.allFinite()));
    CHECK((to.v.rows() == from.x.rows() && to.v.allFinite()));
    for (std::size_t p = 0; p < setup.scene.pins.size(); ++p)
      CHECK((to.x.row(setup.scene.pins[p]) - drive.pins.row(static_cast<Eigen::Index>(p))).norm() < 1e-12);
    REQUIRE(to.obstacles.size() == drive.obstacles.size());
    CHECK(to.pinched == (report.collision.obstacle_lag > 0));
    if (!to.pinched) CHECK((to.obstacles[0] - drive.obstacles[0]).cwiseAbs().maxCoeff() < 1e-12);
    const Audit audit = audit_positions(setup.scene, to.x, to.obstacles);
    REQUIRE(report.audit);
    CHECK(report.audit->intersecting_pairs() == audit.intersecting_pairs());
    CHECK(report.collision.pairs_after == audit.intersecting_pairs());
    CHECK(to.clean == (audit.intersecting_pairs() == 0 && audit.inside_vertices == 0));
    CHECK(to.cut_out.empty());
    for (const MemoryBlock& block : to.memory) {
      INFO(block.name);
      CHECK(block.name != "left.over");
      CHECK(block.name.find('.') != std::string::npos);
      CHECK(block.rows.rows() == rows_for(setup.scene, block.rows_of, block.rows.rows()));
      if (block.positions) CHECK(block.rows.cols() == 3);
    }
  }
}

TEST_CASE("known steppers: a step is taken back by doing nothing, and one that is rejected leaves its start",
          "[known_steppers]") {
  for (const std::string& kind : known_kinds().names()) {
    INFO(kind);
    const Folder folder("back_" + kind);
    const Setup setup = scene_for(kind, folder);
    const auto stepper = make_stepper(setup);
    const State from = after(*stepper, setup, setup.initial, 3), kept = from;
    State first, further, again;
    const Drive drive = setup.drive_at(from.time + dt);
    testing::frame(setup.scene, *stepper, from, drive, dt, first);
    testing::frame(setup.scene, *stepper, first, setup.drive_at(first.time + dt), dt, further);
    testing::frame(setup.scene, *stepper, from, drive, dt, again);
    CHECK(same(from, kept));
    CHECK(same(first, again));

    State broken = from;
    broken.x(2, 1) = broken.v(2, 1) = std::numeric_limits<double>::quiet_NaN();
    const State before = broken;
    const StepReport report = testing::frame(setup.scene, *stepper, broken, drive, dt, further);
    CHECK(report.status == StepStatus::rejected);
    CHECK(report.reason == Reason::not_finite);
    CHECK(same(broken, before));
    testing::frame(setup.scene, *stepper, from, drive, dt, again);
    CHECK(same(first, again));
  }
}

TEST_CASE("known steppers: dropping all caches every third step changes nothing", "[known_steppers]") {
  for (const std::string& kind : known_kinds().names()) {
    INFO(kind);
    const Folder folder("caches_" + kind);
    const Setup setup = scene_for(kind, folder);
    auto kept = make_stepper(setup), dropped = make_stepper(setup);
    State a = setup.initial, b = setup.initial;
    for (int f = 0; f < 9; ++f) {
      a = after(*kept, setup, a, 1);
      if (f % 3 == 2) dropped = make_stepper(setup);
      b = after(*dropped, setup, b, 1);
      CHECK(same(a, b));
    }
    CHECK((a.x - setup.initial.x).cwiseAbs().maxCoeff() > 1e-3);
  }
}

TEST_CASE("known steppers: `carried_rough` makes the frames of the quality `draft`, whatever the scene's quality is",
          "[known_steppers]") {
  const Folder folder("carried_rough");
  const auto end = [&](const std::string& kind, const std::string& quality) {
    const Setup setup = scene_for(kind, folder, {"run.quality=" + quality});
    return after(*make_stepper(setup), setup, setup.initial, 6);
  };
  const State rough = end("carried_rough", "fine");
  CHECK(same(rough, end("conventional", "draft")));
  CHECK_FALSE(same(rough, end("conventional", "preview")));
  CHECK(find_rows(rough.memory, "carried.target", rough.x.rows()));
}

TEST_CASE("known steppers: a network beside the carried guess, behind the response and behind a rough solve",
          "[known_steppers][student]") {
  for (const std::string mode : {"response", "rough"}) {
    INFO(mode);
    const Folder folder("student_" + mode);
    // Pins would stretch a sheet whose guess is free fall, and behind the response nothing is solved.
    const std::string pins = mode == "rough" ? "[{group: [top_left]}]" : "[]";
    const Setup setup = scene_for("hybrid", folder, {"run.hybrid.mode=" + mode, "cloths.0.pins=" + pins},
                                  fake::narrow_network("student", 1e-5));
    auto kept = make_stepper(setup), dropped = make_stepper(setup);
    State a = setup.initial, b = setup.initial;
    int proposed = 0;
    for (int f = 0; f < 9; ++f) {
      State to;
      const StepReport report = testing::frame(setup.scene, *kept, a, setup.drive_at(a.time + dt), dt, to);
      REQUIRE(report.status == StepStatus::accepted);
      CHECK(to.clean);
      proposed += report.verdict == (mode == "rough" ? Verdict::refined : Verdict::admitted);
      a = to;
      if (f % 3 == 2) dropped = make_stepper(setup);
      b = after(*dropped, setup, b, 1);
      CHECK(same(a, b));
      CHECK(find_rows(a.memory, "carried.target", a.x.rows()));
    }
    CHECK(proposed > 0);
  }
}

TEST_CASE("known steppers: what the traits do not accept is refused", "[known_steppers]") {
  for (const std::string& kind : known_kinds().names()) {
    INFO(kind);
    const Folder folder("refused_" + kind);
    const Setup setup = scene_for(kind, folder);
    const auto stepper = make_stepper(setup);
    const StepperTraits& traits = stepper->traits();
    CHECK(traits.accepts(dt));
    CHECK_FALSE(traits.accepts(0));
    const Setup faster = scene_for(kind, folder, {"run.fps=60"});
    if (traits.accepts(1.0 / 60)) {
      CHECK_NOTHROW(make_stepper(faster));
      continue;
    }
    CHECK_THROWS_WITH(make_stepper(faster),
                      Contains("the stepper `" + kind + "` does not take this scene") && Contains("run.fps"));
    State to;
    CHECK_THROWS_AS(testing::frame(setup.scene, *stepper, setup.initial, setup.drive_at(1.0 / 60), 1.0 / 60, to),
                    Error);
  }
}

TEST_CASE("known steppers: a run says what of the scene its stepper ignores, and shows no energy of it",
          "[known_steppers]") {
  for (const std::string& kind : known_kinds().names()) {
    INFO(kind);
    const Folder folder("ignored_" + kind);
    Setup setup = scene_for(kind, folder, {"run.frames=1", "wind.velocity=[1, 0, 0]"});
    setup.scene.springs = {{0, 14, 0.05, 10}};
    Material& material = setup.scene.cloths[0].material;
    material.mass_damping = material.stiffness_damping = 0.01;
    const auto stepper = make_stepper(setup);
    const std::vector<std::string>& ignored = stepper->traits().ignores;
    const auto is_ignored = [&](const std::string& force) {
      return std::ranges::find(ignored, force) != ignored.end();
    };
    const std::vector<PlanLine> plan = plan_lines(setup.scene);
    for (const std::string& force : ignored)
      CHECK(std::ranges::find(plan, force, &PlanLine::feature) != plan.end());  // each is a feature of the plan
    const auto left_out = std::ranges::count_if(plan, [&](const PlanLine& l) { return l.in && is_ignored(l.feature); });
    CHECK(std::ssize(ignored_lines(setup.scene, stepper->traits())) == left_out);
    const bool none = is_ignored("springs");
    CHECK(none == (kind == "learned" || kind == "carried" || kind == "carried_fitted"));
    RunRequest request;
    request.out = folder.path / "out";
    const RunSummary summary = run_scene(setup, *prepare(setup), *stepper, request);
    CHECK(summary.warnings.size() == scene_warnings(setup).size() + static_cast<std::size_t>(left_out));
    CHECK(std::ranges::any_of(summary.left_out, [](const PlanLine& l) { return l.feature == "springs"; }) == none);
    const TrajectoryReader reader(request.out / "run.h5");
    for (int frame = 0; frame < reader.frame_count(); ++frame) {
      CHECK(std::isnan(reader.frame(frame).energy.springs) == none);
      CHECK(std::isfinite(reader.frame(frame).energy.membrane) == !is_ignored("membrane"));
    }
  }
}

}  // namespace selvedge::test_known_steppers
