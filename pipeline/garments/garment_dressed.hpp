#pragma once

#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"
#include "pipeline/garments/garment.hpp"

namespace selvedge {

// How a body wears a mesh.
struct Dressing {
  Eigen::VectorXd shape;          // of the body
  BodyPose pose;                  // of it; no rows: the zero pose
  Fit fit = Fit::loose;           // how the mesh takes weights and directions from the body
  std::vector<std::string> pins;  // groups that stay with the body, or `none`; empty: waists of what would fall
};

// A garment of a mesh that lies where the body wears it [m]: weights and directions from the surface of the body as it
// is there, groups of the mesh and of its boundaries, pins. Throws Error for pins that are no group of it.
struct DressedMesh {
  Garment garment;
  std::vector<std::string> pinned;  // groups
};
DressedMesh dressed(const Mesh&, const BodyModel&, const Dressing&);

}  // namespace selvedge
