#pragma once

#include <string>
#include <utility>
#include <vector>

#include "physics/scene/scene.hpp"
#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Joins two vertices of a garment by a spring, such as a pocket's and one of the front behind it.
struct Stitch {
  int a = 0, b = 0;
  double rest_length = 0;  // [m]
  bool operator==(const Stitch&) const = default;
};

// A garment on the body that it was made for.
struct Garment {
  std::string name;
  SkinnedSurface skin;  // as worn in the body's zero pose and shape, with the directions it takes from the body
  BodyPose made_in;     // the pose in which its shape is its rest shape; no rows: the zero pose
  std::vector<std::pair<std::string, std::vector<int>>> groups;  // by name, vertices ascending
  std::vector<int> pins;                                         // vertices that stay with the body, ascending
  std::string made_for = {};                                     // the body's name; empty: not known
  std::vector<Stitch> stitches = {};
  std::vector<RestTriangle> flat = {};  // of each triangle, as cut from panels; empty: its rest shape, flattened
};

// How a garment vertex takes weights and directions from the body: from the nearest vertex, as tight garments do, or
// from all vertices about as near as that one, averaged (Gaussian, as wide as the vertex is far from the body), as
// loose ones do. ContourCraft (Grigorev et al. 2024) samples the same two ways, the loose one at random.
enum class Fit { tight, loose };

// A surface x worn in the body's zero pose and shape, given the body's weights and directions. Throws Error for one
// without vertices.
SkinnedSurface attached(const Points& x, const Triangles&, const BodyModel&, Fit);

// What each vertex worn in the body's zero pose takes from the body's vertices when those are moved: the ones about as
// near as the nearest, averaged (Gaussian, `width` [m] wide). Rows sum to 1.
SkinWeights shares_of_body(const Points& x, const BodyModel&, double width);

// The garment worn by the body in a shape and pose: skinned, which may tangle it.
Points worn(const Garment&, const BodyModel&, const Eigen::VectorXd& shape, const BodyPose&);

// Its rest shape on a body of that shape: as made, resized by the shape directions.
Points rest_shape(const Garment&, const BodyModel&, const Eigen::VectorXd& shape);

// Throws Error, naming `file` and the field, unless the sizes fit, indices are in range and ascend, all numbers are
// finite, weights sum to 1 and stitches join different vertices. For readers and makers of garments.
void check_garment(const Garment&, const std::string& file);

}  // namespace selvedge
