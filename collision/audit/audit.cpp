#include "collision/audit/audit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/audit/audit_inside.hpp"
#include "collision/audit/audit_memory.hpp"
#include "collision/audit/audit_pair.hpp"
#include "collision/audit/box_pairs.hpp"
#include "collision/audit/moving_pair.hpp"
#include "collision/geometry/distance.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

struct Triangle {
  std::array<Vec3, 3> corners;
  std::array<int, 3> vertices;
  int number;  // in its mesh; numbered over all obstacles

  bool is_finite() const { return corners[0].allFinite() && corners[1].allFinite() && corners[2].allFinite(); }
};

Triangle triangle_of(const Surface& surface, const Points& x, int t, int first_number) {
  const std::array<int, 3> v{surface.triangles(t, 0), surface.triangles(t, 1), surface.triangles(t, 2)};
  return {{row(x, v[0]), row(x, v[1]), row(x, v[2])}, v, first_number + t};
}

// Triangles without undefined coordinates, and their boxes.
struct Soup {
  std::vector<Triangle> triangles;
  std::vector<ExactBox> boxes;
};

// Adds the triangles whose boxes, grown by the margin, overlap the bounds.
void add_triangles(const Surface& surface, const Points& x, int first_number, double margin, const ExactBox& bounds,
                   Soup& soup) {
  for (int t = 0; t < surface.triangles.rows(); ++t) {
    const Triangle triangle = triangle_of(surface, x, t, first_number);
    const ExactBox box = box_of(surface, x, t, margin);
    if (!triangle.is_finite() || !overlap(box, bounds)) continue;
    soup.triangles.push_back(triangle);
    soup.boxes.push_back(box);
  }
}

Soup soup_of(const Surface& surface, const Points& x, double margin) {
  Soup soup;
  add_triangles(surface, x, 0, margin, everywhere, soup);
  return soup;
}

// The bodies' triangles that may meet the cloth's.
Soup soup_near(const Soup& cloth, std::span<const AuditBody> bodies, double margin) {
  const ExactBox bounds = hull_of(cloth.boxes);
  Soup soup;
  int first_number = 0;
  for (const AuditBody& body : bodies) {
    add_triangles(*body.surface, *body.points, first_number, margin, bounds, soup);
    first_number += static_cast<int>(body.surface->triangles.rows());
  }
  return soup;
}

int shared_vertices(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  int shared = 0;
  for (int v : a) shared += v == b[0] || v == b[1] || v == b[2];
  return shared;
}

bool intersect(const Triangle& s, const Triangle& t) {
  const auto &a = s.corners, &b = t.corners;
  return triangles_intersect(a[0], a[1], a[2], b[0], b[1], b[2]);
}

// True only if a plane through s separates the triangles s, a1, a2 and s, b1, b2, with room for rounding. Nearly all
// pairs that share one vertex pass.
bool surely_beside(const Vec3& s, const Vec3& a1, const Vec3& a2, const Vec3& b1, const Vec3& b2) {
  const std::array<Vec3, 2> a{a1 - s, a2 - s}, b{b1 - s, b2 - s};
  return stay_apart_beside({a, a}, {b, b});
}

// For triangles that share one vertex: do they share more than this point?
bool cross_at_vertex(const Triangle& a, const Triangle& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a.vertices[i] == b.vertices[j]) {
        const auto &p = a.corners, &q = b.corners;
        if (surely_beside(p[i], p[(i + 1) % 3], p[(i + 2) % 3], q[(j + 1) % 3], q[(j + 2) % 3])) return false;
        return triangles_cross_at_vertex(p[i], p[(i + 1) % 3], p[(i + 2) % 3], q[(j + 1) % 3], q[(j + 2) % 3]);
      }
  return false;
}

// Judges two triangles of the cloth.
void judge_pair(const Triangle& a, const Triangle& b, Audit& found) {
  const int shared = shared_vertices(a.vertices, b.vertices);
  const std::pair numbers = std::minmax({a.number, b.number});
  if (shared == 0 && intersect(a, b)) found.self_pairs.push_back(numbers);
  if (shared == 1 && cross_at_vertex(a, b)) found.vertex_pairs.push_back(numbers);
}

// Judges a triangle of the cloth and one of a body.
void judge_body_pair(const Triangle& a, const Triangle& c, Audit& found) {
  if (intersect(a, c)) found.obstacle_pairs.emplace_back(a.number, c.number);
}

void audit_part(const BoxPairs& pairs, int part, const Soup& cloth, const Soup& bodies, AuditBudget& budget,
                Audit& found) {
  pairs.visit(
      part, budget, [&](int a, int b) { judge_pair(cloth.triangles[a], cloth.triangles[b], found); },
      [&](int a, int c) { judge_body_pair(cloth.triangles[a], bodies.triangles[c], found); });
}

int count_nonfinite(const Points& x) {
  int count = 0;
  for (int v = 0; v < x.rows(); ++v) count += !x.row(v).allFinite();
  return count;
}

// Cloth vertices inside obstacles. pairs: (cloth triangle, obstacle triangle) that intersect.
int count_inside(const Surface& cloth, const Points& x, std::span<const AuditBody> obstacles, const Pairs& pairs) {
  std::vector<char> is_inside(cloth.vertex_count, 0), undefined(cloth.triangles.rows(), 0);
  for (int t = 0; t < cloth.triangles.rows(); ++t)
    for (int v : cloth.triangles.row(t)) undefined[t] |= !x.row(v).allFinite();
  int first = 0;
  for (const AuditBody& body : obstacles) {
    const int end = first + static_cast<int>(body.surface->triangles.rows());
    if (is_closed(*body.surface) && count_nonfinite(*body.points) == 0) {
      std::vector<char> meets = undefined;
      for (const auto& [a, c] : pairs)
        if (c >= first && c < end) meets[a] = 1;
      const std::vector<char> here = inside_body(cloth, x, meets, *body.surface, *body.points);
      for (int v = 0; v < cloth.vertex_count; ++v) is_inside[v] |= here[v];
    }
    first = end;
  }
  return static_cast<int>(std::count(is_inside.begin(), is_inside.end(), 1));
}

// Squared distance of triangles that do not intersect: between a vertex and a face or between two edges.
double squared_gap(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    least = std::min(least, point_triangle(a[i], b[0], b[1], b[2]).squared_distance);
    least = std::min(least, point_triangle(b[i], a[0], a[1], a[2]).squared_distance);
    for (int j = 0; j < 3; ++j)
      least = std::min(least, edge_edge(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]).squared_distance);
  }
  return least;
}

double squared_box_gap(const ExactBox& a, const ExactBox& b, double margin) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double apart = std::max(a.lo[k] - b.hi[k], b.lo[k] - a.hi[k]) + 2 * margin;
    if (apart > 0) sum += apart * apart;
  }
  return sum;
}

// Least squared gap of the pairs in a part of the search, or `bound` if none is nearer.
double gap_in_part(const BoxPairs& pairs, int part, const Soup& cloth, const Soup& bodies, double margin, double bound,
                   AuditBudget& budget) {
  double least = bound;
  const auto take = [&](const Soup& second, int a, int b) {
    // A little slack for the rounding of the margins: skipping a pair must never change the result.
    if (squared_box_gap(cloth.boxes[a], second.boxes[b], margin) > least * (1 + 1e-9) + 1e-300) return;
    const Triangle &s = cloth.triangles[a], &t = second.triangles[b];
    least = std::min(least, intersect(s, t) ? 0.0 : squared_gap(s.corners, t.corners));
  };
  pairs.visit(
      part, budget,
      [&](int a, int b) {
        if (shared_vertices(cloth.triangles[a].vertices, cloth.triangles[b].vertices) == 0) take(cloth, a, b);
      },
      [&](int a, int c) { take(bodies, a, c); });
  return least;
}

Audit joined_and_sorted(const std::vector<Audit>& parts) {
  Audit all = joined(parts, &Audit::self_pairs, &Audit::vertex_pairs, &Audit::obstacle_pairs);
  for (Pairs* pairs : {&all.self_pairs, &all.vertex_pairs, &all.obstacle_pairs})
    std::sort(pairs->begin(), pairs->end());
  return all;
}

// The audit of listed pairs. All coordinates are finite.
Audit audit_listed(const Surface& cloth, const Points& x, std::span<const AuditBody> obstacles, const Pairs& self_pairs,
                   const Pairs& body_pairs) {
  constexpr int at_once = 256;
  const int of_self = static_cast<int>(self_pairs.size()), count = of_self + static_cast<int>(body_pairs.size());
  std::vector<Audit> found(static_cast<std::size_t>((count + at_once - 1) / at_once));
  StopPoll stop;
#pragma omp parallel for schedule(static)
  for (int k = 0; k < static_cast<int>(found.size()); ++k)
    for (int i = k * at_once, end = stop.wanted() ? 0 : std::min(count, (k + 1) * at_once); i < end; ++i) {
      const auto& [a, b] = i < of_self ? self_pairs[i] : body_pairs[i - of_self];
      const Triangle mine = triangle_of(cloth, x, a, 0);
      if (i < of_self) {
        judge_pair(mine, triangle_of(cloth, x, b, 0), found[k]);
        continue;
      }
      const AuditBody* body = obstacles.data();
      int t = b;
      for (; t >= body->surface->triangles.rows(); ++body) t -= static_cast<int>(body->surface->triangles.rows());
      judge_body_pair(mine, triangle_of(*body->surface, *body->points, t, b - t), found[k]);
    }
  stop.check();
  return joined_and_sorted(found);
}

Pairs triangles_of(const std::vector<AuditMemory::Pair>& pairs) {
  Pairs triangles;
  for (const AuditMemory::Pair& pair : pairs) triangles.emplace_back(pair.a, pair.b);
  return triangles;
}

// Looks at the pairs that the memory leaves open. If no triangle has come near an obstacle since the reference, no
// vertex has gone into it or out of it.
Audit answer(const AuditQuestions& questions, const Surface& cloth, const Points& x,
             std::span<const AuditBody> obstacles, AuditMemory& memory) {
  Audit result =
      audit_listed(cloth, x, obstacles, triangles_of(questions.self_pairs), triangles_of(questions.body_pairs));
  if (questions.body_pairs.empty() && memory.inside >= 0) {
    result.inside_vertices = memory.inside;
  } else {
    result.inside_vertices = count_inside(cloth, x, obstacles, result.obstacle_pairs);
    if (questions.body_pairs.empty()) memory.inside = result.inside_vertices;
  }
  return result;
}

}  // namespace

Audit audit(const Surface& cloth, const Points& x, std::span<const AuditBody> obstacles, bool self,
            AuditMemory* memory) {
  restore_standard_arithmetic();
  if (memory) {
    std::vector<MovingBody> bodies;
    for (const AuditBody& body : obstacles) bodies.push_back({body.surface, body.points, body.points});
    const MovingBody still{&cloth, &x, &x};
    const AuditQuestions questions = open_questions(*memory, still, bodies, self);
    if (!questions.all) return answer(questions, cloth, x, obstacles, *memory);
    if (is_at_end(memory->end, still, bodies, self)) {
      Audit result = audit_listed(cloth, x, obstacles, memory->end.self_pairs, memory->end.body_pairs);
      result.inside_vertices = count_inside(cloth, x, obstacles, result.obstacle_pairs);
      return result;
    }
  }
  const Soup mine = soup_of(cloth, x, 0), others = soup_near(mine, obstacles, 0);
  const BoxPairs pairs(mine.boxes, others.boxes, self);
  const int count = pairs.parts();
  std::vector<Audit> found(static_cast<std::size_t>(count));
  AuditBudget budget(mine.boxes.size() + others.boxes.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int r = 0; r < count; ++r) audit_part(pairs, r, mine, others, budget, found[r]);
  budget.check();

  Audit result = joined_and_sorted(found);
  result.inside_vertices = count_inside(cloth, x, obstacles, result.obstacle_pairs);
  result.nonfinite = count_nonfinite(x);
  for (const AuditBody& body : obstacles) result.nonfinite += count_nonfinite(*body.points);
  return result;
}

double min_gap(const Surface& cloth, const Points& x, std::span<const AuditBody> obstacles, double horizon) {
  // A box grows by half the horizon on each side, and a little more for rounding.
  const double margin = 0.5 * horizon * (1 + 1e-9);
  const Soup mine = soup_of(cloth, x, margin), others = soup_near(mine, obstacles, margin);
  const BoxPairs pairs(mine.boxes, others.boxes, true);
  const int count = pairs.parts();
  std::vector<double> least(static_cast<std::size_t>(count));
  AuditBudget budget(mine.boxes.size() + others.boxes.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int r = 0; r < count; ++r) least[r] = gap_in_part(pairs, r, mine, others, margin, horizon * horizon, budget);
  budget.check();
  const double nearest = least.empty() ? horizon * horizon : *std::min_element(least.begin(), least.end());
  return nearest < horizon * horizon ? std::sqrt(nearest) : std::numeric_limits<double>::infinity();
}

}  // namespace selvedge
