#include "collision/contact/pins_apart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "collision/geometry/box.hpp"

namespace selvedge {
namespace {

constexpr double separations = 2;   // that two pins keep
constexpr int sliding_rounds = 20;  // then pins stay at their start
constexpr double slight = 1e-6;     // of the distance that two pins keep: as much less is none

struct PinPair {
  int a = 0, b = 0;
  double kept = 0;  // [m]
};

double kept_distance(const ContactWorld& world, const ResolveOptions& options, int a, int b, double now) {
  const bool one_cloth = world.rest && world.cloth->component[a] == world.cloth->component[b];
  const double at_rest =
      one_cloth ? (row(*world.rest, a) - row(*world.rest, b)).norm() : std::numeric_limits<double>::infinity();
  return std::min(
      {separations * options.separation, separations * options.separation / options.thickness * at_rest, now});
}

// Pins of different patches whose motions come near each other.
std::vector<PinPair> near_pairs(const ContactWorld& world, std::span<const int> pins, DisjointSets& patches,
                                const ResolveOptions& options, const Points& x0, const Points& x1) {
  struct PinBox {
    Box box;
    int pin;
  };
  std::vector<PinBox> boxes;
  for (const int pin : pins)
    boxes.push_back({moving_point_box(row(x0, pin), row(x1, pin), separations * options.separation), pin});
  std::ranges::sort(boxes, {}, [](const PinBox& one) { return std::pair(one.box.lo[0], one.pin); });
  std::vector<PinPair> pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t k = i + 1; k < boxes.size() && boxes[k].box.lo[0] <= boxes[i].box.hi[0]; ++k) {
      const int a = boxes[i].pin, b = boxes[k].pin;
      if (!overlap(boxes[i].box, boxes[k].box) || patches.root(a) == patches.root(b)) continue;
      pairs.push_back({a, b, kept_distance(world, options, a, b, (row(x0, a) - row(x0, b)).norm())});
    }
  return pairs;
}

// Where the difference of two pins first is as short as it may be, on its way from d0 to d1; none: it never is shorter.
std::optional<Vec3> first_touch(const Vec3& d0, const Vec3& d1, double kept) {
  const Vec3 way = d1 - d0;
  const double a = way.squaredNorm(), b = d0.dot(way), c = d0.squaredNorm() - kept * kept;
  if (!(b < 0) || !(kept > 0)) return {};
  const double inside = b * b - a * std::max(c, 0.0);
  if (inside < 0) return {};
  const double time = std::max(0.0, (-b - std::sqrt(inside)) / a);
  return time < 1 ? std::optional<Vec3>(d0 + time * way) : std::nullopt;
}

// Moves the ends of a pair apart, along the line on which they touch. False: they stay apart as they are.
bool part(const PinPair& pair, const std::vector<char>& moves, const Points& x0, Points& x1) {
  const Vec3 d1 = row(x1, pair.a) - row(x1, pair.b);
  const std::optional<Vec3> touch = first_touch(row(x0, pair.a) - row(x0, pair.b), d1, pair.kept);
  if (!touch) return false;
  const Vec3 normal = touch->normalized();
  const double missing = pair.kept - normal.dot(d1);
  if (missing <= slight * pair.kept) return false;
  const double both = moves[pair.a] + moves[pair.b];
  if (both == 0) return false;
  x1.row(pair.a) += (moves[pair.a] / both * missing * normal).transpose();
  x1.row(pair.b) -= (moves[pair.b] / both * missing * normal).transpose();
  return true;
}

}  // namespace

DisjointSets pin_patches(const ContactWorld& world, std::span<const int> pins) {
  std::vector<char> pinned(static_cast<std::size_t>(world.node_count), 0);
  for (const int pin : pins) pinned[pin] = 1;
  DisjointSets patches(world.node_count);
  for (const auto& edge : world.cloth->edges.rowwise())
    if (pinned[edge[0]] && pinned[edge[1]]) patches.join(edge[0], edge[1]);
  return patches;
}

void keep_pins_apart(const ContactWorld& world, std::span<const int> pins, DisjointSets& patches,
                     const ResolveOptions& options, const Points& x0, Points& x1) {
  const std::vector<PinPair> pairs = near_pairs(world, pins, patches, options, x0, x1);
  if (pairs.empty()) return;
  std::vector<char> moves(static_cast<std::size_t>(world.node_count), 0);
  for (const int pin : pins) moves[pin] = x0.row(pin) != x1.row(pin);
  bool again = true;
  for (int round = 0; again; ++round) {
    again = false;
    for (const PinPair& pair : pairs) {
      if (!part(pair, moves, x0, x1)) continue;
      again = true;
      if (round < sliding_rounds) continue;
      for (const int pin : {pair.a, pair.b}) {
        x1.row(pin) = x0.row(pin);
        moves[pin] = 0;
      }
    }
  }
}

}  // namespace selvedge
