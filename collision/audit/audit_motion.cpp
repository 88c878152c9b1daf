#include "collision/audit/audit_motion.hpp"

#include <algorithm>

#include "collision/audit/audit_memory.hpp"
#include "collision/audit/box_pairs.hpp"
#include "collision/audit/moving_pair.hpp"
#include "collision/audit/proof_budget.hpp"
#include "collision/audit/stars.hpp"
#include "collision/geometry/floating_point.hpp"

namespace selvedge {
namespace {

constexpr int most_halvings = 30;  // of the time of a pair

// Triangles of the cloth or of the bodies, with their numbers; only those with finite corners.
struct Side {
  struct Face {
    const MovingBody* body;
    int triangle, first_node;
    int number;                 // as in AuditMemory::Pair
    std::array<int, 3> corner;  // the nodes

    const Surface& surface() const { return *body->surface; }
  };
  std::vector<Face> faces;
  std::vector<ExactBox> start, end, boxes;  // at the start, within reach of the end, and round all of the motion

  void reserve(std::size_t count) {
    faces.reserve(count);
    for (std::vector<ExactBox>* list : {&start, &end, &boxes}) list->reserve(count);
  }
};

Side::Face face_of(const MovingBody& body, int triangle, int first_node, int number) {
  const int* v = body.surface->triangles.data() + 3 * triangle;
  return {&body, triangle, first_node, number, {first_node + v[0], first_node + v[1], first_node + v[2]}};
}

// Is one of the faces above the other along an axis, at both ends and so all the way? This separates faces that move
// along together, without rounding, however far they move.
bool stay_apart_along_an_axis(const Side& a, int i, const Side& b, int j) {
  const ExactBox &a0 = a.start[i], &a1 = a.end[i], &b0 = b.start[j], &b1 = b.end[j];
  bool apart = false;
  for (int k = 0; k < 3; ++k)
    apart |= ((a0.hi[k] < b0.lo[k]) & (a1.hi[k] < b1.lo[k])) | ((b0.hi[k] < a0.lo[k]) & (b1.hi[k] < a1.lo[k]));
  return apart;
}

ExactBox grown(ExactBox box, double margin) {
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= margin;
    box.hi[k] += margin;
  }
  return box;
}

// On which sides of the bounds a vertex, with a margin round it, lies at the start and at the end: one bit for each.
unsigned sides_outside(const MovingBody& body, int v, double margin, const ExactBox& bounds) {
  const double *from = body.x0->data() + 3 * v, *to = body.x1->data() + 3 * v;
  unsigned sides = 0;
  for (int k = 0; k < 3; ++k) {
    sides |= static_cast<unsigned>((from[k] - margin > bounds.hi[k]) & (to[k] - margin > bounds.hi[k])) << k;
    sides |= static_cast<unsigned>((from[k] + margin < bounds.lo[k]) & (to[k] + margin < bounds.lo[k])) << (3 + k);
  }
  return sides;
}

// Adds the faces whose boxes, grown by the margin, overlap the bounds. Returns the number of vertices that are not
// finite.
int add(const MovingBody& body, int first_node, int first_number, double margin, const ExactBox& bounds, Side& side) {
  constexpr unsigned bad = 1U << 6;
  const Surface& s = *body.surface;
  std::vector<unsigned> outside(static_cast<std::size_t>(s.vertex_count));
  int nonfinite = 0;
  for (int v = 0; v < s.vertex_count; ++v) {
    const bool good = body.x0->row(v).allFinite() && body.x1->row(v).allFinite();
    outside[v] = good ? sides_outside(body, v, margin, bounds) : bad;
    nonfinite += !good;
  }
  side.reserve(side.faces.size() + static_cast<std::size_t>(s.triangles.rows()));
  for (int t = 0; t < s.triangles.rows(); ++t) {
    const unsigned a = outside[s.triangles(t, 0)], b = outside[s.triangles(t, 1)], c = outside[s.triangles(t, 2)];
    if ((a & b & c) != 0 || ((a | b | c) & bad) != 0) continue;
    const ExactBox start = box_of(s, *body.x0, t), end = box_of(s, *body.x1, t);
    side.faces.push_back(face_of(body, t, first_node, first_number + t));
    side.start.push_back(start);
    side.end.push_back(grown(end, margin));
    side.boxes.push_back(grown(hull_of(std::array{start, end}), margin));
  }
  return nonfinite;
}

struct Node {
  const MovingBody* body;
  int vertex, first_node;

  int number() const { return first_node + vertex; }
  Vec3 start() const { return row(*body->x0, vertex); }
  Vec3 end() const { return row(*body->x1, vertex); }
};

Node corner(const Side::Face& face, int k) {
  return {face.body, face.surface().triangles(face.triangle, k % 3), face.first_node};
}

template <std::size_t Count>
MovingPoints<Count> relative_to(const Node& origin, const std::array<Node, Count>& nodes) {
  MovingPoints<Count> points;
  const Vec3 start = origin.start(), end = origin.end();
  for (std::size_t i = 0; i < Count; ++i) {
    points.start[i] = nodes[i].start() - start;
    points.end[i] = nodes[i].end() - end;
  }
  return points;
}

// A vertex and a face, or two edges.
struct FeaturePair {
  bool edges;
  std::array<Node, 4> nodes;

  PassedPair numbered() const {
    return {edges, {nodes[0].number(), nodes[1].number(), nodes[2].number(), nodes[3].number()}};
  }
  Proof proof(int parts) const {
    const MovingPoints<4> points = relative_to(nodes[0], nodes);
    return edges ? proof_for_edges(points, most_halvings, parts)
                 : proof_for_vertex_and_face(points, most_halvings, parts);
  }
};

// What was found in a part of the search, or in all of it.
struct Found {
  std::vector<PassedPair> passed;
  std::vector<FeaturePair> open;                              // not decided by few_parts
  std::vector<std::pair<int, int>> self_at_end, body_at_end;  // as in MotionEnd
};

struct PairAudit {
  const Side::Face &a, &b;
  const LeftOut& left_out;
  ProofWatch& watch;
  Found& found;

  bool same(int i, int j) const { return a.corner[i % 3] == b.corner[j % 3]; }

  void take(bool edges, const std::array<Node, 4>& nodes) const {
    if (watch.ended()) return;
    const FeaturePair pair{edges, nodes};
    if (left_out && left_out(pair.numbered().nodes)) return;
    const Proof proof = pair.proof(few_parts);
    if (proof == Proof::apart) return;
    watch.add_unproven();
    if (proof == Proof::meets) found.passed.push_back(pair.numbered());
    if (proof == Proof::open) found.open.push_back(pair);
  }

  // Tests the vertices that the face p owns against the face f.
  void vertices(const Side::Face& p, const Side::Face& f) const {
    for (int k = 0; k < 3; ++k) {
      const Node v = corner(p, k);
      if (p.surface().vertex_owner[v.vertex] != p.triangle) continue;
      const std::array<Node, 4> nodes{v, corner(f, 0), corner(f, 1), corner(f, 2)};
      if (std::none_of(nodes.begin() + 1, nodes.end(), [&](const Node& n) { return n.number() == v.number(); }))
        take(false, nodes);
    }
  }

  void edges() const {
    for (int i = 0; i < 3; ++i) {
      if (a.surface().edge_owner[a.surface().triangle_edges(a.triangle, i)] != a.triangle) continue;
      for (int j = 0; j < 3; ++j) {
        if (b.surface().edge_owner[b.surface().triangle_edges(b.triangle, j)] != b.triangle) continue;
        if (same(i, j) || same(i, (j + 1) % 3) || same((i + 1) % 3, j) || same((i + 1) % 3, (j + 1) % 3)) continue;
        take(true, {corner(a, i), corner(a, i + 1), corner(b, j), corner(b, j + 1)});
      }
    }
  }

  // Both ends of the edge that the faces share, then the corners opposite.
  MovingPoints<4> at_common_edge() const {
    std::array<int, 2> alone{};  // the corner of each face that the other does not have
    for (int k = 0; k < 3; ++k) {
      if (!same(k, 0) && !same(k, 1) && !same(k, 2)) alone[0] = k;
      if (!same(0, k) && !same(1, k) && !same(2, k)) alone[1] = k;
    }
    const Node s = corner(a, alone[0] + 1);
    return relative_to<4>(s, {s, corner(a, alone[0] + 2), corner(a, alone[0]), corner(b, alone[1])});
  }

  // Do they belong to a star that is clean?
  bool in_a_star(const std::vector<char>& clean) const {
    for (int i = 0; i < 3; ++i)
      if (clean[a.corner[i]] && (same(i, 0) || same(i, 1) || same(i, 2))) return true;
    return false;
  }

  // Also where each coordinate is off by up to `room`, unless they share an edge.
  bool triangles_stay_apart(double room) const {
    int shared = 0, at_a = 0, at_b = 0;
    for (int i = 0; i < 3 && a.body == b.body; ++i)
      for (int j = 0; j < 3; ++j)
        if (same(i, j)) {
          ++shared;
          at_a = i;
          at_b = j;
        }
    if (shared > 2) return false;
    if (shared == 2) return stay_apart_at_edge(at_common_edge());
    const Node origin = corner(a, at_a);
    if (shared == 1)
      return stay_apart_beside(relative_to<2>(origin, {corner(a, at_a + 1), corner(a, at_a + 2)}),
                               relative_to<2>(origin, {corner(b, at_b + 1), corner(b, at_b + 2)}), room);
    return stay_apart(relative_to<3>(origin, {corner(a, 0), corner(a, 1), corner(a, 2)}),
                      relative_to<3>(origin, {corner(b, 0), corner(b, 1), corner(b, 2)}), room);
  }

  // Every vertex and edge is tested with the one face that owns it, so that each pair is tested once.
  void features() const {
    vertices(a, b);
    vertices(b, a);
    edges();
  }
};

// The faces of a motion, and what is known of them. reach: as in MotionEnd.
struct MovingFaces {
  Side cloth, bodies;
  std::vector<char> clean;  // of each vertex of the cloth: clean_stars
  double reach;
};

// Audits the motion of a face of the cloth and one of `other`. Lists the pair at the end unless it is proven apart
// there.
void audit_pair(const MovingFaces& faces, const Side& other, int i, int j, const PairAudit& pair,
                std::vector<std::pair<int, int>>& at_end) {
  if (stay_apart_along_an_axis(faces.cloth, i, other, j)) return;
  if (!pair.watch.given_up() && pair.triangles_stay_apart(faces.reach)) return;
  if (overlap(faces.cloth.end[i], other.end[j])) at_end.emplace_back(pair.a.number, pair.b.number);
  if (pair.watch.given_up() || (faces.reach > 0 && pair.triangles_stay_apart(0))) return;
  pair.features();
}

void audit_part(const BoxPairs& pairs, int part, const MovingFaces& faces, const LeftOut& left_out, AuditBudget& budget,
                ProofBudget& proofs, Found& found) {
  ProofWatch watch(budget, proofs);
  pairs.visit(
      part, budget,
      [&](int a, int b) {
        const auto [i, j] = std::minmax(a, b);
        const PairAudit pair{faces.cloth.faces[i], faces.cloth.faces[j], left_out, watch, found};
        if (!pair.in_a_star(faces.clean)) audit_pair(faces, faces.cloth, i, j, pair, found.self_at_end);
      },
      [&](int a, int c) {
        const PairAudit pair{faces.cloth.faces[a], faces.bodies.faces[c], left_out, watch, found};
        audit_pair(faces, faces.bodies, a, c, pair, found.body_at_end);
      });
}

MotionEnd end_of(const MovingBody& cloth, std::span<const MovingBody> bodies, bool self, double reach, Found&& found) {
  MotionEnd end{{*cloth.x1}, reach, self, std::move(found.self_at_end), std::move(found.body_at_end)};
  for (const MovingBody& body : bodies) end.x.push_back(*body.x1);
  return end;
}

// Tests the pairs that the memory leaves open. All coordinates are finite.
Found found_among(const AuditQuestions& questions, const MovingBody& cloth, std::span<const MovingBody> bodies,
                  const LeftOut& left_out, AuditBudget& budget, ProofBudget& proofs) {
  Found found;
  ProofWatch watch(budget, proofs);
  const auto look_at = [&](const Side::Face& a, const Side::Face& b) {
    const PairAudit pair{a, b, left_out, watch, found};
    if (!watch.given_up() && !pair.triangles_stay_apart(0)) pair.features();
  };
  for (const AuditMemory::Pair& pair : questions.self_pairs) {
    const auto [a, b] = std::minmax(pair.a, pair.b);
    look_at(face_of(cloth, a, 0, a), face_of(cloth, b, 0, b));
  }
  for (const AuditMemory::Pair& pair : questions.body_pairs) {
    const MovingBody* body = bodies.data();
    int t = pair.b, first_node = cloth.surface->vertex_count;
    for (; t >= body->surface->triangles.rows(); ++body) {
      t -= static_cast<int>(body->surface->triangles.rows());
      first_node += body->surface->vertex_count;
    }
    look_at(face_of(cloth, pair.a, 0, pair.a), face_of(*body, t, first_node, pair.b));
  }
  return found;
}

// Pairs that few_parts did not decide get equal shares of the budget. A pair that is still open counts as passed if its
// share was the most that any pair may have, and else as given up.
void decide(const std::vector<FeaturePair>& open, AuditBudget& budget, MotionAudit& result) {
  const int share = ProofBudget::share(open.size()), count = static_cast<int>(open.size());
  std::vector<Proof> decided(open.size(), Proof::open);
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < count; ++i)
    if (budget.add(0)) decided[i] = open[i].proof(share);
  for (int i = 0; i < count; ++i)
    if (decided[i] == Proof::meets || (decided[i] == Proof::open && share == most_parts))
      result.passed.push_back(open[i].numbered());
    else
      result.given_up += decided[i] == Proof::open;
}

void conclude(Found& found, AuditBudget& budget, const ProofBudget& proofs, MotionAudit& result) {
  budget.check();
  if (proofs.exceeded()) {
    result.given_up = ProofBudget::most_unproven;
    result.whole = false;
    return;
  }
  result.passed = std::move(found.passed);
  decide(found.open, budget, result);
  budget.check();
  std::sort(result.passed.begin(), result.passed.end());
}

}  // namespace

MotionAudit audit_motion(const Surface& cloth, const Points& x0, const Points& x1, std::span<const MovingBody> bodies,
                         bool self, AuditMemory* memory, const LeftOut& left_out) {
  restore_standard_arithmetic();
  const MovingBody moving{&cloth, &x0, &x1};
  ProofBudget proofs;
  MotionAudit result;
  if (memory) {
    memory->end = {};
    const AuditQuestions questions = open_questions(*memory, moving, bodies, self);
    if (!questions.all) {
      AuditBudget budget(cloth.triangles.rows());
      Found found = found_among(questions, moving, bodies, left_out, budget, proofs);
      conclude(found, budget, proofs, result);
      return result;
    }
  }
  const double reach = memory ? reach_of_rounding(moving, bodies) : 0;
  MovingFaces faces{{}, {}, self ? clean_stars(moving, reach) : std::vector<char>(), reach};
  result.nonfinite = add(moving, 0, 0, reach, everywhere, faces.cloth);
  const ExactBox round_cloth = hull_of(faces.cloth.boxes);
  int first_node = cloth.vertex_count, first_number = 0;
  for (const MovingBody& body : bodies) {
    result.nonfinite += add(body, first_node, first_number, reach, round_cloth, faces.bodies);
    first_node += body.surface->vertex_count;
    first_number += static_cast<int>(body.surface->triangles.rows());
  }
  const BoxPairs pairs(faces.cloth.boxes, faces.bodies.boxes, self);
  const int count = pairs.parts();
  std::vector<Found> parts(static_cast<std::size_t>(count));
  AuditBudget budget(faces.cloth.boxes.size() + faces.bodies.boxes.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int r = 0; r < count; ++r) audit_part(pairs, r, faces, left_out, budget, proofs, parts[r]);
  Found found = joined(parts, &Found::passed, &Found::open, &Found::self_at_end, &Found::body_at_end);
  conclude(found, budget, proofs, result);
  // A face that was left out as not finite may be finite at the end; then the list would lack its pairs.
  if (memory && result.nonfinite == 0) memory->end = end_of(moving, bodies, self, reach, std::move(found));
  return result;
}

}  // namespace selvedge
