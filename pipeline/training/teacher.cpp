#include "pipeline/training/teacher.hpp"

#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "physics/steppers/decorated_stepper.hpp"

namespace selvedge {
namespace {

ConventionalOptions options_of(TeacherQuality quality) {
  ConventionalOptions options;
  if (quality == TeacherQuality::standard) return options;
  options.substeps = 1;
  options.implicit_euler.velocity_tolerance = options.implicit_euler.relative_tolerance = 1e-4;
  options.implicit_euler.max_newton = 60;
  options.implicit_euler.linear_tolerance = 0.05;
  return options;
}

// What is wanted of the frame. Makes the solver before the first frame of a roll-out.
TeacherStep taught_step(RollSolver& solver, const SolverFrame& frame, const TeacherOptions& options,
                        const TeacherWork& work) {
  restore_standard_arithmetic();
  const Scene& scene = solver.scene->scene;
  TeacherStep taught;
  if (work.targets) {
    if (!solver.stepper) solver.stepper = make_teacher_stepper(scene, options);
    State to;
    const StepReport report = solver.stepper->step(frame.from, frame.drive, frame.dt, to);
    if (report.status != StepStatus::accepted) return {{}, nullptr, "the solver rejected its step"};
    taught.x = std::move(to.x);
  }
  if (work.potential) {
    if (!solver.potential) solver.potential = std::make_unique<FramePotential>(scene, options_of(options.quality));
    if (!solver.potential->begin(frame.from, frame.drive, frame.dt))
      return {{}, nullptr, "the solver has no potential for its step"};
    taught.potential = solver.potential.get();
  }
  return taught;
}

}  // namespace

std::unique_ptr<Stepper> make_teacher_stepper(const Scene& scene, const TeacherOptions& options) {
  return make_recovering_conventional_stepper(scene, options_of(options.quality));
}

Teacher::Teacher(const TeacherOptions& options, const TeacherWork& work)
    : options_(options), work_(work), thread_([this] { run(); }) {}

Teacher::~Teacher() {
  {
    const std::lock_guard hold(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Teacher::ask(RollingState& state) {
  if (state.taught.valid()) return;
  if (!state.solver) state.solver = std::make_shared<RollSolver>(RollSolver{state.roll.scene, nullptr, nullptr});
  std::packaged_task<TeacherStep()> task([this, solver = state.solver, frame = solver_frame(state)] {
    return taught_step(*solver, frame, options_, work_);
  });
  state.taught = task.get_future().share();
  {
    const std::lock_guard hold(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_all();
}

const TeacherStep& Teacher::wait(const RollingState& state) {
  Stopwatch watch;
  const TeacherStep& taught = state.taught.get();
  const std::lock_guard hold(mutex_);
  tally_.waited += watch.lap();
  return taught;
}

TeacherTally Teacher::tally() const {
  const std::lock_guard hold(mutex_);
  return tally_;
}

void Teacher::run() {
  restore_standard_arithmetic();
  use_threads(1);  // the other threads train
  std::unique_lock hold(mutex_);
  while (true) {
    changed_.wait(hold, [this] { return ends_ || !tasks_.empty(); });
    if (ends_) return;
    std::packaged_task<TeacherStep()> task = std::move(tasks_.front());
    tasks_.pop_front();
    hold.unlock();
    Stopwatch watch;
    task();
    hold.lock();
    ++tally_.targets;
    tally_.seconds += watch.lap();
  }
}

}  // namespace selvedge
