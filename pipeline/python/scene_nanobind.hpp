#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/frame/frame_audits.hpp"
#include "physics/scene/contact_forces.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/python/stepper_nanobind.hpp"
#include "pipeline/scene/cloth_part.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// One thread at a time works on a scene: from the begin of a frame until the scene has taken it over.
class SceneTurn {
 public:
  explicit SceneTurn(std::atomic<bool>& taken);  // throws Error where another has it
  ~SceneTurn() { taken_ = false; }
  SceneTurn(const SceneTurn&) = delete;
  SceneTurn& operator=(const SceneTurn&) = delete;

 private:
  std::atomic<bool>& taken_;
};

// A frame after the present one, before the scene takes it over.
struct SteppedFrame {
  std::unique_ptr<SceneTurn> turn;
  StepReport report;
  State state;  // not to be used if the step was rejected
  Drive drive;
  double seconds = 0;
};

// selvedge.Scene: a scene with its state and stepper, from arrays or from a scene file.
class SceneObject {
 public:
  SceneObject(const nanobind::object& stepper, bool contact_forces);
  SceneObject(const std::filesystem::path& file, const nanobind::object& overrides, const nanobind::dict& kinds);
  SceneObject(const SceneObject&) = delete;
  SceneObject& operator=(const SceneObject&) = delete;

  // Cloths have names of their own, and so have obstacles. Without one they are `cloth`, `cloth_1` and so on.
  int add_cloth_arrays(const nanobind::handle& x, const nanobind::handle& triangles,
                       const std::optional<std::string>& name, std::optional<double> density,
                       std::optional<double> youngs_modulus, std::optional<double> poisson,
                       std::optional<double> bending, const nanobind::object& material, const nanobind::object& pins);
  int add_garment_arrays(const nanobind::handle& x, const nanobind::handle& triangles,
                         const std::optional<std::string>& name, const nanobind::object& on,
                         const nanobind::object& material, const std::string& fit, const nanobind::object& pins,
                         const nanobind::kwargs& keys);
  int add_obstacle_arrays(const nanobind::handle& x, const nanobind::handle& triangles,
                          const std::optional<std::string>& name);
  int add_body_arrays(const nanobind::handle& x, const nanobind::handle& triangles, const nanobind::handle& joints,
                      const nanobind::handle& weights, const nanobind::handle& parents, const nanobind::object& poses,
                      const nanobind::object& translations, double fps, const nanobind::object& joint_names,
                      const std::optional<std::string>& name, const nanobind::object& room,
                      const nanobind::kwargs& keys);
  void move_obstacle(int number, const nanobind::handle& x);

  // The next frame. Changes nothing that others can see; several scenes may do this at once.
  SteppedFrame next_frame(const StopFlag& stop);
  // Takes the frame over, and records it where that was asked for. False where its step was rejected, which leaves
  // everything as it was. HDF5 wants one thread at a time.
  bool keep(SteppedFrame);
  // Both, with Ctrl-C.
  bool step();

  // Every frame from the present one on goes into run.h5 of the folder, until the recording ends. The folder is locked
  // meanwhile, and results of an earlier run in it are removed.
  void record(const std::filesystem::path& folder);
  void end_recording();

  void save(const std::filesystem::path& file);
  void restore(const std::filesystem::path& file);

  const Scene& scene() const { return setup_.scene; }
  State& state();
  // Of the present positions: false and -1 after Python has written to them.
  bool clean();
  int pairs();
  const std::optional<StepReport>& report() const { return report_; }
  // Of the present state; null: not known. Throws Error if they were not asked for.
  const ContactForces* contact_forces();
  double fps() const { return setup_.run.fps; }
  int frames() const { return setup_.run.frames; }
  // Where obstacles are, also before the first step.
  const std::vector<Points>& obstacles() const { return stepper_ ? state_.obstacles : obstacles_; }
  std::string described() const;  // its repr

  // For Python's collector of cycles: all that it holds of Python, and to let go of it. It is no use after that.
  static int traverse(PyObject* self, visitproc visit, void* arg);
  static int clear(PyObject* self);

 private:
  struct Recording {
    std::unique_ptr<FolderLock> lock;
    TrajectoryWriter writer;
    EnergyTerms terms;
  };
  void must_be_open() const;
  void must_rest() const;  // throws Error while a thread works on it
  void begin();            // for who has the turn
  void ensure_begun();     // for who has it not
  Drive drive_of_arrays(double time) const;
  void add_part(ClothPart part);
  std::vector<std::string> names_of_cloths() const;
  std::vector<std::string> names_of_obstacles() const;
  void take_over(State next);
  void notice_writing();

  HeldObjects held_ = std::make_shared<HeldObjects::element_type>();
  Setup setup_;
  MakeStepper make_;  // of a scene from arrays
  // The parts of a scene from arrays. For each obstacle: where it is, or was added; which vertex stands for each
  // (welded_surface.hpp); the body that it is, or null; and its pose, empty for what is no body.
  std::vector<ClothPart> cloths_;
  std::vector<Points> obstacles_;
  std::vector<std::vector<int>> joined_;
  Performances bodies_;
  std::vector<std::function<BodyFrame(double time)>> body_frames_;
  std::function<Points(double time)> skinned_targets_;  // empty: nothing is worn
  State state_;
  std::unique_ptr<Stepper> stepper_;
  FrameAudits audits_{setup_.scene};
  std::optional<StepReport> report_;  // of the last step
  std::shared_ptr<const ContactForces> contact_forces_;
  int pairs_ = -1;
  Points judged_;  // the positions that `clean` and pairs_ are of [m]
  std::unique_ptr<Recording> recording_;
  std::atomic<bool> turn_ = false;  // taken
};

}  // namespace selvedge
