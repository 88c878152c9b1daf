#include "collision/contact/pins_give_way.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "collision/contact/path_pairs.hpp"
#include "collision/contact/pins_apart.hpp"
#include "collision/contact/resolve.hpp"
#include "collision/geometry/box.hpp"

namespace selvedge {
namespace {

struct Driven {
  std::vector<char> met;         // by node: 1 for pins, and for nodes that pins may meet
  Eigen::VectorXd inverse_mass;  // 1 for pins that may give way, else 0
  bool meet = false;             // boxes of some overlap
};

struct PinBoxes {
  Box all = empty_box, moving = empty_box;
};

// Whether moving pins of one patch come near pins of another.
bool patches_meet(const std::map<int, PinBoxes>& groups) {
  std::vector<PinBoxes> sorted;
  for (const auto& [patch, boxes] : groups) sorted.push_back(boxes);
  std::ranges::sort(sorted, {}, [](const PinBoxes& one) { return one.all.lo[0]; });
  for (std::size_t a = 0; a < sorted.size(); ++a)
    for (std::size_t b = a + 1; b < sorted.size() && sorted[b].all.lo[0] <= sorted[a].all.hi[0]; ++b)
      if (overlap(sorted[a].moving, sorted[b].all) || overlap(sorted[b].moving, sorted[a].all)) return true;
  return false;
}

Driven driven(const ContactWorld& world, std::span<const int> pins, DisjointSets& patches, double thickness,
              const Points& x0, const Points& x1) {
  Driven d{std::vector<char>(world.node_count, 0), Eigen::VectorXd::Zero(world.node_count)};
  std::map<int, PinBoxes> groups;  // by patch
  for (const int pin : pins) {
    const Box box = moving_point_box(row(x0, pin), row(x1, pin), thickness);
    PinBoxes& group = groups[patches.root(pin)];
    group.all = join(group.all, box);
    d.met[pin] = 1;
    if (x0.row(pin) == x1.row(pin)) continue;
    group.moving = join(group.moving, box);
    d.inverse_mass[pin] = 1;
  }
  d.meet = world.self && patches_meet(groups);
  const std::vector<char> moving = obstacles_in_motion(world, x0, x1);
  for (std::size_t k = 0; k < moving.size(); ++k) {
    Box box = empty_box;
    const int first = world.first_node[k], last = first + world.obstacles[k]->vertex_count;
    for (int node = first; node < last; ++node) box = join(box, moving_point_box(row(x0, node), row(x1, node), 0));
    const auto comes_to = [&](const auto& g) { return overlap(moving[k] ? g.second.all : g.second.moving, box); };
    if (std::ranges::none_of(groups, comes_to)) continue;
    std::fill(d.met.begin() + first, d.met.begin() + last, 1);
    d.meet = true;
    for (const int pin : pins)
      if (moving[k] && overlap(moving_point_box(row(x0, pin), row(x1, pin), thickness), box)) d.inverse_mass[pin] = 1;
  }
  return d;
}

}  // namespace

int pins_give_way(PairSearch& search, const ContactWorld& world, std::span<const int> pins,
                  const ResolveOptions& options, const Points& x0, Points& x1, ResolveReport& report) {
  const auto moves = [&](int node) { return x0.row(node) != x1.row(node); };
  if (pins.empty() ||
      (std::ranges::none_of(pins, moves) && std::ranges::count(obstacles_in_motion(world, x0, x1), 1) == 0))
    return 0;
  DisjointSets patches = pin_patches(world, pins);
  const Points wanted = x1;
  if (world.self) keep_pins_apart(world, pins, patches, options, x0, x1);
  const auto elsewhere = [&] {
    return static_cast<int>(std::ranges::count_if(pins, [&](int pin) { return x1.row(pin) != wanted.row(pin); }));
  };
  const Driven d = driven(world, pins, patches, options.thickness, x0, x1);
  if (!d.meet) return elsewhere();
  ResolveOptions among = options;
  among.only = &d.met;
  among.friction = among.self_friction = 0;
  PathPairs path;
  path.marks.assign(world.node_count, 0);
  for (const int pin : pins) path.marks[pin] = 1;
  const ResolveReport resolved = resolve(search, world, d.inverse_mass, among, x0, x1, path);
  report.work = resolved.work;
  report.out_of_work = resolved.out_of_work;
  report.broad_phase = resolved.broad_phase;
  report.ccd = resolved.ccd;
  report.response = resolved.response;
  return elsewhere();
}

}  // namespace selvedge
