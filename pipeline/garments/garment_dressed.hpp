#pragma once

#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"
#include "pipeline/garments/garment.hpp"

namespace selvedge {

// How to make a garment from a mesh on a body.
struct Dressing {
  Eigen::VectorXd shape;          // of the body
  BodyPose pose;                  // of it; no rows: the zero pose
  Fit fit = Fit::loose;           // how the mesh takes weights and directions from the body
  std::vector<std::string> pins;  // groups that stay with the body, or `none`; empty: waists of pieces that would fall
};

// A garment from a mesh in the place where the body wears it [m]. Weights and directions come from the posed body's
// surface, groups from the mesh and its boundaries. Throws Error for pins that are not a group of it.
struct DressedMesh {
  Garment garment;
  std::vector<std::string> pinned;  // groups
};
DressedMesh dressed(const Mesh&, const BodyModel&, const Dressing&);

}  // namespace selvedge
