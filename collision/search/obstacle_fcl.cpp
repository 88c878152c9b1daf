#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <limits>

#include "collision/geometry/corners.hpp"
#include "collision/geometry/lists.hpp"
#include "collision/search/obstacle.hpp"

namespace selvedge {

// Uses axis-aligned boxes. On folded cloth they are faster than FCL's oriented ones, and after a refit these missed a
// few pairs in ten thousand.
struct ObstacleModel::Impl {
  fcl::BVHModel<fcl::AABBd> mesh;
};

namespace {

std::vector<fcl::Vector3d> vertices(const Points& x) {
  std::vector<fcl::Vector3d> list(x.rows());
  for (Eigen::Index v = 0; v < x.rows(); ++v) list[v] = x.row(v).transpose();
  return list;
}

std::vector<std::pair<int, int>> contacts(const ObstacleModel& a, const ObstacleModel& b, std::size_t at_most) {
  std::vector<std::pair<int, int>> pairs;
  if (a.impl().mesh.num_tris == 0 || b.impl().mesh.num_tris == 0) return pairs;
  const fcl::CollisionRequestd request(at_most, false);
  fcl::CollisionResultd result;
  const fcl::Transform3d here = fcl::Transform3d::Identity();
  fcl::collide(&a.impl().mesh, here, &b.impl().mesh, here, request, result);
  pairs.reserve(result.numContacts());
  for (std::size_t i = 0; i < result.numContacts(); ++i)
    pairs.emplace_back(static_cast<int>(result.getContact(i).b1), static_cast<int>(result.getContact(i).b2));
  return pairs;
}

}  // namespace

bool obstacle_available() { return true; }

ObstacleModel::ObstacleModel(const Triangles& triangles, const Points& x) : impl_(std::make_unique<Impl>()) {
  std::vector<fcl::Triangle> faces;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    faces.emplace_back(triangles(t, 0), triangles(t, 1), triangles(t, 2));
  if (faces.empty()) return;
  impl_->mesh.beginModel(static_cast<int>(faces.size()), static_cast<int>(x.rows()));
  impl_->mesh.addSubModel(vertices(x), faces);
  impl_->mesh.endModel();
}

ObstacleModel::~ObstacleModel() = default;
ObstacleModel::ObstacleModel(ObstacleModel&&) noexcept = default;

void ObstacleModel::refit(const Points& x) {
  if (impl_->mesh.num_tris == 0) return;
  impl_->mesh.beginReplaceModel();
  impl_->mesh.replaceSubModel(vertices(x));
  impl_->mesh.endReplaceModel(true, true);
}

std::vector<std::pair<int, int>> obstacle_self_pairs(const ObstacleModel& model, const Triangles& triangles) {
  std::vector<std::pair<int, int>> pairs = contacts(model, model, std::numeric_limits<int>::max());
  std::erase_if(pairs,
                [&](const auto& p) { return p.first == p.second || share_vertex(triangles, p.first, p.second); });
  for (auto& [i, j] : pairs)
    if (j < i) std::swap(i, j);
  sort_once(pairs);
  return pairs;
}

std::vector<std::pair<int, int>> obstacle_pairs(const ObstacleModel& a, const ObstacleModel& b) {
  std::vector<std::pair<int, int>> pairs = contacts(a, b, std::numeric_limits<int>::max());
  sort_once(pairs);
  return pairs;
}

bool collision_free(const ObstacleModel& garment, const ObstacleModel& body) {
  return contacts(garment, body, 1).empty();
}

}  // namespace selvedge
