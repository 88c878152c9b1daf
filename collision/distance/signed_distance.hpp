#pragma once

#include <span>
#include <vector>

#include "collision/distance/exposed_faces.hpp"
#include "collision/distance/wide_kernels.hpp"
#include "collision/distance/wide_tree.hpp"
#include "collision/distance/winding_tree.hpp"
#include "collision/search/bvh.hpp"
#include "collision/search/quiet.hpp"

namespace selvedge {

// What counts as the body where its surface passes through itself. united: the union of its parts, so that a closest
// point is on the outside of the whole. raw: the nearest triangle, even inside another part (as in ReFU).
enum class BodyShape { united, raw };

// Where on the surface a closest point lies: inside a triangle, on an edge (of a united body also where two of its
// parts meet), at a vertex.
enum class SurfacePlace { face, edge, vertex };

struct SignedDistance {
  double value = 0;              // [m], below 0 inside
  Vec3 gradient = Vec3::Zero();  // of `value`: unit length, out of the body; zero where no direction is known
  Vec3 closest = Vec3::Zero();
  Vec3 along = Vec3::Zero();  // direction of the edge, unit length; zero if `place` is not an edge
  SurfacePlace place = SurfacePlace::face;
  int triangle = -1;  // the lowest of the nearest ones
};

// Signed distance from a triangle surface, its closest points and its derivative. Distances are exact up to rounding.
// On closed manifolds the side comes from angle-weighted normals (pseudonormals.hpp). On open surfaces, and where these
// normals are zero, it comes from the winding number: inside if over 1/2. Triangles are counter-clockwise seen from
// outside.
class DistanceField {
 public:
  // Keeps a reference. Throws Error for a surface without triangles.
  explicit DistanceField(const Surface&, BodyShape = BodyShape::united);

  // Sets the surface's positions. Throws Error if any is not finite.
  void move_to(const Points& x);

  // The signed distance of each point. `faces` has for each point the triangle where the search begins, such as the
  // last nearest one, or -1; a list of another length is reset. On return it has the nearest triangles. The start
  // changes only the time. Throws Error for a point that is not finite, and before the first move_to.
  void ask(const Points& at, std::vector<int>& faces, std::vector<SignedDistance>& found) const;
  std::vector<SignedDistance> ask(const Points& at) const;

  bool is_closed() const { return closed_; }
  bool crosses_itself() const { return !exposed_.all_whole(); }  // or has hidden parts; false for a raw body
  const Surface& surface() const { return surface_; }
  const Points& positions() const { return x_; }

 private:
  struct Nearest {
    double squared_distance;
    int triangle = -1;
    Vec3 closest;
    Eigen::Vector4d weights;  // of p and, negative, of the corners: of the piece if the triangle is cut
    int piece = -1;
    bool tie = false;  // a second triangle is as near, and p inside both: a flat body, or the medial axis
  };
  struct Waiting {
    float squared;
    int child;
  };
  void measure(const Vec3& p, int triangle, Nearest&) const;
  void measure_leaf(const WideKernels&, const Vec3& p, const float* at, double reach, const WideTree::Leaf&,
                    float& limit, Nearest&) const;
  Nearest search(const Vec3& p, int start, std::vector<Waiting>& stack) const;
  bool complete(const Vec3& p, const Nearest&, SignedDistance&) const;
  Vec3 place(const Nearest&, SignedDistance&) const;
  Vec3 place_on_piece(const Vec3& p, const Nearest&, SignedDistance&) const;
  bool is_cut_near(int vertex) const;
  std::vector<char> winds_round(const Points&) const;
  Vec3 beside(const Vec3& p, const SignedDistance&) const;
  void decide_sides(const Points& at, std::span<const char> open, std::vector<SignedDistance>&) const;

  const Surface& surface_;
  BodyShape shape_;
  bool manifold_, closed_;
  Points x_;
  KeptBvh tree_;
  WideTree wide_;
  WindingTree windings_;
  QuietParts parts_;
  ExposedFaces exposed_;
  std::vector<Box> boxes_;
};

}  // namespace selvedge
