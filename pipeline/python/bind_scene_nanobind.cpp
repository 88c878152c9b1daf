#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <exception>

#include "collision/geometry/error.hpp"
#include "collision/geometry/parallel.hpp"
#include "pipeline/python/arrays_nanobind.hpp"
#include "pipeline/python/bindings_nanobind.hpp"
#include "pipeline/python/fields_nanobind.hpp"
#include "pipeline/python/python_stop_nanobind.hpp"
#include "pipeline/python/scene_nanobind.hpp"
#include "pipeline/reports/report_fields.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

// Puts an array where a view is: `scene.x = array`, and `scene.x += array`, which changes the view first.
void put(const nb::handle& array, const std::string& name, Points& present) {
  const Points given = points_of(array, name, NotFinite::allowed);
  if (given.rows() != present.rows())
    throw Error(
        "has " + std::to_string(given.rows()) + " rows, the scene has " + std::to_string(present.rows()) + " vertices",
        name, "give every vertex");
  present = given;
}

nb::list cloths_of(const SceneObject& scene) {
  nb::list cloths;
  for (const Cloth& cloth : scene.scene().cloths)
    cloths.append(nb::make_tuple(cloth.name, cloth.first_vertex, cloth.first_vertex + cloth.vertex_count));
  return cloths;
}

nb::list obstacles_of(const SceneObject& scene) {
  nb::list obstacles;
  for (std::size_t k = 0; k < scene.obstacles().size(); ++k) {
    const Obstacle& obstacle = scene.scene().obstacles[k];
    nb::dict one;
    one["name"] = obstacle.name;
    one["x"] = copy_of(scene.obstacles()[k]);
    one["triangles"] = copy_of(obstacle.surface.triangles);
    obstacles.append(one);
  }
  return obstacles;
}

nb::dict report_of(const SceneObject& scene) {
  return scene.report() ? dict_of(report_fields(), *scene.report()) : nb::dict();
}

nb::object contact_forces_of(SceneObject& scene) {
  const ContactForces* forces = scene.contact_forces();
  if (!forces) return nb::none();
  nb::dict arrays;
  arrays["normal"] = copy_of(forces->normal);
  arrays["friction"] = copy_of(forces->friction);
  arrays["pressure"] = copy_of(forces->pressure);
  return arrays;
}

// A scene's frame, made beside those of others, or what was thrown.
struct BesideOthers {
  std::optional<SteppedFrame> frame;
  std::exception_ptr trouble;
};

nb::list step_scenes(const nb::handle& scenes) {
  std::vector<SceneObject*> all;
  const nb::list held = list_of(scenes, "step, scenes", "give a list of scenes");  // keeps them while they step
  for (const nb::handle item : held) {
    const std::string where = "step, scene " + std::to_string(all.size());
    if (!nb::isinstance<SceneObject>(item)) throw Error("is no Scene", where, "give a list of scenes");
    SceneObject* scene = nb::inst_ptr<SceneObject>(item);
    if (std::ranges::find(all, scene) != all.end()) throw Error("is in the list twice", where, "give each once");
    all.push_back(scene);
  }
  PythonStop stop;
  std::vector<BesideOthers> made(all.size());
  {
    const nb::gil_scoped_release unlocked;
    const StopFlag flag = [&] { return stop.asked(); };
    const auto make = [&](int k) {
      const auto place = static_cast<std::size_t>(k);
      try {
        made[place].frame = all[place]->next_frame(flag);
      } catch (...) {
        made[place].trouble = std::current_exception();
      }
    };
    if (all.size() == 1)
      make(0);  // with all threads
    else
      parallel_for(static_cast<int>(all.size()), 1, make);
  }
  stop.raise_kept();
  nb::list accepted;
  for (std::size_t k = 0; k < all.size(); ++k)
    accepted.append(made[k].frame && all[k]->keep(*std::move(made[k].frame)));
  for (const BesideOthers& one : made)
    if (one.trouble) std::rethrow_exception(one.trouble);
  return accepted;
}

}  // namespace

void bind_scene(nb::module_& module) {
  static PyType_Slot collected[] = {{Py_tp_traverse, reinterpret_cast<void*>(SceneObject::traverse)},
                                    {Py_tp_clear, reinterpret_cast<void*>(SceneObject::clear)},
                                    {0, nullptr}};
  nb::class_<SceneObject>(
      module, "Scene", nb::type_slots(collected),
      "Cloths and obstacles with their state, stepped by the conventional stepper or as a file says.")
      .def(nb::init<const std::filesystem::path&, const nb::object&, const nb::dict&>(), "file"_a,
           "overrides"_a = nb::tuple(), "kinds"_a = nb::dict(),
           "A scene file (YAML). overrides: a list of texts key=value with dotted keys, or a dict of them. kinds: "
           "names that run.stepper may have beside the known ones, each with its subclass of Stepper.")
      .def(nb::init<const nb::object&, bool>(), nb::kw_only(), "stepper"_a = nb::none(), "contact_forces"_a = false,
           "A scene without anything, at 30 frames a second, under gravity. stepper: a subclass of Stepper; None: the "
           "conventional one. contact_forces: whether steps find them.")
      .def("add_cloth", &SceneObject::add_cloth_arrays, "x"_a, "triangles"_a, nb::kw_only(), "name"_a = nb::none(),
           "density"_a = nb::none(), "youngs_modulus"_a = nb::none(), "poisson"_a = nb::none(),
           "bending"_a = nb::none(), "material"_a = nb::none(), "pins"_a = nb::none(),
           "Appends a cloth and returns its number. x: rest positions, n x 3 [m]; triangles: m x 3, whole numbers of "
           "0 .. n - 1; density [kg/m2], 0.2; youngs_modulus: times thickness [N/m], 1000; poisson [1], 0.3; bending "
           "[N m], 1e-5; material, in place of these: a name, or a dict with the keys of `material` in scene files; "
           "pins: vertices that stay where they are.")
      .def(
          "add_garment", &SceneObject::add_garment_arrays, "x"_a, "triangles"_a, nb::kw_only(), "name"_a = nb::none(),
          "on"_a = nb::none(), "material"_a = nb::none(), "fit"_a = "loose", "pins"_a = nb::none(), "keys"_a,
          "Appends a cloth that a body wears, and returns its number. x: where the body wears it in its zero pose, "
          "n x 3 [m], which is its rest shape; triangles: m x 3; on: the body's name (the only one); material: a name, "
          "or a dict with the keys of `material` in scene files; fit: how it takes weights from the body, `loose` or "
          "`tight`; pins: vertices that stay with the body (the waists of pieces that would fall). keys: further keys "
          "of `cloths` in scene files, such as start={\"from\": \"draped\"}.")
      .def("add_body", &SceneObject::add_body_arrays, "x"_a, "triangles"_a, "joints"_a, "weights"_a, "parents"_a,
           nb::kw_only(), "poses"_a = nb::none(), "translations"_a = nb::none(), "fps"_a = 30.0,
           "joint_names"_a = nb::none(), "name"_a = nb::none(), "room"_a = nb::none(), "keys"_a,
           "Appends an obstacle that is a skinned body, and returns its number. In its zero pose: x, n x 3 [m]; "
           "triangles, m x 3, counter-clockwise seen from outside; joints, j x 3 [m]; weights, n x j, rows sum to 1; "
           "parents, of each joint, before it, -1 for the first. Its motion: poses, frames x j x 3, axis times angle "
           "relative to the parent [rad]; translations, frames x 3 [m]; fps. Without poses it stands in the zero pose. "
           "room: the gap that soft tissue keeps open between parts of the body [m], 0: none. keys: further keys of "
           "`obstacles` in scene files, such as translate.")
      .def("add_obstacle", &SceneObject::add_obstacle_arrays, "x"_a, "triangles"_a, nb::kw_only(),
           "name"_a = nb::none(),
           "Appends an obstacle and returns its number. x: positions, n x 3 [m]; triangles: m x 3, counter-clockwise "
           "seen from outside.")
      .def("move_obstacle", &SceneObject::move_obstacle, "number"_a, "x"_a,
           "x: where every vertex of an obstacle is to be at the end of the next step, n x 3 [m].")
      .def("step", &SceneObject::step,
           "Steps one frame of 1 / fps [s]. False: the step was rejected, and everything is as it was. Ctrl-C ends it, "
           "and everything is as it was.")
      .def("save", &SceneObject::save, "file"_a, "Writes the present state in full precision (HDF5), for restore.")
      .def("restore", &SceneObject::restore, "file"_a,
           "Goes back to a state that save wrote of this scene, or of one that was made of the same arrays or files. "
           "The next steps have the same bits.")
      .def("_record", &SceneObject::record, "folder"_a, "Records the present state and every frame after it.")
      .def("_end_recording", &SceneObject::end_recording, "Closes the file of a recording.")
      .def("__repr__", &SceneObject::described)
      .def("__reduce__",
           [](const SceneObject&) -> nb::object {
             throw Error("cannot be copied or sent to another process", "scene",
                         "make one there of the same arrays or file; `save` and `restore` carry its state");
           })
      .def_prop_rw(
          "x", [](nb::handle self) { return view_of(nb::cast<SceneObject&>(self).state().x, self); },
          [](SceneObject& scene, const nb::handle& array) { put(array, "x", scene.state().x); },
          "Positions of all cloths on end, n x 3 [m]: a view without a copy, which shows the present state after every "
          "step. What is written to it changes the state.")
      .def_prop_rw(
          "v", [](nb::handle self) { return view_of(nb::cast<SceneObject&>(self).state().v, self); },
          [](SceneObject& scene, const nb::handle& array) { put(array, "v", scene.state().v); },
          "Velocities, n x 3 [m/s]: a view without a copy.")
      .def_prop_ro(
          "triangles", [](const SceneObject& scene) { return copy_of(scene.scene().surface.triangles); },
          "m x 3, of all cloths: a copy.")
      .def_prop_ro(
          "rest", [](const SceneObject& scene) { return copy_of(scene.scene().rest); },
          "Rest positions of all cloths, n x 3 [m]: a copy.")
      .def_prop_ro("cloths", &cloths_of, "Of each cloth: its name, its first vertex and the end of its vertices.")
      .def_prop_ro("obstacles", &obstacles_of,
                   "Of each obstacle: its name, where it is now, x, n x 3 [m], and its triangles, m x 3: copies.")
      .def_prop_ro(
          "time", [](SceneObject& scene) { return scene.state().time; }, "Of the present state [s].")
      .def_prop_ro(
          "frame", [](SceneObject& scene) { return scene.state().frame; }, "Steps made so far.")
      .def_prop_ro("clean", &SceneObject::clean,
                   "Known to be free of intersections. False after positions were written, until the next step.")
      .def_prop_ro(
          "pairs", &SceneObject::pairs,
          "Intersecting pairs of triangles after the last step; -1: not known, as after positions were written.")
      .def_prop_ro("report", &report_of,
                   "What came of the last step, accepted or rejected, by the names of docs/files.md; empty before one.")
      .def_prop_ro("contact_forces", &contact_forces_of,
                   "What contact exerts on each vertex in the present state (docs/files.md#contact-forces), where that "
                   "was asked for: normal and friction, n x 3 [N], and pressure, n [Pa], copies. None: not known, as "
                   "before the first step.")
      .def_prop_ro("fps", &SceneObject::fps, "Frames a second.")
      .def_prop_ro("frames", &SceneObject::frames, "That the scene file asks for; 0 of a scene from arrays.");
  module.def("step", &step_scenes, "scenes"_a,
             "Steps every scene of a list by one frame, a thread a scene, on the threads that there are "
             "(OMP_NUM_THREADS), with the same bits as one by one. Returns what Scene.step returns, a list. Where a "
             "scene raises an error, the others are stepped all the same.");
}

}  // namespace selvedge
