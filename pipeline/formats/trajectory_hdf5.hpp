#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "collision/audit/audit.hpp"
#include "physics/energies/measures.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

using PointsF = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

// What is constant in a trajectory.
struct TrajectoryInfo {
  std::string program_version, config, stepper;
  double fps = 30;
  bool self_audited = true;  // false: the file is labelled "self: not audited"
  std::vector<std::string> cloth_names;
  std::vector<int> cloth_first_vertex, cloth_first_triangle;  // size cloths + 1
  Triangles triangles;                                        // all cloths on end
  Points rest;
  std::vector<RestTriangle> rest_triangle;
  std::vector<int> pins;
  struct Body {
    std::string name;
    Triangles triangles;
    int vertex_count = 0;
    bool moving = false;  // still ones are stored once
  };
  std::vector<Body> obstacles;
};

struct Frame {
  double time = 0;
  PointsF x;
  std::vector<PointsF> obstacles;
  StepReport report;
  int self_pairs = 0, vertex_pairs = 0, obstacle_pairs = 0, inside_vertices = 0,
      nonfinite = 0;  // audit of x as written
  double max_stretch = 1, min_stretch = 1;
  Energies energy;
  double seconds = 0;              // whole frame
  std::vector<int> bad_triangles;  // triangles that intersect something (drawn marked)
};

TrajectoryInfo trajectory_info(const Scene&, const std::string& config, const std::string& stepper, double fps);

// HDF5 in SWMR mode: all datasets are made before the first frame, one flush a frame, so that a file whose writer was
// killed opens and is complete up to its last full frame. Still obstacles are taken from the first frame alone. Throws
// Error when the disk is full or the path cannot be written. Without close() the file is not marked closed.
class TrajectoryWriter {
 public:
  TrajectoryWriter(const std::filesystem::path&, const TrajectoryInfo&);
  ~TrajectoryWriter();
  void append(const Frame&);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Reads also a file that is being written, or whose writer was killed. Throws Error for what is no trajectory.
class TrajectoryReader {
 public:
  explicit TrajectoryReader(const std::filesystem::path&);
  ~TrajectoryReader();
  const TrajectoryInfo& info() const;
  int frame_count() const;  // full frames
  bool closed() const;      // false: still being written, or its writer was killed
  Frame frame(int index) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvedge
