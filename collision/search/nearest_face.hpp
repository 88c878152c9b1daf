#pragma once

#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "collision/search/bvh.hpp"

namespace selvedge {

// Some faces of a surface where it is now, in a tree. Looks at both.
struct FaceTree {
  const Surface* surface = nullptr;
  const Points* x = nullptr;
  std::vector<int> faces;
  Bvh bvh;
};

FaceTree make_face_tree(const Surface&, const Points& x, std::vector<int> faces);

// face: -1 where there is none.
struct NearestFace {
  int face = -1;
  double squared_distance = std::numeric_limits<double>::infinity();  // [m^2]
  std::array<double, 3> weight{};                                     // of its corners: the nearest point, sum 1
};

// The face nearest to p of those that do not have the vertex own_vertex, which may be -1.
NearestFace nearest_face(const FaceTree&, int own_vertex, const Vec3& p);

// The same of those that `counts` says yes to, nearer than `within` [m].
NearestFace nearest_face(const FaceTree&, const Vec3& p, double within, const std::function<bool(int face)>& counts);

}  // namespace selvedge
