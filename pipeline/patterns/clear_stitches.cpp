#include "pipeline/patterns/clear_stitches.hpp"

#include <algorithm>

#include "collision/audit/audit.hpp"
#include "collision/distance/signed_distance.hpp"
#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {
namespace {

constexpr double on_each_other = 1e-7;    // vertices nearer than this lie at one place [m]
constexpr double passing = 0.01;          // distance from the body at which a stitch passes it [m]
constexpr double deepest_grazing = 0.02;  // a deeper stitch cannot be freed by moving its panels [m]
constexpr int points_a_stitch = 21, most_moves = 6;

class Placing {
 public:
  Placing(const PatternMesh& mesh, const Points& body, const Triangles& triangles)
      : mesh_(mesh),
        body_(make_surface(static_cast<int>(body.rows()), triangles)),
        cloth_(make_surface(static_cast<int>(mesh.placed.rows()), mesh.triangles)),
        body_x_(body),
        field_(body_),
        together_(1 + *std::ranges::max_element(mesh.panel)) {
    field_.move_to(body);
    for (const auto& [a, b] : mesh.sewn)
      if ((mesh.placed.row(a) - mesh.placed.row(b)).norm() < on_each_other) together_.join(panel(a), panel(b));
    numbers_ = together_.numbers();
  }

  Points placed() {
    Points x = mesh_.placed;
    std::vector<SignedDistance> deepest = depths(x);
    for (std::size_t first = 0; first < mesh_.sewn.size();) {
      std::size_t end = first;
      while (end < mesh_.sewn.size() && mesh_.seam[end] == mesh_.seam[first]) ++end;
      const SignedDistance& most = deepest_of(deepest, first, end);
      if (most.value < 0 && most.value > -deepest_grazing) {
        Points moved = freed(x, first, end);
        std::vector<SignedDistance> then = depths(moved);
        if (deepest_of(then, first, end).value >= 0 && none_deeper(deepest, then) && is_free(x, moved)) {
          x = std::move(moved);
          deepest = std::move(then);
        }
      }
      first = end;
    }
    return x;
  }

 private:
  int panel(int vertex) const { return mesh_.panel[vertex]; }

  // For each stitch the deepest point of its straight line in the body, or the nearest to it.
  std::vector<SignedDistance> depths(const Points& x) const {
    const Eigen::Index count = static_cast<Eigen::Index>(mesh_.sewn.size());
    Points at(count * points_a_stitch, 3);
    for (Eigen::Index s = 0; s < count; ++s)
      for (int k = 0; k < points_a_stitch; ++k) {
        const double t = 1.0 * k / (points_a_stitch - 1);
        const auto& [a, b] = mesh_.sewn[s];
        at.row(s * points_a_stitch + k) = (1 - t) * x.row(a) + t * x.row(b);
      }
    const std::vector<SignedDistance> all = field_.ask(at);
    std::vector<SignedDistance> deepest;
    for (auto begin = all.begin(); begin != all.end(); begin += points_a_stitch)
      deepest.push_back(*std::min_element(begin, begin + points_a_stitch, is_deeper));
    return deepest;
  }

  static bool is_deeper(const SignedDistance& a, const SignedDistance& b) { return a.value < b.value; }
  static const SignedDistance& deepest_of(const std::vector<SignedDistance>& depths, std::size_t first,
                                          std::size_t end) {
    const auto begin = depths.begin();
    return *std::min_element(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(end),
                             is_deeper);
  }

  static bool none_deeper(const std::vector<SignedDistance>& before, const std::vector<SignedDistance>& after) {
    for (std::size_t s = 0; s < before.size(); ++s)
      if (after[s].value < std::min(0.0, before[s].value - 1e-6)) return false;
    return true;
  }

  // Positions with the panels of that seam moved out of the body, in the direction in which its deepest stitch leaves
  // soonest.
  Points freed(Points x, std::size_t first, std::size_t end) const {
    const auto group = [&](int vertex) { return numbers_[panel(vertex)]; };
    const int one = group(mesh_.sewn[first][0]), other = group(mesh_.sewn[first][1]);
    for (int move = 0; move < most_moves; ++move) {
      const std::vector<SignedDistance> now = depths(x);
      const SignedDistance& most = deepest_of(now, first, end);
      if (most.value >= passing) break;
      for (int v = 0; v < x.rows(); ++v)
        if (group(v) == one || group(v) == other) x.row(v) += (passing - most.value) * most.gradient.transpose();
    }
    return x;
  }

  // Whether the moved vertices are neither inside the body nor inside other panels.
  bool is_free(const Points& before, const Points& after) const {
    const std::vector<AuditBody> bodies{{&body_, &body_x_}};
    const Audit was = audit(cloth_, before, bodies), is = audit(cloth_, after, bodies);
    return is.self_pairs.size() <= was.self_pairs.size() && is.obstacle_pairs.size() <= was.obstacle_pairs.size() &&
           is.inside_vertices <= was.inside_vertices;
  }

  const PatternMesh& mesh_;
  Surface body_, cloth_;
  const Points& body_x_;
  DistanceField field_;
  DisjointSets together_;
  std::vector<int> numbers_;
};

}  // namespace

Points clear_of(const PatternMesh& mesh, const Points& body, const Triangles& body_triangles) {
  return Placing(mesh, body, body_triangles).placed();
}

}  // namespace selvedge
