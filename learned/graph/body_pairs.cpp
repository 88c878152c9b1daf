#include "learned/graph/body_pairs.hpp"

#include "collision/geometry/distance.hpp"
#include "learned/graph/nearest_search.hpp"

namespace selvedge {
namespace {

double squared_to_face(const Surface& body, const Points& x, const Vec3& p, int face) {
  const int* v = body.triangles.data() + 3 * face;
  return point_triangle(p, row(x, v[0]), row(x, v[1]), row(x, v[2])).squared_distance;
}

// The nearest vertex of the face, the first of several.
int nearest_corner(const Surface& body, const Points& x, const Vec3& p, int face) {
  int best = body.triangles(face, 0);
  for (int k = 1; k < 3; ++k) {
    const int v = body.triangles(face, k);
    if ((row(x, v) - p).squaredNorm() < (row(x, best) - p).squaredNorm()) best = v;
  }
  return best;
}

void refresh_trees(const GraphScene& scene, BodyPartner partner, const Points& cloth, const Points& body,
                   BodySearch& search) {
  if (partner == BodyPartner::nearest_vertex)
    vertex_boxes(body, body, 0, search.boxes);
  else
    triangle_boxes(scene.body, body, body, 0, search.boxes);
  update(search.body, search.boxes);
  vertex_boxes(cloth, cloth, 0, search.boxes);
  update(search.cloth, search.boxes);
}

}  // namespace

std::vector<BodyPair> find_body_pairs(const GraphScene& scene, const FeatureOptions& options, const Points& cloth,
                                      const Points& body, BodySearch& search) {
  std::vector<BodyPair> pairs;
  if (body.rows() == 0) return pairs;
  const bool vertices = options.body_partner == BodyPartner::nearest_vertex;
  refresh_trees(scene, options.body_partner, cloth, body, search);
  const auto search_all = [&](const auto& squared_of) {
    find_nearest_of_all(cloth, search.cloth.bvh, search.body.bvh, options.body_radius * options.body_radius,
                        search.last, squared_of);
  };
  if (vertices)
    search_all([&](const Vec3& p, int v) { return (row(body, v) - p).squaredNorm(); });
  else
    search_all([&](const Vec3& p, int face) { return squared_to_face(scene.body, body, p, face); });
  for (int v = 0; v < static_cast<int>(search.last.size()); ++v) {
    const int item = search.last[static_cast<std::size_t>(v)];
    if (item < 0) continue;
    pairs.push_back(vertices ? BodyPair{v, -1, item}
                             : BodyPair{v, item, nearest_corner(scene.body, body, row(cloth, v), item)});
  }
  return pairs;
}

}  // namespace selvedge
