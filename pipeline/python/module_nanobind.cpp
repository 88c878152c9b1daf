#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "collision/audit/audit.hpp"
#include "collision/geometry/error.hpp"
#include "collision/untangle/untangle.hpp"
#include "physics/scene/make_scene.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"
#include "pipeline/python/arrays_nanobind.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

// A scene with its state and stepper: from arrays, or from a scene file.
class World {
 public:
  World() { setup_.run.fps = 30; }

  World(const std::filesystem::path& file, const std::vector<std::string>& overrides)
      : setup_(read_setup(file, overrides)) {
    prepare(setup_);
    state_ = setup_.initial;
    stepper_ = make_stepper(setup_);
  }

  int add_cloth_arrays(const nb::handle& x, const nb::handle& triangles, const std::string& name, double density,
                       double youngs_modulus, double poisson, double bending) {
    must_be_open();
    const Points points = points_of(x, "cloth `" + name + "`, x");
    Material material;
    material.density = density;
    material.lame_mu = youngs_modulus / (2 * (1 + poisson));
    material.lame_lambda = youngs_modulus * poisson / (1 - poisson * poisson);
    material.bending = bending;
    const int number =
        add_cloth(setup_.scene, points, triangles_of(triangles, points.rows(), "cloth `" + name + "`, triangles"),
                  material, name);
    const Eigen::Index before = x_.rows();
    x_.conservativeResize(before + points.rows(), 3);
    x_.bottomRows(points.rows()) = points;
    return number;
  }

  int add_obstacle_arrays(const nb::handle& x, const nb::handle& triangles, const std::string& name) {
    must_be_open();
    obstacles_.push_back(points_of(x, "obstacle `" + name + "`, x"));
    return add_obstacle(setup_.scene, static_cast<int>(obstacles_.back().rows()),
                        triangles_of(triangles, obstacles_.back().rows(), "obstacle `" + name + "`, triangles"), true,
                        name);
  }

  void move_obstacle(int number, const nb::handle& x) {
    begin();
    const std::string where = "obstacle " + std::to_string(number);
    if (number < 0 || number >= std::ssize(obstacles_)) throw Error("is not there", where, "number obstacles from 0");
    Points to = points_of(x, where);
    if (to.rows() != obstacles_[static_cast<std::size_t>(number)].rows())
      throw Error("has " + std::to_string(to.rows()) + " rows, not as many as before", where, "give every vertex");
    obstacles_[static_cast<std::size_t>(number)] = std::move(to);
  }

  // One step; false where it was rejected, which leaves everything as it was.
  bool step() {
    begin();
    const double dt = 1 / setup_.run.fps;
    State next;
    const StepReport report = stepper_->step(state_, drive_at(state_.time + dt), dt, next);
    if (report.status != StepStatus::accepted) return false;
    keep(std::move(next), report);
    return true;
  }

  State& state() {
    begin();
    return state_;
  }
  int pairs() const { return pairs_; }
  double fps() const { return setup_.run.fps; }
  int frames() const { return setup_.run.frames; }
  const Triangles& triangles() const { return setup_.scene.surface.triangles; }

 private:
  void must_be_open() const {
    if (stepper_) throw Error("has been stepped", "scene", "add cloths and obstacles before the first step");
  }

  void begin() {
    if (stepper_) return;
    if (x_.rows() == 0) throw Error("has no cloth", "scene", "add one");
    state_ = first_state(setup_.scene, x_, obstacles_);
    stepper_ = make_recovering_conventional_stepper(setup_.scene);
  }

  Drive drive_at(double time) const {
    if (setup_.drive_at) return setup_.drive_at(time);
    Drive drive = at_rest(setup_.scene, state_);
    drive.obstacles = obstacles_;
    return drive;
  }

  // Writes into the existing arrays, so that views of them stay valid.
  void keep(State next, const StepReport& report) {
    Points x = std::move(state_.x), v = std::move(state_.v);
    std::vector<Points> obstacles = std::move(state_.obstacles);
    x = next.x;
    v = next.v;
    for (std::size_t k = 0; k < obstacles.size(); ++k) obstacles[k] = next.obstacles[k];
    state_ = std::move(next);
    state_.x.swap(x);
    state_.v.swap(v);
    state_.obstacles.swap(obstacles);
    pairs_ = report.collision.pairs_after;
  }

  Setup setup_;
  Points x_;
  std::vector<Points> obstacles_;
  State state_;
  std::unique_ptr<Stepper> stepper_;
  int pairs_ = -1;
};

struct Meshes {
  std::vector<Surface> surfaces;
  std::vector<Points> points;
};

Meshes meshes_of(const nb::list& bodies) {
  Meshes meshes;
  for (const nb::handle body : bodies) {
    const std::string where = "body " + std::to_string(meshes.points.size());
    if (!nb::isinstance<nb::sequence>(body) || nb::len(body) != 2)
      throw Error("is no pair", where, "give (x, triangles) for every body");
    meshes.points.push_back(points_of(body[0], where + ", x"));
    const Eigen::Index n = meshes.points.back().rows();
    meshes.surfaces.push_back(make_surface(static_cast<int>(n), triangles_of(body[1], n, where + ", triangles")));
  }
  return meshes;
}

nb::dict check_arrays(const nb::handle& x, const nb::handle& triangles, const nb::list& bodies) {
  const Points points = points_of(x, "x");
  const Surface cloth =
      make_surface(static_cast<int>(points.rows()), triangles_of(triangles, points.rows(), "triangles"));
  const Meshes meshes = meshes_of(bodies);
  std::vector<AuditBody> obstacles;
  for (std::size_t k = 0; k < meshes.points.size(); ++k) obstacles.push_back({&meshes.surfaces[k], &meshes.points[k]});
  const Audit found = audit(cloth, points, obstacles);
  nb::dict result;
  result["self_pairs"] = found.self_pairs.size();
  result["vertex_pairs"] = found.vertex_pairs.size();
  result["body_pairs"] = found.obstacle_pairs.size();
  result["inside_vertices"] = found.inside_vertices;
  return result;
}

nb::tuple untangle_arrays(const nb::handle& x, const nb::handle& triangles, const nb::list& bodies, int iterations) {
  const Points points = points_of(x, "x");
  const Surface cloth =
      make_surface(static_cast<int>(points.rows()), triangles_of(triangles, points.rows(), "triangles"));
  const Meshes meshes = meshes_of(bodies);
  std::vector<SheetView> obstacles;
  for (std::size_t k = 0; k < meshes.points.size(); ++k) obstacles.push_back({&meshes.surfaces[k], &meshes.points[k]});
  UntangleOptions options;
  options.iterations = iterations;
  const UntangleResult result = untangle(cloth, points, obstacles, options);
  nb::dict report;
  report["pairs_before"] = result.pairs_before;
  report["pairs_after"] = result.pairs_after;
  report["iterations"] = result.iterations;
  return nb::make_tuple(copy_of(result.x), report);
}

nb::dict read_trajectory(const std::filesystem::path& file) {
  const TrajectoryReader reader(file);
  nb::list x, time;
  for (int k = 0; k < reader.frame_count(); ++k) {
    const Frame frame = reader.frame(k);
    x.append(copy_of(Points(frame.x.cast<double>())));
    time.append(frame.time);
  }
  nb::dict result;
  result["triangles"] = copy_of(reader.info().triangles);
  result["fps"] = reader.info().fps;
  result["time"] = time;
  result["x"] = x;
  return result;
}

}  // namespace
}  // namespace selvedge

NB_MODULE(_selvedge, module) {
  using namespace selvedge;
  nb::exception<Error>(module, "Error", PyExc_ValueError);
  nb::class_<World>(module, "Scene",
                    "Cloths and obstacles with their state, stepped by the conventional stepper or as a file says.")
      .def(nb::init<>(), "A scene without anything, at 30 frames a second.")
      .def(nb::init<const std::filesystem::path&, const std::vector<std::string>&>(), "file"_a,
           "overrides"_a = std::vector<std::string>{}, "A scene file (YAML); overrides are key=value with dotted keys.")
      .def("add_cloth", &World::add_cloth_arrays, "x"_a, "triangles"_a, nb::kw_only(), "name"_a = "cloth",
           "density"_a = 0.2, "youngs_modulus"_a = 1000.0, "poisson"_a = 0.3, "bending"_a = 1e-5,
           "n x 3 positions at rest [m], m x 3 triangles; density [kg/m2], Young's modulus times thickness [N/m], "
           "bending [N m].")
      .def("add_obstacle", &World::add_obstacle_arrays, "x"_a, "triangles"_a, nb::kw_only(), "name"_a = "obstacle",
           "n x 3 positions [m], m x 3 triangles, counter-clockwise seen from outside.")
      .def("move_obstacle", &World::move_obstacle, "number"_a, "x"_a,
           "Where an obstacle is at the end of the next step [m].")
      .def("step", &World::step, nb::call_guard<nb::gil_scoped_release>(), "One frame; False where it was rejected.")
      .def_prop_ro(
          "x", [](nb::handle self) { return view_of(nb::cast<World&>(self).state().x, self); },
          "Positions of all cloths, n x 3 [m]: a view, which shows the present state after every step.")
      .def_prop_ro(
          "v", [](nb::handle self) { return view_of(nb::cast<World&>(self).state().v, self); },
          "Velocities, n x 3 [m/s]: a view.")
      .def_prop_ro(
          "triangles", [](const World& world) { return copy_of(world.triangles()); }, "m x 3, of all cloths.")
      .def_prop_ro(
          "time", [](World& world) { return world.state().time; }, "[s]")
      .def_prop_ro("frame", [](World& world) { return world.state().frame; })
      .def_prop_ro(
          "clean", [](World& world) { return world.state().clean; }, "Known to be free of intersections.")
      .def_prop_ro("pairs", &World::pairs, "Intersecting pairs of triangles after the last step; -1: not known.")
      .def_prop_ro("fps", &World::fps)
      .def_prop_ro("frames", &World::frames, "That the scene file asks for.");
  module.def("check", &check_arrays, "x"_a, "triangles"_a, "bodies"_a = nb::list(),
             "Audits a cloth, with itself and with bodies, a list of (x, triangles): counts by name.");
  module.def("untangle", &untangle_arrays, "x"_a, "triangles"_a, "bodies"_a = nb::list(), "iterations"_a = 300,
             "Parts a cloth from itself and from bodies: positions [m] and a report.");
  module.def("read_trajectory", &read_trajectory, "file"_a, "triangles, fps, time [s] and x [m] of every frame.");
}
