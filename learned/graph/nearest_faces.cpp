#include "learned/graph/nearest_faces.hpp"

#include <limits>

#include "collision/geometry/distance.hpp"
#include "learned/graph/nearest_search.hpp"

namespace selvedge {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

void centroids_of(const Surface& surface, const Points& x, const std::vector<char>& left_out, Points& centroids) {
  const auto count = static_cast<int>(surface.triangles.rows());
  centroids.resize(count, 3);
  for (int f = 0; f < count; ++f) {
    const int* corner = surface.triangles.data() + 3 * f;
    if (!left_out.empty() && left_out[static_cast<std::size_t>(f)])
      centroids.row(f).setConstant(undefined);
    else
      centroids.row(f) = (x.row(corner[0]) + x.row(corner[1]) + x.row(corner[2])) / 3;
  }
}

template <class Rows>
bool same_rows(const Rows& a, const Rows& b) {
  return a.rows() == b.rows() && a == b;
}

// The new parts of a query, which is noted. Undefined positions are never the same.
struct NewInQuestion {
  bool faces = false, points = false;
};

NewInQuestion note_question(const Surface& surface, const Points& x, const std::vector<char>& left_out, double radius,
                            const Points& points, NearestQuery& query) {
  NewInQuestion fresh;
  fresh.faces = query.radius != radius || query.left_out != left_out || !same_rows(query.x, x) ||
                !same_rows(query.triangles, surface.triangles);
  fresh.points = !same_rows(query.points, points);
  if (fresh.faces) query = {surface.triangles, x, query.points, left_out, radius};
  if (fresh.points) query.points = points;
  return fresh;
}

template <class SquaredOf>
void search_from_all(const Points& points, double squared, NearestFaces& search, SquaredOf&& squared_of) {
  vertex_boxes(points, points, 0, search.boxes);
  update(search.points, search.boxes);
  find_nearest_of_all(points, search.points.bvh, search.faces.bvh, squared, search.last, squared_of);
}

}  // namespace

CentroidPlane centroid_plane(const Surface& surface, const Points& x, int face) {
  const int* corner = surface.triangles.data() + 3 * face;
  const Vec3 a = row(x, corner[0]), b = row(x, corner[1]), c = row(x, corner[2]);
  return {(a + b + c) / 3, (b - a).cross(c - a).normalized()};
}

const std::vector<int>& nearest_centroids(const Surface& surface, const Points& x, const std::vector<char>& left_out,
                                          const Points& points, NearestFaces& search) {
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  const NewInQuestion fresh = note_question(surface, x, left_out, anywhere, points, search.query);
  if (!fresh.faces && !fresh.points) return search.last;
  if (fresh.faces) {
    centroids_of(surface, x, left_out, search.centroids);
    vertex_boxes(search.centroids, search.centroids, 0, search.boxes);
    update(search.faces, search.boxes);
  }
  search_from_all(points, anywhere, search,
                  [&](const Vec3& p, int f) { return (row(search.centroids, f) - p).squaredNorm(); });
  return search.last;
}

const std::vector<int>& nearest_faces(const Surface& surface, const Points& x, const std::vector<char>& left_out,
                                      double radius, const Points& points, NearestFaces& search) {
  const NewInQuestion fresh = note_question(surface, x, left_out, radius, points, search.query);
  if (!fresh.faces && !fresh.points) return search.last;
  const auto is_out = [&](int f) { return !left_out.empty() && left_out[static_cast<std::size_t>(f)]; };
  if (fresh.faces) {
    triangle_boxes(surface, x, x, 0, search.boxes);
    for (int f = 0; f < static_cast<int>(search.boxes.size()); ++f)
      if (is_out(f)) search.boxes[static_cast<std::size_t>(f)] = empty_box;
    update(search.faces, search.boxes);
  }
  search_from_all(points, radius * radius, search, [&](const Vec3& p, int f) {
    if (is_out(f)) return undefined;
    const int* v = surface.triangles.data() + 3 * f;
    return point_triangle(p, row(x, v[0]), row(x, v[1]), row(x, v[2])).squared_distance;
  });
  return search.last;
}

}  // namespace selvedge
