#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>

#include "collision/geometry/error.hpp"
#include "collision/geometry/same_places.hpp"
#include "collision/geometry/welded_surface.hpp"
#include "physics/frame/make_frame.hpp"
#include "physics/scene/make_scene.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/python/arrays_nanobind.hpp"
#include "pipeline/python/bindings_nanobind.hpp"
#include "pipeline/python/fields_nanobind.hpp"
#include "pipeline/python/stepper_nanobind.hpp"
#include "pipeline/reports/report_fields.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

// A scene with its state and stepper: from arrays, or from a scene file.
class World {
 public:
  explicit World(const nb::object& stepper)
      : make_(stepper.is_none() ? conventional_maker() : python_maker("python", stepper, held_)) {
    setup_.run.fps = 30;
  }

  World(const std::filesystem::path& file, const std::vector<std::string>& overrides, const nb::dict& kinds)
      : setup_(read_setup(file, overrides, kinds_with(kinds, held_))) {
    warn(scene_warnings(setup_));
    state_ = prepare(setup_)->state;
    stepper_ = make_stepper(setup_);
  }

  int add_cloth_arrays(const nb::handle& x, const nb::handle& triangles, const std::string& name, double density,
                       double youngs_modulus, double poisson, double bending) {
    must_be_open();
    const Points points = points_of(x, "cloth `" + name + "`, x");
    Material material;
    material.density = density;
    material.bending = bending;
    set_elasticity({youngs_modulus, poisson}, "cloth `" + name + "`, material", material);
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
    const std::string noun = "obstacle `" + name + "`";
    obstacles_.push_back(points_of(x, noun + ", x"));
    Triangles faces = triangles_of(triangles, obstacles_.back().rows(), noun + ", triangles");
    if (obstacles_.back().allFinite()) turn_outward_warning(noun, obstacles_.back(), faces);
    const int number = add_obstacle(setup_.scene, static_cast<int>(obstacles_.back().rows()), faces, true, name);
    joined_.emplace_back();
    if (!obstacles_.back().allFinite()) return number;
    Surface& surface = setup_.scene.obstacles.back().surface;
    if (std::optional<WeldedSurface> welded = welded_surface(surface, same_places(obstacles_.back()))) {
      surface = std::move(welded->surface);
      joined_.back() = std::move(welded->joined);
      hold_together(joined_.back(), obstacles_.back());
    }
    return number;
  }

  void move_obstacle(int number, const nb::handle& x) {
    begin();
    const std::string where = "obstacle " + std::to_string(number);
    if (number < 0 || number >= std::ssize(obstacles_)) throw Error("is not there", where, "number obstacles from 0");
    Points to = points_of(x, where);
    if (to.rows() != obstacles_[static_cast<std::size_t>(number)].rows())
      throw Error("has " + std::to_string(to.rows()) + " rows, not as many as before", where, "give every vertex");
    const std::vector<int>& joined = joined_[static_cast<std::size_t>(number)];
    const std::vector<int> places = joined.empty() ? joined : same_places(to);
    for (std::size_t v = 0; v < places.size(); ++v)
      if (places[v] != places[static_cast<std::size_t>(joined[v])])
        throw Error("opens a seam: vertex " + std::to_string(v) + " leaves vertex " + std::to_string(joined[v]) +
                        ", where it lay when the obstacle was added",
                    where, "add parts that come apart as obstacles of their own");
    hold_together(joined, to);
    obstacles_[static_cast<std::size_t>(number)] = std::move(to);
  }

  // One step; false where it was rejected, which leaves everything as it was.
  bool step() {
    begin();
    check_state(setup_.scene, state_);  // whose arrays Python may have written to
    const double dt = 1 / setup_.run.fps;
    State next;
    report_ = make_frame(*stepper_, audits_, state_, drive_at(state_.time + dt), dt, next);
    if (report_->status != StepStatus::accepted) return false;
    keep(std::move(next));
    pairs_ = report_->collision.pairs_after;
    return true;
  }

  State& state() {
    begin();
    return state_;
  }
  int pairs() const { return pairs_; }
  nb::dict report() const { return report_ ? dict_of(report_fields(), *report_) : nb::dict(); }
  double fps() const { return setup_.run.fps; }
  int frames() const { return setup_.run.frames; }
  const Triangles& triangles() const { return setup_.scene.surface.triangles; }

  // For Python's collector of cycles: all that it holds of Python, and to let go of it. It is no use after that.
  static int traverse(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    if (!nb::inst_ready(self)) return 0;
    for (const auto& one : *nb::inst_ptr<World>(self)->held_)
      if (const auto object = one.lock()) Py_VISIT(object->ptr());
    return 0;
  }
  static int clear(PyObject* self) {
    World& world = *nb::inst_ptr<World>(self);
    world.stepper_.reset();
    world.make_ = {};
    world.setup_.kind = {};
    return 0;
  }

 private:
  void must_be_open() const {
    if (stepper_) throw Error("has been stepped", "scene", "add cloths and obstacles before the first step");
  }

  void begin() {
    if (stepper_) return;
    if (x_.rows() == 0) throw Error("has no cloth", "scene", "add one");
    state_ = first_state(setup_.scene, x_, obstacles_);
    stepper_ = decorated(setup_.scene, make_);
  }

  Drive drive_at(double time) const {
    if (setup_.drive_at) return setup_.drive_at(time);
    Drive drive = at_rest(setup_.scene, state_);
    drive.obstacles = obstacles_;
    return drive;
  }

  // Writes into the existing arrays, so that views of them stay valid.
  void keep(State next) {
    Points x = std::move(state_.x), v = std::move(state_.v);
    std::vector<Points> obstacles = std::move(state_.obstacles);
    x = next.x;
    v = next.v;
    for (std::size_t k = 0; k < obstacles.size(); ++k) obstacles[k] = next.obstacles[k];
    state_ = std::move(next);
    state_.x.swap(x);
    state_.v.swap(v);
    state_.obstacles.swap(obstacles);
  }

  HeldObjects held_ = std::make_shared<HeldObjects::element_type>();
  Setup setup_;
  MakeStepper make_;  // of a scene from arrays
  Points x_;
  std::vector<Points> obstacles_;
  std::vector<std::vector<int>> joined_;  // of each obstacle (welded_surface.hpp)
  State state_;
  std::unique_ptr<Stepper> stepper_;
  FrameAudits audits_{setup_.scene};
  std::optional<StepReport> report_;  // of the last step
  int pairs_ = -1;
};

}  // namespace

void bind_scene(nb::module_& module) {
  static PyType_Slot collected[] = {{Py_tp_traverse, reinterpret_cast<void*>(World::traverse)},
                                    {Py_tp_clear, reinterpret_cast<void*>(World::clear)},
                                    {0, nullptr}};
  nb::class_<World>(module, "Scene", nb::type_slots(collected),
                    "Cloths and obstacles with their state, stepped by the conventional stepper or as a file says.")
      .def(nb::init<const std::filesystem::path&, const std::vector<std::string>&, const nb::dict&>(), "file"_a,
           "overrides"_a = std::vector<std::string>{}, "kinds"_a = nb::dict(),
           "A scene file (YAML). overrides: key=value with dotted keys. kinds: names that run.stepper may have beside "
           "the known ones, each with its subclass of Stepper.")
      .def(nb::init<const nb::object&>(), nb::kw_only(), "stepper"_a = nb::none(),
           "A scene without anything, at 30 frames a second, under gravity. stepper: a subclass of Stepper; None: the "
           "conventional one.")
      .def("add_cloth", &World::add_cloth_arrays, "x"_a, "triangles"_a, nb::kw_only(), "name"_a = "cloth",
           "density"_a = 0.2, "youngs_modulus"_a = 1000.0, "poisson"_a = 0.3, "bending"_a = 1e-5,
           "Appends a cloth and returns its number. x: rest positions, n x 3 [m]; triangles: m x 3, whole numbers of "
           "0 .. n - 1; density [kg/m2]; youngs_modulus: times thickness [N/m]; poisson [1]; bending [N m].")
      .def("add_obstacle", &World::add_obstacle_arrays, "x"_a, "triangles"_a, nb::kw_only(), "name"_a = "obstacle",
           "Appends an obstacle and returns its number. x: positions, n x 3 [m]; triangles: m x 3, counter-clockwise "
           "seen from outside.")
      .def("move_obstacle", &World::move_obstacle, "number"_a, "x"_a,
           "x: where every vertex of an obstacle is to be at the end of the next step, n x 3 [m].")
      .def("step", &World::step, nb::call_guard<nb::gil_scoped_release>(),
           "Steps one frame of 1 / fps [s]. False: the step was rejected, and everything is as it was.")
      .def_prop_ro(
          "x", [](nb::handle self) { return view_of(nb::cast<World&>(self).state().x, self); },
          "Positions of all cloths on end, n x 3 [m]: a view without a copy, which shows the present state after every "
          "step. What is written to it changes the state.")
      .def_prop_ro(
          "v", [](nb::handle self) { return view_of(nb::cast<World&>(self).state().v, self); },
          "Velocities, n x 3 [m/s]: a view without a copy.")
      .def_prop_ro(
          "triangles", [](const World& world) { return copy_of(world.triangles()); }, "m x 3, of all cloths: a copy.")
      .def_prop_ro(
          "time", [](World& world) { return world.state().time; }, "Of the present state [s].")
      .def_prop_ro(
          "frame", [](World& world) { return world.state().frame; }, "Steps made so far.")
      .def_prop_ro(
          "clean", [](World& world) { return world.state().clean; }, "Known to be free of intersections.")
      .def_prop_ro("pairs", &World::pairs, "Intersecting pairs of triangles after the last step; -1: not known.")
      .def_prop_ro("report", &World::report,
                   "What came of the last step, accepted or rejected, by the names of docs/files.md; empty before one.")
      .def_prop_ro("fps", &World::fps, "Frames a second.")
      .def_prop_ro("frames", &World::frames, "That the scene file asks for; 0 of a scene from arrays.");
}

}  // namespace selvedge
