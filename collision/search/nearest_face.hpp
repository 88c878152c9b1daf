#pragma once

#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "collision/search/bvh.hpp"

namespace selvedge {

// A tree of some faces of a surface at positions x. It keeps pointers to both, which must outlive it.
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
  std::array<double, 3> weight{};  // of its corners, sum 1: they give the nearest point
};

// The face nearest to p among those without the vertex own_vertex. own_vertex = -1: among all.
NearestFace nearest_face(const FaceTree&, int own_vertex, const Vec3& p);

// The nearest face among those with counts(face) true that are nearer than `within` [m].
NearestFace nearest_face(const FaceTree&, const Vec3& p, double within, const std::function<bool(int face)>& counts);

}  // namespace selvedge
