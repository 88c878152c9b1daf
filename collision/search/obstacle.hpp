#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// FCL, the Flexible Collision Library, where the build has it. It is used to compare: which triangles intersect (in
// plain floating point), and whether a garment touches a body. Without FCL everything here throws Error.
bool obstacle_available();

// A triangle mesh in FCL's tree of axis-aligned boxes.
class ObstacleModel {
 public:
  ObstacleModel(const Triangles&, const Points&);  // all finite
  ~ObstacleModel();
  ObstacleModel(ObstacleModel&&) noexcept;
  void refit(const Points&);  // the same triangles, moved

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// Triangles (i, j), i < j, that share no vertex and collide, sorted. FCL knows no adjacency: it also finds all the
// pairs that share one, which are left out afterwards.
std::vector<std::pair<int, int>> obstacle_self_pairs(const ObstacleModel&, const Triangles&);

// (triangle of a, triangle of b), sorted.
std::vector<std::pair<int, int>> obstacle_pairs(const ObstacleModel& a, const ObstacleModel& b);

// The test of ReFU: true if no triangle of the garment touches a triangle of the body.
bool collision_free(const ObstacleModel& garment, const ObstacleModel& body);

}  // namespace selvedge
