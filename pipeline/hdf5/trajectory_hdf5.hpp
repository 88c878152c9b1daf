#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "physics/scene/scene.hpp"
#include "pipeline/hdf5/trajectory.hpp"

namespace selvedge {

TrajectoryInfo trajectory_info(const Scene&, const std::string& config, const std::string& stepper, double fps);

// HDF5 in SWMR mode: all datasets are made before the first frame, and each frame is flushed. So a file whose writer
// was killed opens and is complete up to its last full frame. Still obstacles are stored once, as long as they stay
// where the first frame has them. Throws Error if the disk is full or the path cannot be written. Without close() the
// file is not marked closed.
class TrajectoryWriter {
 public:
  TrajectoryWriter(const std::filesystem::path&, TrajectoryInfo);
  ~TrajectoryWriter();
  void append(const Frame&);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The trajectory of a run: the file itself, or that in the run's folder.
std::filesystem::path trajectory_file(const std::filesystem::path& file_or_folder);

// Also reads a file that is being written, or whose writer was killed. Throws Error for a file that is no trajectory.
class TrajectoryReader {
 public:
  explicit TrajectoryReader(const std::filesystem::path&);
  ~TrajectoryReader();
  const TrajectoryInfo& info() const;
  std::vector<Look> looks() const;  // of each cloth, empty ones where the file has none; read when asked for
  int frame_count() const;          // full frames
  bool closed() const;              // false: still being written, or its writer was killed
  Frame frame(int index) const;
  double time(int index) const;  // of a frame, without reading the rest of it [s]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvedge
