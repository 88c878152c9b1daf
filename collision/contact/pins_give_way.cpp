#include "collision/contact/pins_give_way.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "collision/geometry/box.hpp"

namespace selvedge {
namespace {

struct Driven {
  std::vector<char> met;         // by node: 1 for pins, and for nodes that pins may meet
  Eigen::VectorXd inverse_mass;  // 1 for pins that may give way, else 0
  bool meet = false;             // boxes of some overlap
};

Driven driven(const ContactWorld& world, std::span<const int> pins, double thickness, const Points& x0,
              const Points& x1) {
  Driven d{std::vector<char>(world.node_count, 0), Eigen::VectorXd::Zero(world.node_count)};
  struct PinBoxes {
    Box all = empty_box, moving = empty_box;
  };
  std::map<int, PinBoxes> groups;  // by connected component of the cloth
  for (const int pin : pins) {
    const Box box = moving_point_box(row(x0, pin), row(x1, pin), thickness);
    PinBoxes& group = groups[world.cloth->component[pin]];
    group.all = join(group.all, box);
    d.met[pin] = 1;
    if (x0.row(pin) == x1.row(pin)) continue;
    group.moving = join(group.moving, box);
    d.inverse_mass[pin] = 1;
  }
  for (auto a = groups.begin(); world.self && a != groups.end(); ++a)
    for (auto b = groups.begin(); b != groups.end(); ++b)
      d.meet = d.meet || (a != b && overlap(a->second.moving, b->second.all));
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
  const Driven d = driven(world, pins, options.thickness, x0, x1);
  if (!d.meet) return 0;
  ResolveOptions among = options;
  among.only = &d.met;
  among.friction = among.self_friction = 0;
  const Points wanted = x1;
  PathPairs path;
  path.marks.assign(world.node_count, 0);
  for (const int pin : pins) path.marks[pin] = 1;
  const ResolveReport resolved = resolve(search, world, d.inverse_mass, among, x0, x1, path);
  report.work = resolved.work;
  report.out_of_work = resolved.out_of_work;
  report.broad_phase = resolved.broad_phase;
  report.ccd = resolved.ccd;
  report.response = resolved.response;
  return static_cast<int>(std::ranges::count_if(pins, [&](int pin) { return x1.row(pin) != wanted.row(pin); }));
}

}  // namespace selvedge
