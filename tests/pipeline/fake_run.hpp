#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "physics/scene/make_scene.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/run/run_scene.hpp"

namespace selvedge::fake {

// A separate folder, which is removed at the end of the test.
struct Folder {
  std::filesystem::path path;
  explicit Folder(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("selvedge_" + name + "_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

// A square of side 1 in the plane y = 0 with n x n vertices.
inline Points grid_points(int n) {
  Points x(n * n, 3);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) x.row(i * n + j) << double(j) / (n - 1), 0, double(i) / (n - 1);
  return x;
}

inline Triangles grid_triangles(int n) {
  Triangles triangles(2 * (n - 1) * (n - 1), 3);
  int t = 0;
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int a = i * n + j, b = a + 1, c = a + n, d = c + 1;
      triangles.row(t++) << a, c, b;
      triangles.row(t++) << b, c, d;
    }
  return triangles;
}

// One cloth above a tetrahedron at rest and beside a moving one.
inline Scene scene(int n = 5) {
  Scene scene;
  add_cloth(scene, grid_points(n), grid_triangles(n), {}, "sheet");
  Triangles tetrahedron(4, 3);
  tetrahedron << 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2;
  add_obstacle(scene, 4, tetrahedron, false, "still");
  add_obstacle(scene, 4, tetrahedron, true, "mover");
  return scene;
}

inline Points tetrahedron_points(double x, double y) {
  Points points(4, 3);
  points << 0, 0, 0, 0.1, 0, 0, 0, 0, 0.1, 0, 0.1, 0;
  points.rowwise() += Eigen::RowVector3d(x, y, 0);
  return points;
}

inline Frame frame(const Scene& scene, int index) {
  Frame frame;
  frame.time = index / 30.0;
  frame.x = scene.rest.cast<float>();
  frame.x.col(1).array() -= 0.01f * static_cast<float>(index);
  frame.obstacles = {tetrahedron_points(0, -5).cast<float>(), tetrahedron_points(3, 0.1 * index).cast<float>()};
  frame.report.status = StepStatus::accepted;
  frame.report.by = index % 2 ? "odd" : "even";
  frame.report.iterations = index;
  frame.report.doubts = {index % 2 == 1, index % 3 == 2, index % 5 == 3};
  frame.report.residual = 0.5 * index;
  frame.report.seconds = {1, 2, 3, 4, 5.0 + index};
  frame.report.collision.contacts = 7 * index;
  frame.report.collision.pushed_out = index % 4;
  frame.report.untangling = 3 * index;
  frame.report.out_of_newton = index % 2 == 1;
  frame.report.out_of_untangling = index % 3 == 1;
  frame.report.out_of_response = index % 5 == 1;
  frame.report.out_of_proofs = index % 7 == 2;
  frame.report.unsolved = 1e-6 * index;
  if (index % 3 > 0) frame.report.switched_off = {index % 2, index};
  frame.self_pairs = index;
  frame.max_stretch = 1 + 0.1 * index;
  frame.energy = {1.0 * index, 2, 3, 4, 5};
  for (int k = 0; k < index % 3; ++k) frame.bad_triangles.push_back(k + index % 2);
  return frame;
}

// Moves every vertex down by v dt; from frame `fails_at` on every step is rejected.
class FallingStepper : public Stepper {
 public:
  explicit FallingStepper(int fails_at = 1 << 30) : fails_at_(fails_at) {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override {
    StepReport report;
    report.by = "falling";
    report.iterations = 1;
    to = from;
    to.frame = from.frame + 1;
    to.time = from.time + dt;
    to.v = from.v.rowwise() + dt * drive.acceleration.transpose();
    to.x = from.x + dt * to.v;
    to.obstacles = drive.obstacles;
    report.status = to.frame < fails_at_ ? StepStatus::accepted : StepStatus::rejected;
    report.reason = to.frame < fails_at_ ? Reason::none : Reason::not_converged;
    if (report.status == StepStatus::rejected) to.x.setConstant(std::numeric_limits<double>::quiet_NaN());
    return report;
  }

 private:
  int fails_at_;
  StepperTraits traits_{"falling"};
};

inline Setup setup(int frames = 12) {
  Setup setup;
  setup.file = "fake.yaml";
  setup.config = "run: {frames: " + std::to_string(frames) + "}\n";
  setup.scene = scene();
  setup.run.frames = frames;
  setup.initial.x = setup.scene.rest;
  setup.initial.v = Points::Zero(setup.scene.rest.rows(), 3);
  setup.initial.obstacles = {tetrahedron_points(0, -50), tetrahedron_points(3, 0)};
  setup.drive_at = [](double time) {
    Drive drive;
    drive.acceleration = {0, -9.81, 0};
    drive.obstacles = {tetrahedron_points(0, -50), tetrahedron_points(3, time)};
    return drive;
  };
  return setup;
}

// Runs a scene into a folder, or continues it, and is interrupted after `stop_after` frames.
inline RunSummary run(const Setup& setup, Stepper& stepper, const std::filesystem::path& out, bool resume = false,
                      int stop_after = 1 << 30) {
  RunRequest request;
  request.out = out;
  int seen = 0;
  request.stop = [&] { return ++seen >= stop_after; };
  return resume ? resume_scene(setup, stepper, request) : run_scene(setup, *prepare(setup), stepper, request);
}

}  // namespace selvedge::fake
