#include "collision/audit/audit_memory.hpp"

#include <algorithm>

#include "collision/audit/box_pairs.hpp"

namespace selvedge {
namespace {

constexpr double most_reach = 0.4, first_reach = 0.2;  // in the cloth's mean edges
constexpr double many = 16;     // pairs for each of the cloth's triangles: with more, the reach is shortened
constexpr double slow = 0.125;  // of the reach: remembering pays if motion since the last audit is less
constexpr double rounding_to_float = 0x1p-22;  // of a coordinate: four times the error

using Corners = std::array<Vec3, 3>;

// The gap of two sets of points along the best direction tried: a lower bound of their distance.
struct Gap {
  double best = 0;

  template <std::size_t Count, std::size_t Other>
  void along(const Vec3& m, const std::array<Vec3, Count>& a, const std::array<Vec3, Other>& b) {
    const double length = m.norm();
    if (!(length > 0)) return;
    double a_lo = m.dot(a[0]), a_hi = a_lo, b_lo = m.dot(b[0]), b_hi = b_lo;
    for (std::size_t i = 1; i < Count; ++i) {
      a_lo = std::min(a_lo, m.dot(a[i]));
      a_hi = std::max(a_hi, m.dot(a[i]));
    }
    for (std::size_t i = 1; i < Other; ++i) {
      b_lo = std::min(b_lo, m.dot(b[i]));
      b_hi = std::max(b_hi, m.dot(b[i]));
    }
    best = std::max({best, (b_lo - a_hi) / length, (a_lo - b_hi) / length});
  }
};

Vec3 normal(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

Vec3 across(const Vec3& edge, const Vec3& to) { return to - edge * (edge.dot(to) / edge.squaredNorm()); }

double gap_of_triangles(const Corners& a, const Corners& b) {
  Gap gap;
  gap.along(normal(a), a, b);
  gap.along(normal(b), a, b);
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge_a = a[(i + 1) % 3] - a[i], edge_b = b[(i + 1) % 3] - b[i];
    gap.along(edge_a.cross(normal(a)), a, b);
    gap.along(edge_b.cross(normal(b)), a, b);
    for (int j = 0; j < 3; ++j) gap.along(edge_a.cross(b[(j + 1) % 3] - b[j]), a, b);
  }
  return gap.best;
}

// For triangles s, a[0], a[1] and s, b[0], b[1]: if a plane through s separates the others, at more than twice the
// returned distance, then the triangles share no more than s while vertices move by less than that.
double gap_beside(const Vec3& s, const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b) {
  const Vec3 to_a = a[0] + a[1] - 2 * s, to_b = b[0] + b[1] - 2 * s;
  double best = 0;
  for (const Vec3& m : {Vec3(to_b - to_a), Vec3(to_b * to_a.norm() - to_a * to_b.norm())}) {
    const double length = m.norm();
    if (!(length > 0)) continue;
    const double below = -std::max(m.dot(a[0] - s), m.dot(a[1] - s)),
                 above = std::min(m.dot(b[0] - s), m.dot(b[1] - s));
    best = std::max(best, std::min(below, above) / length);
  }
  return 0.5 * best;
}

double gap_of_vertex_and_face(const Vec3& p, const Corners& f) {
  Gap gap;
  const std::array<Vec3, 1> point{p};
  gap.along(normal(f), point, f);
  for (int k = 0; k < 3; ++k) {
    gap.along(across(f[(k + 1) % 3] - f[k], p - f[k]), point, f);
    gap.along(p - f[k], point, f);
  }
  return gap.best;
}

double gap_of_edges(const std::array<Vec3, 2>& p, const std::array<Vec3, 2>& q) {
  Gap gap;
  const Vec3 a = p[1] - p[0], b = q[1] - q[0];
  gap.along(a.cross(b), p, q);
  for (int k = 0; k < 2; ++k) {
    gap.along(across(a, q[k] - p[0]), p, q);
    gap.along(across(b, p[k] - q[0]), p, q);
    for (int j = 0; j < 2; ++j) gap.along(p[k] - q[j], p, q);
  }
  return gap.best;
}

// For two triangles on the edge s, t with the third vertices a and b: the gap of those parts that share no vertex.
double gap_at_edge(const Vec3& s, const Vec3& t, const Vec3& a, const Vec3& b) {
  return std::min({gap_of_vertex_and_face(a, {s, t, b}), gap_of_vertex_and_face(b, {s, t, a}),
                   gap_of_edges({s, a}, {t, b}), gap_of_edges({t, a}, {s, b})});
}

// Triangles with their boxes, grown so that boxes of triangles within the reach overlap.
struct Faces {
  std::vector<Corners> corners;
  std::vector<std::array<int, 3>> vertices;
  std::vector<ExactBox> boxes;

  void add(const Surface& surface, const Points& x, double margin) {
    for (int t = 0; t < surface.triangles.rows(); ++t) {
      const std::array<int, 3> v{surface.triangles(t, 0), surface.triangles(t, 1), surface.triangles(t, 2)};
      corners.push_back({row(x, v[0]), row(x, v[1]), row(x, v[2])});
      vertices.push_back(v);
      boxes.push_back(box_of(surface, x, t, margin));
    }
  }
};

AuditMemory::Pair measured(const Faces& cloth, int a, int b) {
  // Moves shared vertices to the front of both triangles.
  std::array<int, 3> in_a{0, 1, 2}, in_b{0, 1, 2};
  int shared = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = shared; j < 3; ++j)
      if (cloth.vertices[a][in_a[i]] == cloth.vertices[b][in_b[j]]) {
        std::swap(in_a[shared], in_a[i]);
        std::swap(in_b[shared], in_b[j]);
        ++shared;
        break;
      }
  const Corners &p = cloth.corners[a], &q = cloth.corners[b];
  double gap = 0;
  if (shared == 0) gap = gap_of_triangles(p, q);
  if (shared == 1) gap = gap_beside(p[in_a[0]], {p[in_a[1]], p[in_a[2]]}, {q[in_b[1]], q[in_b[2]]});
  if (shared == 2) gap = gap_at_edge(p[in_a[0]], p[in_a[1]], p[in_a[2]], q[in_b[2]]);
  return {a, b, gap, shared};
}

double largest(std::span<const Points> all) {
  double size = 0;
  for (const Points& x : all) size = std::max(size, largest_coordinate(x));
  return size;
}

// Lists the pairs within reach of the reference, with their gaps minus what rounding may have added. False if there are
// too many pairs.
bool measure(AuditMemory& memory, const Surface& cloth, std::span<const MovingBody> bodies, bool self) {
  Faces mine, others;
  const double margin = 0.5 * memory.reach * (1 + 1e-9);
  mine.add(cloth, memory.reference[0], margin);
  for (std::size_t k = 0; k < bodies.size(); ++k) others.add(*bodies[k].surface, memory.reference[k + 1], margin);
  const double rounding = 1e-13 * largest(memory.reference);
  const BoxPairs pairs(mine.boxes, others.boxes, self);
  const int count = pairs.parts();
  std::vector<std::vector<AuditMemory::Pair>> found_self(count), found_body(count);
  AuditBudget budget(mine.boxes.size() + others.boxes.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int c = 0; c < count; ++c) {
    const auto keep = [&](std::vector<AuditMemory::Pair>& list, AuditMemory::Pair pair) {
      pair.gap = std::max(0.0, pair.gap - rounding);
      if (pair.gap < memory.reach) list.push_back(pair);
    };
    pairs.visit(
        c, budget, [&](int a, int b) { keep(found_self[c], measured(mine, a, b)); },
        [&](int a, int b) {
          keep(found_body[c], {a, b, gap_of_triangles(mine.corners[a], others.corners[b]), 0});
        });
  }
  memory.self_pairs.clear();
  memory.body_pairs.clear();
  if (budget.exceeded()) return false;
  for (int c = 0; c < count; ++c) {
    memory.self_pairs.insert(memory.self_pairs.end(), found_self[c].begin(), found_self[c].end());
    memory.body_pairs.insert(memory.body_pairs.end(), found_body[c].begin(), found_body[c].end());
  }
  return true;
}

// Where there are many pairs, a shorter list is worth more than a large reach.
void shorten(AuditMemory& memory, double most) {
  while (static_cast<double>(memory.self_pairs.size() + memory.body_pairs.size()) > most) {
    memory.reach /= 2;
    for (auto* pairs : {&memory.self_pairs, &memory.body_pairs})
      if (std::erase_if(*pairs, [&](const AuditMemory::Pair& pair) { return pair.gap >= memory.reach; }) == 0) return;
  }
}

// Sets `moved`: how far each vertex is from the reference, at the farther end. False if one is farther than `most` or
// not finite.
bool within_budget(const Points& reference, const MovingBody& body, double most, Eigen::VectorXd& moved) {
  if (reference.rows() != body.x0->rows()) return false;
  moved = (*body.x0 - reference).rowwise().squaredNorm();
  if (body.x1 != body.x0) moved = moved.cwiseMax((*body.x1 - reference).rowwise().squaredNorm());
  moved = moved.cwiseSqrt() * (1 + 1e-14);
  return (moved.array() <= most).all();
}

double of_triangle(const Surface& surface, const Eigen::VectorXd& moved, int t) {
  const int* v = surface.triangles.data() + 3 * t;
  return std::max({moved[v[0]], moved[v[1]], moved[v[2]]});
}

// Collects the open pairs. False if the reference is too far away.
bool ask(const AuditMemory& memory, std::span<const MovingBody> sheets, AuditQuestions& questions) {
  if (memory.reference.size() != sheets.size()) return false;
  std::vector<Eigen::VectorXd> moved(sheets.size());
  for (std::size_t k = 0; k < sheets.size(); ++k)
    if (!within_budget(memory.reference[k], sheets[k], 0.5 * memory.reach, moved[k])) return false;
  questions = {false, {}, {}};
  const Surface& cloth = *sheets[0].surface;
  for (const AuditMemory::Pair& pair : memory.self_pairs)
    if (!(of_triangle(cloth, moved[0], pair.a) + of_triangle(cloth, moved[0], pair.b) < pair.gap))
      questions.self_pairs.push_back(pair);
  std::vector<double> of_bodies;
  for (std::size_t k = 1; k < sheets.size(); ++k)
    for (int t = 0; t < sheets[k].surface->triangles.rows(); ++t)
      of_bodies.push_back(of_triangle(*sheets[k].surface, moved[k], t));
  for (const AuditMemory::Pair& pair : memory.body_pairs)
    if (!(of_triangle(cloth, moved[0], pair.a) + of_bodies[pair.b] < pair.gap)) questions.body_pairs.push_back(pair);
  return true;
}

// Records this audit as the last one. True if it is of a motion.
bool record_audit(AuditMemory& memory, std::span<const MovingBody> sheets) {
  memory.moving = std::ranges::any_of(sheets, [](const MovingBody& sheet) { return sheet.x0 != sheet.x1; });
  memory.last.clear();
  for (const MovingBody& sheet : sheets) memory.last.push_back(*sheet.x1);
  return memory.moving;
}

// Whether little has moved since the last audit; then records this one. A state that follows a motion is at the
// motion's end, so that it keeps the motion's result.
bool is_slow(AuditMemory& memory, std::span<const MovingBody> sheets, double reach) {
  bool slowly = memory.last.size() == sheets.size();
  Eigen::VectorXd moved;
  for (std::size_t k = 0; k < sheets.size() && slowly; ++k)
    slowly = within_budget(memory.last[k], sheets[k], slow * reach, moved);
  const bool after_motion = memory.moving;
  if (record_audit(memory, sheets) || !after_motion) memory.slow = slowly;
  return memory.slow;
}

}  // namespace

double reach_of_rounding(const MovingBody& cloth, std::span<const MovingBody> bodies) {
  double most = largest({cloth.x1, 1});
  for (const MovingBody& body : bodies) most = std::max(most, largest({body.x1, 1}));
  return rounding_to_float * most;
}

bool is_at_end(const MotionEnd& end, const MovingBody& cloth, std::span<const MovingBody> bodies, bool self) {
  const auto is_there = [&](const Points& at, const Points& x) {
    return at.rows() == x.rows() && ((x - at).cwiseAbs().array() <= end.reach).all();
  };
  if (end.self != self || end.x.size() != bodies.size() + 1 || !is_there(end.x[0], *cloth.x1)) return false;
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (!is_there(end.x[k + 1], *bodies[k].x1)) return false;
  return true;
}

AuditQuestions open_questions(AuditMemory& memory, const MovingBody& cloth, std::span<const MovingBody> bodies,
                              bool self) {
  std::vector<MovingBody> sheets{cloth};
  sheets.insert(sheets.end(), bodies.begin(), bodies.end());
  AuditQuestions questions;
  if (ask(memory, sheets, questions)) {
    record_audit(memory, sheets);
    return questions;
  }
  const double edge = mean_edge(*cloth.surface, *cloth.x1);
  const double reach = std::min(most_reach * edge, memory.reach > 0 ? 2 * memory.reach : first_reach * edge);
  memory.reference.clear();
  if (!(reach > 0) || !is_slow(memory, sheets, reach)) return questions;  // 0: all cloth lies in one point
  memory.reference = memory.last;
  memory.reach = reach;
  memory.inside = -1;
  if (!measure(memory, *cloth.surface, bodies, self)) {
    memory.reference.clear();
    return questions;
  }
  shorten(memory, many * static_cast<double>(cloth.surface->triangles.rows()));
  ask(memory, sheets, questions);
  return questions;
}

}  // namespace selvedge
