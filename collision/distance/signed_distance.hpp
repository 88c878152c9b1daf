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

// What counts as the body where its surface passes through itself. united: all that lies inside any part of it, so that
// a closest point is on the outside of the whole. raw: the nearest triangle, whatever lies round it (ReFU).
enum class BodyShape { united, raw };

// Where on the surface a closest point lies: inside a triangle, on an edge (of a united body also where two of its
// parts meet), at a vertex.
enum class SurfacePlace { face, edge, vertex };

struct SignedDistance {
  double value = 0;              // [m], below 0 inside
  Vec3 gradient = Vec3::Zero();  // of `value`: unit length, out of the body; zero where nothing tells a direction
  Vec3 closest = Vec3::Zero();
  Vec3 along = Vec3::Zero();  // of the edge, unit length; zero where the place is none
  SurfacePlace place = SurfacePlace::face;
  int triangle = -1;  // the lowest of the nearest ones
};

// Signed distance from a triangle surface, its closest points and its derivative. Distances are exact but for rounding.
// The side is told by angle-weighted normals on closed manifolds, and by the winding number, over 1/2 or not,
// elsewhere: on open surfaces, and where the normals say nothing. Triangles are counter-clockwise seen from outside.
class DistanceField {
 public:
  // Keeps a reference. Throws Error for a surface without triangles.
  explicit DistanceField(const Surface&, BodyShape = BodyShape::united);

  // The surface is there now. Throws Error for positions that are not finite.
  void move_to(const Points& x);

  // Of each point. `faces`, one a point, are where the search begins: the last nearest triangles, or -1; a list of
  // another length begins anew. It returns with the nearest triangles. Where it begins changes the time and nothing
  // else. Throws Error for a point that is not finite, and before the first move_to.
  void ask(const Points& at, std::vector<int>& faces, std::vector<SignedDistance>& found) const;
  std::vector<SignedDistance> ask(const Points& at) const;

  bool is_closed() const { return closed_; }
  bool crosses_itself() const { return !exposed_.all_whole(); }  // or holds hidden parts; false of a raw body
  const Surface& surface() const { return surface_; }
  const Points& positions() const { return x_; }

 private:
  struct Nearest {
    double squared_distance;
    int triangle = -1;
    Vec3 closest;
    Eigen::Vector4d weights;  // of p and, negative, of the corners; of the piece's where the triangle is cut
    int piece = -1;
    bool tie = false;  // another one is as near, inside of both: the sheets of a flat body, or the medial axis
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
