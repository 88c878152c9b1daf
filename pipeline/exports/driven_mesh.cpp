#include "pipeline/exports/driven_mesh.hpp"

#include <numeric>

#include "collision/geometry/surface.hpp"
#include "collision/search/nearest_face.hpp"

namespace selvedge {
namespace {

// Columns: along the first edge, across it, along the normal. Zeros for a triangle without area.
Mat3 frame_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 along = (b - a).normalized(), normal = (b - a).cross(c - a).normalized();
  Mat3 frame;
  frame << along, normal.cross(along), normal;
  return frame;
}

}  // namespace

Binding bound_to(const Points& rest, const Triangles& triangles, const Points& x) {
  const Surface surface = make_surface(static_cast<int>(rest.rows()), triangles);
  std::vector<int> faces(static_cast<std::size_t>(triangles.rows()));
  std::iota(faces.begin(), faces.end(), 0);
  const FaceTree tree = make_face_tree(surface, rest, faces);
  Binding binding;
  binding.places.resize(static_cast<std::size_t>(x.rows()));
  Eigen::VectorXd distance(x.rows());
#pragma omp parallel for schedule(static)
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const Vec3 p = x.row(v).transpose();
    const NearestFace nearest = nearest_face(tree, -1, p);
    Binding::Place& place = binding.places[static_cast<std::size_t>(v)];
    place.weights = nearest.weight;
    Vec3 foot = Vec3::Zero();
    std::array<Vec3, 3> at;
    for (std::size_t k = 0; k < 3; ++k) {
      place.corners[k] = triangles(nearest.face, static_cast<Eigen::Index>(k));
      at[k] = row(rest, place.corners[k]);
      foot += place.weights[k] * at[k];
    }
    place.away = frame_of(at[0], at[1], at[2]).transpose() * (p - foot);
    distance[v] = (p - foot).norm();
  }
  binding.mean_distance = distance.mean();
  return binding;
}

PointsF driven(const Binding& binding, const PointsF& x) {
  PointsF moved(std::ssize(binding.places), 3);
  for (Eigen::Index v = 0; v < moved.rows(); ++v) {
    const Binding::Place& place = binding.places[static_cast<std::size_t>(v)];
    std::array<Vec3, 3> at;
    Vec3 p = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = x.row(place.corners[k]).cast<double>().transpose();
      p += place.weights[k] * at[k];
    }
    moved.row(v) = (p + frame_of(at[0], at[1], at[2]) * place.away).cast<float>().transpose();
  }
  return moved;
}

}  // namespace selvedge
