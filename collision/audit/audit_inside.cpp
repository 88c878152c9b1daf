#include "collision/audit/audit_inside.hpp"

#include <algorithm>
#include <numeric>

#include "collision/audit/audit_pair.hpp"
#include "collision/audit/box_pairs.hpp"
#include "collision/exact/orientation.hpp"

namespace selvedge {
namespace {

constexpr int most_rounds = 24;

// For each vertex the lowest one that triangles which do not meet the body connect to it. The audit does not use
// DisjointSets, since the response does.
std::vector<int> one_sided_groups(const Surface& cloth, const std::vector<char>& meets) {
  std::vector<int> up(cloth.vertex_count);
  std::iota(up.begin(), up.end(), 0);
  const auto top = [&up](int v) {
    while (up[v] != v) v = up[v] = up[up[v]];
    return v;
  };
  for (int t = 0; t < cloth.triangles.rows(); ++t)
    for (int k = 1; k < 3 && !meets[t]; ++k) {
      const int a = top(cloth.triangles(t, 0)), b = top(cloth.triangles(t, k));
      up[std::max(a, b)] = std::min(a, b);
    }
  for (int v = 0; v < cloth.vertex_count; ++v) up[v] = top(v);
  return up;
}

enum class Passage { beside, forwards, backwards, on_face, unclear };

// How the segment from p to q, a point outside of the body, passes a face: from its back forwards, or the other way.
// Unclear: through an edge or along the face.
Passage passage(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int from = orient3d(a, b, c, p), to = orient3d(a, b, c, q);
  if (from != 0 && from == to) return Passage::beside;
  if (from == 0 && triangles_intersect(p, p, p, a, b, c)) return Passage::on_face;
  const auto [least, most] = std::minmax({orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)});
  if (least < 0 && most > 0) return Passage::beside;
  if (from * to < 0 && (least > 0 || most < 0)) return from < 0 ? Passage::forwards : Passage::backwards;
  const bool has_area = orient2d(a, b, c, 0) != 0 || orient2d(a, b, c, 1) != 0 || orient2d(a, b, c, 2) != 0;
  return has_area ? Passage::unclear : Passage::beside;
}

struct Ray {
  int vertex;
  Vec3 from, to;
  int winding = 0;  // how often the body winds round the vertex
  bool on_face = false, unclear = false;
};

void trace(std::vector<Ray>& rays, std::span<const ExactBox> faces, const Surface& body, const Points& y) {
  std::vector<ExactBox> boxes;
  for (const Ray& ray : rays) {
    const Vec3 lo = ray.from.cwiseMin(ray.to), hi = ray.from.cwiseMax(ray.to);
    boxes.push_back({{lo.x(), lo.y(), lo.z()}, {hi.x(), hi.y(), hi.z()}});
  }
  AuditBudget budget(boxes.size() + faces.size());
  const ExactBox round_rays = hull_of(boxes);
  std::vector<int> near;
  std::vector<ExactBox> near_boxes;
  for (int t = 0; t < static_cast<int>(faces.size()); ++t)
    if (overlap(faces[t], round_rays)) {
      near.push_back(t);
      near_boxes.push_back(faces[t]);
    }
  const BoxPairs pairs(boxes, near_boxes, false);
  for (int part = 0; part < pairs.parts(); ++part)
    pairs.visit(
        part, budget, [](int, int) {},
        [&](int i, int k) {
          Ray& ray = rays[i];
          const int* v = body.triangles.data() + 3 * near[k];
          const Passage found = passage(ray.from, ray.to, row(y, v[0]), row(y, v[1]), row(y, v[2]));
          ray.winding += (found == Passage::forwards) - (found == Passage::backwards);
          ray.on_face |= found == Passage::on_face;
          ray.unclear |= found == Passage::unclear;
        });
  budget.check();
}

}  // namespace

std::vector<char> inside_body(const Surface& cloth, const Points& x, const std::vector<char>& meets,
                              const Surface& body, const Points& y) {
  std::vector<char> inside(cloth.vertex_count, 0);
  if (body.triangles.rows() == 0) return inside;
  std::vector<ExactBox> faces(static_cast<std::size_t>(body.triangles.rows()));
  const int count = static_cast<int>(faces.size());
#pragma omp parallel for schedule(static) if (count > 1000)
  for (int t = 0; t < count; ++t) faces[t] = box_of(body, y, t);
  const ExactBox hull = hull_of(faces);
  const Vec3 lo = Vec3::Map(hull.lo.data()), hi = Vec3::Map(hull.hi.data());
  int axis = 0;
  (hi - lo).minCoeff(&axis);

  const std::vector<int> group = one_sided_groups(cloth, meets);
  std::vector<Ray> open;
  for (int v = 0; v < cloth.vertex_count; ++v)
    if (const Vec3 p = row(x, v);
        group[v] == v && cloth.vertex_owner[v] >= 0 && (p.array() > lo.array()).all() && (p.array() < hi.array()).all())
      open.push_back({v, p, p});
  for (int round = 0; !open.empty(); ++round) {
    // Rays leave the body along its shortest side: straight at first, then tilted a little more each time an edge is
    // hit.
    for (Ray& ray : open) {
      ray = {ray.vertex, ray.from, ray.from};
      ray.to[axis] = hi[axis] + (hi - lo)[axis];
      ray.to[(axis + 1) % 3] += 0.0031 * round * (hi - lo)[axis];
      ray.to[(axis + 2) % 3] += 0.0019 * round * (hi - lo)[axis];
    }
    trace(open, faces, body, y);
    // A ray may stay unclear far from the origin, where rounding hides the tilt. Its vertex counts as inside.
    for (const Ray& ray : open)
      inside[ray.vertex] = !ray.on_face && (ray.unclear ? round + 1 == most_rounds : ray.winding != 0);
    std::erase_if(open, [&](const Ray& ray) { return ray.on_face || !ray.unclear || round + 1 == most_rounds; });
  }
  for (int v = 0; v < cloth.vertex_count; ++v) inside[v] = inside[group[v]];
  return inside;
}

}  // namespace selvedge
