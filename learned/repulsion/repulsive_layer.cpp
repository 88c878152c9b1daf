#include "learned/repulsion/repulsive_layer.hpp"

#include <cmath>

namespace selvedge {
namespace {

std::vector<PushedVertex> inside_vertices(const std::vector<SignedDistance>& found, std::span<const char> held) {
  std::vector<PushedVertex> pushed;
  for (int i = 0; i < static_cast<int>(found.size()); ++i) {
    const double length = found[i].gradient.norm();
    if (!(found[i].value < 0) || !(length > 0) || (!held.empty() && held[i])) continue;
    PushedVertex vertex;
    vertex.vertex = i;
    vertex.at = found[i];
    vertex.direction = found[i].gradient / length;
    pushed.push_back(vertex);
  }
  return pushed;
}

// Places of vertices in the list; -1: not in it.
std::vector<int> places_of(const std::vector<PushedVertex>& pushed, int count) {
  std::vector<int> place(static_cast<std::size_t>(count), -1);
  for (int i = 0; i < static_cast<int>(pushed.size()); ++i) place[pushed[i].vertex] = i;
  return place;
}

void set_scale(double alpha, double slope, double most_beyond, PushedVertex& vertex) {
  const double f = vertex.at.value;  // < 0
  vertex.bounded = (1 - alpha) * f > most_beyond;
  vertex.alpha = vertex.bounded ? 1 - most_beyond / f : alpha;
  vertex.slope = vertex.bounded ? most_beyond / (f * f) : slope;
}

// Deep inside a body the directions to nearest points differ widely. From the rim of the penetrating patch inward, each
// deep vertex takes the mean direction of those neighbours that are done. Vertices that reach no rim keep their own.
int turn_deep_ones(const Adjacency& ring, const std::vector<int>& place, double deep,
                   std::vector<PushedVertex>& pushed) {
  std::vector<char> known(pushed.size());
  std::vector<int> waiting;
  for (std::size_t i = 0; i < pushed.size(); ++i) {
    known[i] = pushed[i].at.value >= -deep;
    if (!known[i]) waiting.push_back(static_cast<int>(i));
  }
  const int count = static_cast<int>(waiting.size());
  for (std::size_t before = waiting.size() + 1; before != waiting.size();) {
    before = waiting.size();
    std::vector<std::pair<int, Vec3>> turned;
    for (const int i : waiting) {
      Vec3 sum = Vec3::Zero();
      for (const int next : ring.of(pushed[i].vertex))
        if (place[next] >= 0 && known[place[next]]) sum += pushed[place[next]].direction;
      if (sum.norm() > 1e-9) turned.emplace_back(i, sum.normalized());
    }
    for (const auto& [i, direction] : turned) {
      pushed[i].direction = direction;
      known[i] = true;
    }
    std::erase_if(waiting, [&](int i) { return known[i]; });
  }
  return count;
}

int count_torn(const Adjacency& ring, const std::vector<int>& place, const std::vector<PushedVertex>& pushed) {
  int torn = 0;
  for (const PushedVertex& vertex : pushed)
    for (const int next : ring.of(vertex.vertex))
      if (next > vertex.vertex && place[next] >= 0) torn += vertex.direction.dot(pushed[place[next]].direction) < 0;
  return torn;
}

// Projects the pushed vertices that are inside onto the nearest surface, if `move`, and returns their number.
int project(const std::vector<PushedVertex>& pushed, const AskDistance& ask, double margin, bool move, Points& x) {
  Points at(static_cast<Eigen::Index>(pushed.size()), 3);
  for (std::size_t i = 0; i < pushed.size(); ++i) at.row(static_cast<Eigen::Index>(i)) = x.row(pushed[i].vertex);
  std::vector<SignedDistance> found;
  ask(at, found);
  int count = 0;
  for (std::size_t i = 0; i < pushed.size(); ++i) {
    const double length = found[i].gradient.norm();
    if (!(found[i].value < 0) || !(length > 0)) continue;
    ++count;
    if (move) x.row(pushed[i].vertex) += ((margin - found[i].value) / length * found[i].gradient).transpose();
  }
  return count;
}

// Pushes vertices at least as far as the order of layers demands, and moves those over them. Returns all moved
// vertices.
std::vector<PushedVertex> keep_order(const std::vector<SignedDistance>& found, const RepulsionOptions& options,
                                     std::span<const char> held, Repelled& result, const Points& x) {
  std::vector<PushedVertex> moved = result.pushed;
  if (!(options.order.reach > 0)) return moved;
  std::vector<SignedDistance> free = found;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i]) free[i].value = options.order.reach;
  const std::vector<double> heights = ordered_heights(free, options.margin, options.order);
  for (const PushedVertex& p : result.pushed) {
    const double length = heights[p.vertex] - p.at.value;
    if (length > options.margin - p.alpha * p.at.value)
      result.x.row(p.vertex) = x.row(p.vertex) + (length * p.direction).transpose();
  }
  for (int i = 0; i < static_cast<int>(found.size()); ++i) {
    if (!(found[i].value >= 0) || !(heights[i] > found[i].value) || (!held.empty() && held[i])) continue;
    result.x.row(i) += ((heights[i] - found[i].value) * found[i].gradient).transpose();
    moved.emplace_back().vertex = i;
    ++result.carried;
  }
  return moved;
}

}  // namespace

PushedOnes pushed_ones(std::span<const PushedVertex> pushed) {
  PushedOnes ones;
  for (const PushedVertex& vertex : pushed) {
    ones.vertices.push_back(vertex.vertex);
    ones.distances.push_back(vertex.at.value);
  }
  return ones;
}

Scales constant_scale(std::span<const int> vertices, double alpha) {
  return {std::vector<double>(vertices.size(), alpha), std::vector<double>(vertices.size(), 0)};
}

Repelled repel(const Points& x, const Adjacency& ring, const AskDistance& ask, const AskScale& scale,
               const RepulsionOptions& options, std::span<const char> held) {
  Repelled result;
  result.x = x;
  std::vector<SignedDistance> found;
  ask(x, found);
  result.pushed = inside_vertices(found, held);
  if (result.pushed.empty()) return result;

  const PushedOnes ones = pushed_ones(result.pushed);
  const Scales scales = scale(ones.vertices, ones.distances);
  const std::vector<int> place = places_of(result.pushed, static_cast<int>(x.rows()));
  result.deep = turn_deep_ones(ring, place, options.deep, result.pushed);
  result.torn = count_torn(ring, place, result.pushed);
  for (std::size_t i = 0; i < result.pushed.size(); ++i) {
    PushedVertex& vertex = result.pushed[i];
    set_scale(scales.alpha[i], scales.slope[i], options.most_beyond, vertex);
    result.x.row(vertex.vertex) += ((options.margin - vertex.alpha * vertex.at.value) * vertex.direction).transpose();
  }
  const std::vector<PushedVertex> moved = keep_order(found, options, held, result, x);
  for (int round = 0; round < options.recheck; ++round) {
    const int count = project(moved, ask, std::ldexp(options.margin, -round), true, result.x);
    result.projected += count;
    if (count == 0) return result;
  }
  if (options.recheck > 0) result.inside = project(moved, ask, 0, false, result.x);
  return result;
}

Mat3 full_jacobian(const SignedDistance& at, double alpha, double slope) {
  const Vec3 n = at.gradient.normalized();
  Mat3 closest = Mat3::Zero();
  if (at.place == SurfacePlace::face) closest = Mat3::Identity() - n * n.transpose();
  if (at.place == SurfacePlace::edge) closest = at.along * at.along.transpose();
  return Mat3::Identity() - alpha * (Mat3::Identity() - closest) - at.value * slope * n * n.transpose();
}

Mat3 frozen_jacobian(const SignedDistance& at, double alpha, double slope) {
  const Vec3 n = at.gradient.normalized();
  return Mat3::Identity() - (alpha + at.value * slope) * n * n.transpose();
}

}  // namespace selvedge
