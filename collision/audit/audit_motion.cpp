#include "collision/audit/audit_motion.hpp"

#include <algorithm>

#include "collision/audit/audit_memory.hpp"
#include "collision/audit/bisection.hpp"
#include "collision/audit/moving_pair.hpp"
#include "collision/audit/proof_budget.hpp"
#include "collision/geometry/floating_point.hpp"

namespace selvedge {
namespace {

// Triangles of the cloth or of the bodies, with their numbers; only those with finite corners.
struct Side {
  struct Face {
    const MovingBody* body;
    int triangle, first_node;
    int number;  // as in AuditMemory::Pair

    const Surface& surface() const { return *body->surface; }
  };
  std::vector<Face> faces;
  std::vector<ExactBox> start, end, boxes;  // at the start, at the end, and round both
};

// Is one of the faces above the other along an axis, at both ends and so all the way? This separates faces that move
// along together, without rounding, however far they move.
bool stay_apart_along_an_axis(const Side& a, int i, const Side& b, int j) {
  const ExactBox &a0 = a.start[i], &a1 = a.end[i], &b0 = b.start[j], &b1 = b.end[j];
  bool apart = false;
  for (int k = 0; k < 3; ++k)
    apart |= ((a0.hi[k] < b0.lo[k]) & (a1.hi[k] < b1.lo[k])) | ((b0.hi[k] < a0.lo[k]) & (b1.hi[k] < a1.lo[k]));
  return apart;
}

// May two faces be within `reach` of each other at the end?
bool meet_at_end(const ExactBox& a, const ExactBox& b, double reach) {
  bool meet = true;
  for (int k = 0; k < 3; ++k) meet &= (a.lo[k] <= b.hi[k] + 2 * reach) & (b.lo[k] <= a.hi[k] + 2 * reach);
  return meet;
}

ExactBox grown(ExactBox box, double margin) {
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= margin;
    box.hi[k] += margin;
  }
  return box;
}

// Adds the faces whose boxes, grown by the margin, overlap the bounds. Returns the number of vertices that are not
// finite.
int add(const MovingBody& body, int first_node, int first_number, double margin, const ExactBox& bounds, Side& side) {
  const Surface& s = *body.surface;
  std::vector<char> good(s.vertex_count);
  for (int v = 0; v < s.vertex_count; ++v) good[v] = body.x0->row(v).allFinite() && body.x1->row(v).allFinite();
  for (int t = 0; t < s.triangles.rows(); ++t) {
    if (!good[s.triangles(t, 0)] || !good[s.triangles(t, 1)] || !good[s.triangles(t, 2)]) continue;
    const Side::Face face{&body, t, first_node, first_number + t};
    const ExactBox start = box_of(s, *body.x0, t), end = box_of(s, *body.x1, t),
                   both = grown(hull_of(std::array{start, end}), margin);
    if (!overlap(both, bounds)) continue;
    side.faces.push_back(face);
    side.start.push_back(start);
    side.end.push_back(end);
    side.boxes.push_back(both);
  }
  return static_cast<int>(std::count(good.begin(), good.end(), 0));
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
  Proof proof(int max_halvings, int parts) const {
    const MovingPoints<4> points = relative_to(nodes[0], nodes);
    return edges ? proof_for_edges(points, max_halvings, parts)
                 : proof_for_vertex_and_face(points, max_halvings, parts);
  }
};

// What was found in one cell, or in all of them.
struct Found {
  std::vector<PassedPair> passed;
  std::vector<FeaturePair> open;                              // not decided by few_parts
  std::vector<std::pair<int, int>> self_at_end, body_at_end;  // within reach at the end
};

struct Asked {
  const LeftOut& left_out;
  int max_halvings;
};

struct PairAudit {
  const Side::Face &a, &b;
  const Asked& asked;
  ProofWatch& watch;
  Found& found;

  bool same(int i, int j) const { return corner(a, i).number() == corner(b, j).number(); }

  void take(bool edges, const std::array<Node, 4>& nodes) const {
    if (watch.ended()) return;
    const FeaturePair pair{edges, nodes};
    if (asked.left_out && asked.left_out(pair.numbered().nodes)) return;
    const Proof proof = pair.proof(asked.max_halvings, few_parts);
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

  bool triangles_stay_apart() const {
    int shared = 0, at_a = 0, at_b = 0;
    for (int i = 0; i < 3; ++i)
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
                               relative_to<2>(origin, {corner(b, at_b + 1), corner(b, at_b + 2)}));
    return stay_apart(relative_to<3>(origin, {corner(a, 0), corner(a, 1), corner(a, 2)}),
                      relative_to<3>(origin, {corner(b, 0), corner(b, 1), corner(b, 2)}));
  }

  // Every vertex and edge is tested with the one face that owns it, so that each pair is tested once.
  void operator()() const {
    if (watch.given_up() || triangles_stay_apart()) return;
    vertices(a, b);
    vertices(b, a);
    edges();
  }
};

// reach: as in MotionEnd.
void audit_cell(const Cell& cell, const Side& cloth, const Side& bodies, bool self, const Asked& asked, double reach,
                AuditBudget& budget, ProofBudget& proofs, Found& found) {
  ProofWatch watch(budget, proofs);
  visit_pairs(
      cell, cloth.boxes, bodies.boxes, self, budget,
      [&](int a, int b) {
        const auto [first, second] = std::minmax(a, b);
        if (meet_at_end(cloth.end[a], cloth.end[b], reach))
          found.self_at_end.emplace_back(cloth.faces[first].number, cloth.faces[second].number);
        if (stay_apart_along_an_axis(cloth, a, cloth, b)) return;
        PairAudit{cloth.faces[first], cloth.faces[second], asked, watch, found}();
      },
      [&](int a, int c) {
        if (meet_at_end(cloth.end[a], bodies.end[c], reach))
          found.body_at_end.emplace_back(cloth.faces[a].number, bodies.faces[c].number);
        if (stay_apart_along_an_axis(cloth, a, bodies, c)) return;
        PairAudit{cloth.faces[a], bodies.faces[c], asked, watch, found}();
      });
}

MotionEnd end_of(const MovingBody& cloth, std::span<const MovingBody> bodies, bool self, double reach, Found&& found) {
  MotionEnd end{{*cloth.x1}, reach, self, std::move(found.self_at_end), std::move(found.body_at_end)};
  for (const MovingBody& body : bodies) end.x.push_back(*body.x1);
  return end;
}

// Tests the pairs that the memory leaves open. All coordinates are finite.
Found found_among(const AuditQuestions& questions, const MovingBody& cloth, std::span<const MovingBody> bodies,
                  const Asked& asked, AuditBudget& budget, ProofBudget& proofs) {
  Found found;
  ProofWatch watch(budget, proofs);
  const auto face = [](const MovingBody& body, int t, int first_node) { return Side::Face{&body, t, first_node, t}; };
  for (const AuditMemory::Pair& pair : questions.self_pairs) {
    const Side::Face a = face(cloth, std::min(pair.a, pair.b), 0), b = face(cloth, std::max(pair.a, pair.b), 0);
    PairAudit{a, b, asked, watch, found}();
  }
  for (const AuditMemory::Pair& pair : questions.body_pairs) {
    const MovingBody* body = bodies.data();
    int t = pair.b, first_node = cloth.surface->vertex_count;
    for (; t >= body->surface->triangles.rows(); ++body) {
      t -= static_cast<int>(body->surface->triangles.rows());
      first_node += body->surface->vertex_count;
    }
    const Side::Face a = face(cloth, pair.a, 0), b = face(*body, t, first_node);
    PairAudit{a, b, asked, watch, found}();
  }
  return found;
}

// Pairs that few_parts did not decide get equal shares of the budget. A pair that is still open counts as passed if its
// share was the most that any pair may have, and else as given up.
void decide(const std::vector<FeaturePair>& open, int max_halvings, AuditBudget& budget, MotionAudit& result) {
  const int share = ProofBudget::share(open.size()), count = static_cast<int>(open.size());
  std::vector<Proof> decided(open.size(), Proof::open);
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < count; ++i)
    if (budget.add(0)) decided[i] = open[i].proof(max_halvings, share);
  for (int i = 0; i < count; ++i)
    if (decided[i] == Proof::meets || (decided[i] == Proof::open && share == most_parts))
      result.passed.push_back(open[i].numbered());
    else
      result.given_up += decided[i] == Proof::open;
}

void conclude(Found& found, int max_halvings, AuditBudget& budget, const ProofBudget& proofs, MotionAudit& result) {
  budget.check();
  if (proofs.exceeded()) {
    result.given_up = ProofBudget::most_unproven;
    result.whole = false;
    return;
  }
  result.passed = std::move(found.passed);
  decide(found.open, max_halvings, budget, result);
  budget.check();
  std::sort(result.passed.begin(), result.passed.end());
}

}  // namespace

MotionAudit audit_motion(const Surface& cloth, const Points& x0, const Points& x1, std::span<const MovingBody> bodies,
                         bool self, AuditMemory* memory, const LeftOut& left_out, int max_halvings) {
  restore_standard_arithmetic();
  const MovingBody moving{&cloth, &x0, &x1};
  const Asked asked{left_out, max_halvings};
  ProofBudget proofs;
  MotionAudit result;
  if (memory) {
    memory->end = {};
    const AuditQuestions questions = open_questions(*memory, moving, bodies, self);
    if (!questions.all) {
      AuditBudget budget(cloth.triangles.rows());
      Found found = found_among(questions, moving, bodies, asked, budget, proofs);
      conclude(found, max_halvings, budget, proofs, result);
      return result;
    }
  }
  const double reach = memory ? reach_of_rounding(moving, bodies) : 0;
  Side mine, others;
  result.nonfinite = add(moving, 0, 0, reach, everywhere, mine);
  const ExactBox round_cloth = hull_of(mine.boxes);
  int first_node = cloth.vertex_count, first_number = 0;
  for (const MovingBody& body : bodies) {
    result.nonfinite += add(body, first_node, first_number, reach, round_cloth, others);
    first_node += body.surface->vertex_count;
    first_number += static_cast<int>(body.surface->triangles.rows());
  }
  const std::vector<Cell> cells = bisect(mine.boxes, others.boxes, self);
  const int count = static_cast<int>(cells.size());
  std::vector<Found> parts(cells.size());
  AuditBudget budget(mine.boxes.size() + others.boxes.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int r = 0; r < count; ++r) audit_cell(cells[r], mine, others, self, asked, reach, budget, proofs, parts[r]);
  Found found = joined(parts, &Found::passed, &Found::open, &Found::self_at_end, &Found::body_at_end);
  conclude(found, max_halvings, budget, proofs, result);
  // A face that was left out as not finite may be finite at the end; then the list would lack its pairs.
  if (memory && result.nonfinite == 0) memory->end = end_of(moving, bodies, self, reach, std::move(found));
  return result;
}

}  // namespace selvedge
