#pragma once

#include <string>
#include <utility>
#include <vector>

#include "physics/scene/scene.hpp"
#include "pipeline/bodies/body.hpp"
#include "pipeline/formats/look.hpp"

namespace selvedge {

// A spring that joins two vertices of a garment, such as one of a pocket and one of the front behind it.
struct Stitch {
  int a = 0, b = 0;
  double rest_length = 0;  // [m]
  bool operator==(const Stitch&) const = default;
};

// A garment on the body for which it was made.
struct Garment {
  std::string name;
  SkinnedSurface skin;  // as worn in the body's zero pose and shape, with the directions that it takes from the body
  BodyPose made_in;     // the pose in which it has its rest shape; no rows: the zero pose
  std::vector<std::pair<std::string, std::vector<int>>> groups;  // by name, vertices ascending
  std::vector<int> pins;                                         // vertices that stay with the body, ascending
  std::string made_for = {};                                     // the body's name; empty: not known
  std::vector<Stitch> stitches = {};
  std::vector<RestTriangle> flat = {};  // rest shapes of triangles, as cut from panels; empty: the flattened rest shape
  Look look = {};                       // of the mesh that it was made of
};

// How a garment vertex takes weights and directions from the body. tight: from the nearest vertex. loose: averaged over
// all vertices about as near as that one (Gaussian, as wide as the distance from the body). ContourCraft (Grigorev et
// al. 2024) uses the same two, the loose one with random samples.
enum class Fit { tight, loose };

// A skinned surface from positions x worn in the body's zero pose and shape, with weights and directions from the body.
// Throws Error if it has no vertices.
SkinnedSurface attached(const Points& x, const Triangles&, const BodyModel&, Fit);

// The weights with which each vertex, worn in the body's zero pose, follows motions of the body's vertices: of those
// about as near as the nearest (Gaussian, `width` [m] wide). Rows sum to 1.
SkinWeights shares_of_body(const Points& x, const BodyModel&, double width);

// The garment on the body in a shape and pose [m]. It is only skinned, so that it may be tangled.
Points skinned(const Garment&, const BodyModel&, const Eigen::VectorXd& shape, const BodyPose&);

// Its rest shape for a body of that shape: as made, resized by the shape directions [m].
Points rest_shape(const Garment&, const BodyModel&, const Eigen::VectorXd& shape);

// Throws Error, naming `file` and the field, unless sizes match, indices are in range and ascend, all numbers are
// finite, weights sum to 1 and stitches join different vertices. For readers and makers of garments.
void check_garment(const Garment&, const std::string& file);

}  // namespace selvedge
