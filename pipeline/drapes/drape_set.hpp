#pragma once

#include <filesystem>
#include <map>

#include "collision/geometry/surface.hpp"
#include "learned/repulsion/drape_network.hpp"
#include "pipeline/drapes/drape_draws.hpp"
#include "pipeline/drapes/drape_options.hpp"

namespace selvedge {

// A path of drapes with one shape and one style.
struct DrapePath {
  Eigen::VectorXd shape;
  Style style{};
  std::vector<Points> rotations;       // of the pose of each drape
  std::vector<Points> x;               // positions of the garment at rest, n x 3 [m]
  std::map<std::string, int> dropped;  // number of drapes left out, by reason
  int poses_redrawn = 0;               // number of poses in which the body intersects itself
  double seconds = 0;
};

// The body and the garment of all paths.
struct DrapeWorld {
  DrapeOptions options;
  BodyModel body;
  Surface body_surface;
  Garment garment;
  Surface surface;
};
DrapeWorld make_drape_world(const DrapeOptions&);

// The garment in the zero pose on the body of that shape, with the style.
Points styled_rest(const DrapeWorld&, const Eigen::VectorXd& shape, const Style&);
// Affine maps of the garment's vertices from the zero pose into the pose.
std::vector<VertexFrame> vertex_frames(const DrapeWorld&, const Eigen::VectorXd& shape, const BodyPose&);

// One drape as networks read it: pose (three per joint), shape (ten), style (four), garment space and truth. Also the
// body under it.
struct DrapeSample {
  DrapeCase drape;
  Points body;
  JointTransforms transforms;  // of the body's joints
};
DrapeSample drape_sample(const DrapeWorld&, const DrapePath&, std::size_t index);

// Paths in our HDF5 form (docs/repulsion.md): shape, style, rotations (drape by drape, one row per joint), positions,
// and counts of dropped drapes. A new file is written and renamed. Both throw Error.
void write_drape_path(const std::filesystem::path&, const DrapePath&);
DrapePath read_drape_path(const std::filesystem::path&, int joints, int vertices);

// The drapes of a folder that make_dataset filled.
struct DrapeSet {
  DrapeWorld world;
  std::vector<DrapePath> training, test;
};
std::filesystem::path drape_path_file(const std::filesystem::path& folder, int number);
DrapeSet read_drape_set(const std::filesystem::path& folder);

}  // namespace selvedge
