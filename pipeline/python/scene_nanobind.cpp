#include "pipeline/python/scene_nanobind.hpp"

#include <nanobind/stl/string.h>

#include <fmt/format.h>

#include <algorithm>
#include <ranges>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "physics/frame/make_frame.hpp"
#include "physics/scene/make_scene.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/python/arrays_nanobind.hpp"
#include "pipeline/python/overrides_nanobind.hpp"
#include "pipeline/python/python_stop_nanobind.hpp"
#include "pipeline/run/memory_forms.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/record_frame.hpp"
#include "pipeline/run/run_folder.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/scene/massless.hpp"
#include "pipeline/scene/setup_start.hpp"

namespace selvedge {

namespace nb = nanobind;

namespace {

// The start of a setup, which may take long. Throws what Ctrl-C raises.
State prepared(const Setup& setup) {
  PythonStop stop;
  const StopFlag flag = [&] { return stop.asked(); };
  std::optional<Start> start;
  {
    const nb::gil_scoped_acquire lock;  // the caller may have released it
    const nb::gil_scoped_release unlocked;
    start = prepare(setup, flag, nullptr, flag);
  }
  const nb::gil_scoped_acquire lock;
  stop.raise_kept();
  return std::move(start->state);
}

// A member of every cloth, one below the other.
Points stacked(const std::vector<ClothPart>& parts, Points ClothPart::*rows) {
  Eigen::Index count = 0, first = 0;
  for (const ClothPart& part : parts) count += (part.*rows).rows();
  Points all(count, 3);
  for (const ClothPart& part : parts) {
    all.middleRows(first, (part.*rows).rows()) = part.*rows;
    first += (part.*rows).rows();
  }
  return all;
}

ConventionalOptions options_with(bool contact_forces) {
  ConventionalOptions options;
  options.contact_forces = contact_forces;
  return options;
}

}  // namespace

SceneTurn::SceneTurn(std::atomic<bool>& taken) : taken_(taken) {
  if (taken.exchange(true)) throw Error("is being stepped", "scene", "let one thread at a time work on a scene");
}

SceneObject::SceneObject(const nb::object& stepper, bool contact_forces)
    : make_(stepper.is_none() ? conventional_maker(options_with(contact_forces))
                              : python_maker("python", stepper, held_)) {
  if (contact_forces && !stepper.is_none())
    throw Error("contact forces are not known of steps that Python makes", "scene: contact_forces",
                "leave it out, or leave the stepper out");
  setup_.run.fps = 30;
}

SceneObject::SceneObject(const std::filesystem::path& file, const nb::object& overrides, const nb::dict& kinds)
    : setup_(read_setup(file, overrides_of(overrides), kinds_with(kinds, held_))) {
  warn(scene_warnings(setup_));
  state_ = prepared(setup_);
  judged_ = state_.x;
  stepper_ = make_stepper(setup_);
}

SteppedFrame SceneObject::next_frame(const StopFlag& stop) {
  auto turn = std::make_unique<SceneTurn>(turn_);
  begin();
  check_state(setup_.scene, state_);  // whose arrays Python may have written to
  notice_writing();
  const Clock::time_point started = Clock::now();
  const double dt = 1 / setup_.run.fps;
  SteppedFrame made;
  made.turn = std::move(turn);
  made.drive = setup_.drive_at(state_.time + dt);
  StepExtras extras;
  extras.stop = stop;
  made.report = make_frame(*stepper_, audits_, state_, made.drive, dt, made.state, extras);
  made.seconds = seconds_since(started);
  return made;
}

bool SceneObject::keep(SteppedFrame made) {
  report_ = std::move(made.report);
  const bool accepted = report_->status == StepStatus::accepted;
  if (accepted) {
    take_over(std::move(made.state));
    contact_forces_ = report_->contact_forces;
    pairs_ = report_->collision.pairs_after;
  }
  if (recording_)
    recording_->writer.append(
        record_frame(setup_.scene, recording_->terms, {state_, made.drive, *report_, made.seconds}));
  return accepted;
}

bool SceneObject::step() {
  PythonStop stop;
  std::optional<SteppedFrame> made;
  {
    const nb::gil_scoped_release unlocked;
    made = next_frame([&] { return stop.asked(); });
  }
  stop.raise_kept();
  return keep(*std::move(made));
}

void SceneObject::record(const std::filesystem::path& folder) {
  if (recording_) throw Error("is recorded already", "scene", "end that recording first");
  ensure_begun();
  make_folder(folder);
  auto lock = std::make_unique<FolderLock>(folder);
  remove_results(folder);
  TrajectoryInfo info = trajectory_info(setup_.scene, setup_.config, stepper_->traits().name, setup_.run.fps);
  info.contact_forces = stepper_->traits().reports_contact_forces;
  recording_.reset(new Recording{std::move(lock), TrajectoryWriter(folder / "run.h5", std::move(info)),
                                 energy_terms(setup_.scene, stepper_->traits())});
  notice_writing();
  recording_->writer.append(record_initial(setup_.scene, recording_->terms, state_, setup_.drive_at(state_.time)));
}

void SceneObject::end_recording() {
  if (recording_) recording_->writer.close();
  recording_.reset();
}

void SceneObject::save(const std::filesystem::path& file) {
  ensure_begun();
  check_state(setup_.scene, state_);
  notice_writing();
  write_checkpoint(file, state_, run_inputs(setup_));
}

void SceneObject::restore(const std::filesystem::path& file) {
  must_rest();
  ensure_begun();
  if (!std::filesystem::exists(file)) throw Error("is not there", file.string(), "name a file that `save` wrote");
  Checkpoint saved;
  try {
    saved = read_checkpoint(file);
    check_fits(file, saved.state, setup_.scene);
  } catch (const Error& error) {
    throw Error(error.problem(), error.where(), "restore a state that `save` wrote of this scene");
  }
  if (const auto problem = misfit(saved.state.memory, setup_.scene))
    throw Error(*problem, file.string(), "restore it into the scene that it was saved of");
  // Obstacles of a scene from arrays may have been moved, so that its hash is not the same.
  if (!setup_.file.empty() && hash_of_inputs(saved.inputs) != hash_of_inputs(run_inputs(setup_)))
    throw Error("is of another scene, or of this one with other files or overrides", file.string(),
                "restore it into the scene that it was saved of");
  if (setup_.file.empty()) obstacles_ = saved.state.obstacles;
  take_over(std::move(saved.state));
  report_.reset();
  contact_forces_.reset();
  pairs_ = -1;
}

State& SceneObject::state() {
  ensure_begun();
  return state_;
}

bool SceneObject::clean() {
  ensure_begun();
  if (!turn_) notice_writing();
  return state_.clean;
}

int SceneObject::pairs() {
  if (stepper_ && !turn_) notice_writing();
  return pairs_;
}

const ContactForces* SceneObject::contact_forces() {
  ensure_begun();
  if (!stepper_->traits().reports_contact_forces)
    throw Error("contact forces were not asked for, or its stepper computes none", "scene: contact_forces",
                "make it with contact_forces=True, or with run.contact_forces=true");
  return contact_forces_.get();
}

std::string SceneObject::described() const {
  const Scene& scene = setup_.scene;
  Eigen::Index corners = 0;
  for (const Obstacle& obstacle : scene.obstacles) corners += obstacle.surface.vertex_count;
  const auto vertices = [](Eigen::Index n) { return counted(n, "vertex", "vertices"); };
  return fmt::format("<selvedge.Scene: {} of {}, {}; {} of {}; frame {}, {:g} s>",
                     counted(std::ssize(scene.cloths), "cloth"), vertices(scene.surface.vertex_count),
                     counted(scene.surface.triangles.rows(), "triangle"),
                     counted(std::ssize(scene.obstacles), "obstacle"), vertices(corners), state_.frame, state_.time);
}

int SceneObject::traverse(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  for (const auto& one : *nb::inst_ptr<SceneObject>(self)->held_)
    if (const auto object = one.lock()) Py_VISIT(object->ptr());
  return 0;
}

int SceneObject::clear(PyObject* self) {
  SceneObject& scene = *nb::inst_ptr<SceneObject>(self);
  scene.stepper_.reset();
  scene.make_ = {};
  scene.setup_.kind = {};
  return 0;
}

void SceneObject::must_rest() const {
  if (turn_) throw Error("is being stepped", "scene", "let one thread at a time work on a scene");
}

void SceneObject::ensure_begun() {
  if (stepper_) return;
  const SceneTurn turn(turn_);
  begin();
}

void SceneObject::must_be_open() const {
  must_rest();
  if (stepper_) throw Error("has been stepped", "scene", "add cloths and obstacles before the first step");
}

void SceneObject::begin() {
  if (stepper_) return;
  if (cloths_.empty()) throw Error("has no cloth", "scene", "add one");
  for (const auto& who : bodies_) {
    const auto worn = [&](const ClothPart& part) { return part.worn && part.worn->by == who; };
    if (who) wear(static_cast<int>(std::ranges::count_if(cloths_, worn)), *who);
  }
  const int frames = begin_draped(bodies_, setup_.run.fps, cloths_);
  const double time = -frames / setup_.run.fps;
  for (std::size_t k = 0; k < obstacles_.size(); ++k)
    if (bodies_[k]) obstacles_[k] = body_at(*bodies_[k], time);
  skinned_targets_ = skinned_targets_of(cloths_, setup_.scene);
  setup_.drive_at = [this](double at) { return drive_of_arrays(at); };
  state_ = first_state(setup_.scene, stacked(cloths_, &ClothPart::first), obstacles_);
  state_.frame = -frames;
  state_.time = time;
  state_.v = stacked(cloths_, &ClothPart::velocity);
  state_.x(setup_.scene.pins, Eigen::all) = setup_.drive_at(time).pins;
  for (const int pin : setup_.scene.pins) state_.v.row(pin).setZero();
  begin_cut(cloths_, setup_.scene, state_);
  setup_.velocity = state_.v;
  if (frames > 0) state_.v.setZero();
  setup_.initial = state_;
  setup_.followers = followers_of(cloths_, setup_.scene);
  if (frames > 0) state_ = prepared(setup_);
  judged_ = state_.x;
  stepper_ =
      make_following_stepper(setup_.scene, setup_.followers,
                             decorated(setup_.scene, make_, {.cut = std::ranges::any_of(cloths_, &ClothPart::cut)}));
  try {
    check_accepted(setup_, stepper_->traits());
  } catch (...) {
    stepper_.reset();
    throw;
  }
}

Drive SceneObject::drive_of_arrays(double time) const {
  Drive drive = at_rest(setup_.scene, state_);
  drive.obstacles = obstacles_;
  const std::vector<int>& pins = setup_.scene.pins;
  for (std::size_t c = 0; c < cloths_.size(); ++c)
    for (const PinPart& part : cloths_[c].pins | std::views::reverse) {  // the first that names a vertex keeps it
      const Points at = part.at(time);
      for (std::size_t k = 0; k < part.vertices.size(); ++k) {
        const int vertex = setup_.scene.cloths[c].first_vertex + part.vertices[k];
        drive.pins.row(std::ranges::lower_bound(pins, vertex) - pins.begin()) = at.row(static_cast<Eigen::Index>(k));
      }
    }
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (!bodies_[k]) continue;
    drive.obstacles[k] = body_at(*bodies_[k], time);
    drive.bodies.resize(bodies_.size());
    drive.bodies[k] = body_frames_[k](time);
  }
  if (skinned_targets_) drive.skinned_targets = skinned_targets_(time);
  return drive;
}

// Writes into the existing arrays, so that views of them stay valid.
void SceneObject::take_over(State next) {
  Points x = std::move(state_.x), v = std::move(state_.v);
  std::vector<Points> obstacles = std::move(state_.obstacles);
  x = next.x;
  v = next.v;
  for (std::size_t k = 0; k < obstacles.size(); ++k) obstacles[k] = next.obstacles[k];
  state_ = std::move(next);
  state_.x.swap(x);
  state_.v.swap(v);
  state_.obstacles.swap(obstacles);
  judged_ = state_.x;
}

void SceneObject::notice_writing() {
  if (state_.x == judged_) return;
  state_.clean = false;
  pairs_ = -1;
  judged_ = state_.x;
}

}  // namespace selvedge
