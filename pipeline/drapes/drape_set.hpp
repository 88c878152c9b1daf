#pragma once

#include <map>
#include <memory>

#include "collision/geometry/surface.hpp"
#include "learned/repulsion/drape_network.hpp"
#include "pipeline/drapes/drape_draws.hpp"
#include "pipeline/drapes/drape_options.hpp"

namespace selvedge {

// A path of drapes of one shape and one style.
struct DrapePath {
  Eigen::VectorXd shape;
  Style style{};
  std::vector<Points> rotations;       // of each drape's pose
  std::vector<Points> x;               // where the garment came to rest, n x 3 [m]
  std::map<std::string, int> dropped;  // drapes that were left out, by reason
  int poses_redrawn = 0;               // because the body passed through itself there
  double seconds = 0;
};

// What paths are made of.
struct DrapeWorld {
  DrapeOptions options;
  BodyModel body;
  Surface body_surface;
  Garment garment;
  Surface surface;
};
DrapeWorld make_drape_world(const DrapeOptions&);

// Garment in zero pose on the body of that shape, with the style.
Points styled_rest(const DrapeWorld&, const Eigen::VectorXd& shape, const Style&);
// Affine maps of the garment's vertices from the zero pose into the pose.
std::vector<VertexFrame> vertex_frames(const DrapeWorld&, const Eigen::VectorXd& shape, const BodyPose&);

// One drape as networks read it: pose (three a joint), shape (ten) and style (four), garment space and truth, and the
// body that it lies on.
struct DrapeSample {
  DrapeCase drape;
  Points body;
  JointTransforms transforms;  // of the body's joints
};
DrapeSample drape_sample(const DrapeWorld&, const DrapePath&, std::size_t index);

}  // namespace selvedge
