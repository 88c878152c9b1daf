#include "pipeline/python/stepper_nanobind.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "physics/scene/joint_lists.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "physics/steppers/finish_step.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/python/arrays_nanobind.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

// A Python object that C++ copies and drops without Python's lock.
using Kept = std::shared_ptr<nb::object>;

Kept kept(nb::object object, const HeldObjects& held) {
  Kept made{new nb::object(std::move(object)), [](nb::object* last) {
              const nb::gil_scoped_acquire lock;
              delete last;
            }};
  std::erase_if(*held, [](const auto& one) { return one.expired(); });
  held->push_back(made);
  return made;
}

nb::object steppers_module() { return nb::module_::import_("selvedge.steppers"); }

nb::list copies_of(const std::vector<Points>& all) {
  nb::list list;
  for (const Points& x : all) list.append(copy_of(x));
  return list;
}

nb::object described(const Scene& scene) {
  nb::list obstacles;
  for (const Obstacle& obstacle : scene.obstacles) obstacles.append(copy_of(obstacle.surface.triangles));
  nb::list cloths;
  for (const Cloth& cloth : scene.cloths)
    cloths.append(nb::make_tuple(cloth.name, cloth.first_vertex, cloth.first_vertex + cloth.vertex_count));
  return steppers_module().attr("SceneArrays")(
      "rest"_a = copy_of(scene.rest), "triangles"_a = copy_of(scene.surface.triangles),
      "masses"_a = copy_of(lumped_masses(scene)), "pins"_a = copy_of(scene.pins), "obstacles"_a = obstacles,
      "cloths"_a = cloths);
}

nb::object described(const State& from) {
  return steppers_module().attr("StepStart")("time"_a = from.time, "frame"_a = from.frame, "x"_a = copy_of(from.x),
                                             "v"_a = copy_of(from.v), "obstacles"_a = copies_of(from.obstacles));
}

nb::object described(const Drive& drive) {
  const auto three = [](const Vec3& v) { return std::vector<double>{v[0], v[1], v[2]}; };
  return steppers_module().attr("StepDrive")(
      "pins"_a = copy_of(drive.pins), "obstacles"_a = copies_of(drive.obstacles), "wind"_a = three(drive.wind),
      "acceleration"_a = three(drive.acceleration),
      "worn"_a = drive.skinned_targets.rows() > 0 ? copy_of(drive.skinned_targets) : nb::object(nb::none()));
}

// Forces by the names that StepperTraits::ignores has.
std::vector<std::string> ignored_by(const std::string& kind, const nb::object& stepper) {
  std::vector<std::string> known{"membrane",          "bending (curvature)", "bending (hinge)",
                                 "stiffness damping", "mass damping",        "wind"};
  for_each_joint_list([&](auto, const JointKind& joints) { known.emplace_back(joints.name); });
  const nb::object given = stepper.attr("ignores");
  if (!nb::isinstance<nb::tuple>(given) && !nb::isinstance<nb::list>(given))
    throw Error("is no tuple", "stepper `" + kind + "`, ignores", "give a tuple of: " + joined(known));
  std::vector<std::string> names;
  for (const nb::handle item : given) {
    names.push_back(nb::cast<std::string>(nb::str(item)));
    if (std::ranges::find(known, names.back()) == known.end())
      throw Error("`" + names.back() + "` is no force that a stepper may lack", "stepper `" + kind + "`, ignores",
                  "known: " + joined(known));
  }
  return names;
}

StepperTraits traits_of(const std::string& kind, const nb::object& stepper) {
  const auto yes = [&](const char* name) { return nb::cast<bool>(nb::bool_(stepper.attr(name))); };
  StepperTraits traits{.name = kind,
                       .needs = {.skinned_targets = yes("needs_worn"), .obstacles = yes("needs_obstacles")}};
  traits.may_leave_out_cloths = yes("may_leave_out_cloths");
  traits.ignores = ignored_by(kind, stepper);
  return traits;
}

class PythonStepper final : public Stepper {
 public:
  PythonStepper(const std::string& kind, const Kept& type, const Scene& scene, const HeldObjects& held)
      : scene_(scene) {
    stepper_ = kept((*type)(described(scene)), held);
    traits_ = traits_of(kind, *stepper_);
  }
  const StepperTraits& traits() const override { return traits_; }

  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override {
    StepReport report;
    report.by = traits_.name;
    report.substeps = 1;
    report.status = StepStatus::rejected;
    StepEnd end{from.x, from.v, drive.obstacles};
    report.reason = ask(from, drive, dt, end);
    if (report.reason == Reason::none) finish_step(from, drive, dt, std::move(end), to, report);
    return report;
  }

 private:
  // What the method `step` returns: nothing, positions, or these and velocities.
  Reason ask(const State& from, const Drive& drive, double dt, StepEnd& end) const {
    const nb::gil_scoped_acquire lock;
    const nb::object made = stepper_->attr("step")(described(from), described(drive), dt);
    if (made.is_none()) return Reason::not_converged;
    const bool both = nb::isinstance<nb::tuple>(made);
    if (both && nb::len(made) != 2) throw Error("returns no pair", where("step"), "return x, or (x, v)");
    end.x = rows_of(both ? nb::object(made[0]) : made, "x");
    for (std::size_t p = 0; p < scene_.pins.size(); ++p)
      end.x.row(scene_.pins[p]) = drive.pins.row(static_cast<Eigen::Index>(p));
    end.v = both ? rows_of(made[1], "v") : Points((end.x - from.x) / dt);
    const auto allowed = [](const Points& rows) { return (rows.array().abs() <= limits::farthest).all(); };
    return allowed(end.x) && allowed(end.v) ? Reason::none : Reason::not_finite;
  }

  Points rows_of(const nb::object& array, const std::string& name) const {
    Points rows = points_of(array, where(name), NotFinite::allowed);
    if (rows.rows() != scene_.surface.vertex_count)
      throw Error("has " + std::to_string(rows.rows()) + " rows", where(name),
                  "return one a vertex, " + std::to_string(scene_.surface.vertex_count));
    return rows;
  }

  std::string where(const std::string& name) const { return "stepper `" + traits_.name + "`, " + name; }

  const Scene& scene_;
  Kept stepper_;
  StepperTraits traits_;
};

}  // namespace

MakeStepper python_maker(const std::string& kind, const nb::handle& type, const HeldObjects& held) {
  const nb::object base = steppers_module().attr("Stepper");
  if (!PyType_Check(type.ptr()) || PyObject_IsSubclass(type.ptr(), base.ptr()) != 1)
    throw Error("is no subclass of selvedge.Stepper", "stepper `" + kind + "`",
                "give the class itself, neither an instance nor a name; scene files name the program's own steppers");
  return [kind, type = kept(nb::borrow(type), held), held](const Scene& scene) -> std::unique_ptr<Stepper> {
    const nb::gil_scoped_acquire lock;
    return std::make_unique<PythonStepper>(kind, type, scene, held);
  };
}

Kinds kinds_with(const nb::dict& types, const HeldObjects& held) {
  Kinds kinds = known_kinds();
  for (const auto& [key, type] : types) {
    if (!nb::isinstance<nb::str>(key))
      throw Error(std::string("has the name ") + nb::repr(key).c_str(), "kinds", "name each class by a text");
    const std::string name = nb::cast<std::string>(key);
    kinds.add({.name = name,
               .maker = [maker = python_maker(name, type, held)](const Setup&, const Config&) { return maker; }});
  }
  return kinds;
}

}  // namespace selvedge
