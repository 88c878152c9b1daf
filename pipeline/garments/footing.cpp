#include "pipeline/garments/footing.hpp"

#include <algorithm>
#include <limits>

#include "collision/geometry/nearest_point.hpp"

namespace selvedge {
namespace {

constexpr double first_part = 0.25, last_part = 0.5;  // of a gap: squeezed from the first on, toward the second
constexpr double near = 0.03, far = 0.06;             // from the foot: nearer squeezed in full, farther not [m]
constexpr double beside = 0.01;                       // this near to the line out from the foot counts as on it [m]
constexpr double cell = far / 2;                      // edge of the cubes in which other parts are looked for [m]
constexpr double facing = -0.3;                       // largest cosine of its normal with the direction out

// For each foot the distance along the line out to x at which another part of the body begins [m]. A part beside the
// line counts as farther by its distance from it. Infinite if no part is near enough to matter.
std::vector<double> gaps(const std::vector<int>& foot, const PosedSkin& body, const Points& x) {
  std::vector<double> gap(foot.size(), std::numeric_limits<double>::infinity());
#pragma omp parallel for schedule(dynamic, 64) if (foot.size() > 256)
  for (int v = 0; v < static_cast<int>(foot.size()); ++v) {
    const Vec3 from = row(body.x, foot[v]), way = row(x, v) - from;
    const double out = way.norm(), most = out / first_part;
    if (!(out > 0 && out < far)) continue;
    const Vec3 along = way / out;
    // What counts is in a cone on the disk round the foot: its distance from the line is less than what is left of
    // `most` at its height, and `beside`.
    const double base = most + beside;
    const Vec3 tip = from + base * along,
               disk = (base * (1 - along.array().square()).max(0).sqrt() + 1e-9 * base).matrix();
    body.grid.for_each_place_in(tip.cwiseMin(from - disk), tip.cwiseMax(from + disk), [&](int p) {
      const Vec3 to = row(body.x_in_order, p) - from;
      const double height = to.dot(along);
      if (!(height > 0 && height < std::min(gap[v], most)) || row(body.normals_in_order, p).dot(along) > facing) return;
      const double there = height + std::max(0.0, (to - height * along).norm() - beside);
      if (there < most) gap[v] = std::min(gap[v], there);
    });
  }
  return gap;
}

}  // namespace

PosedSkin::PosedSkin(const Surface& body, const Points& posed)
    : x(posed),
      grid(posed, cell),
      x_in_order(posed(grid.order(), Eigen::all)),
      normals_in_order(vertex_normals(body, posed)(grid.order(), Eigen::all)) {}

Footing footing_of(const Points& x, const PosedSkin& rest) {
  Footing footing;
  footing.foot.resize(static_cast<std::size_t>(x.rows()));
#pragma omp parallel for schedule(static)
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    footing.foot[v] = nearest_point(rest.grid, rest.x, x.row(v).transpose()).point;
  const std::vector<double> gap = gaps(footing.foot, rest, x);
  for (std::size_t v = 0; v < gap.size(); ++v) {
    const double out = (x.row(static_cast<Eigen::Index>(v)) - rest.x.row(footing.foot[v])).norm();
    footing.part.push_back(std::clamp(out / gap[v], first_part, 1.0));
  }
  return footing;
}

Footing footing_of(const Footing& all, const std::vector<int>& vertices) {
  Footing some;
  if (all.foot.empty()) return some;
  for (const int v : vertices) {
    some.foot.push_back(all.foot[v]);
    some.part.push_back(all.part[v]);
  }
  return some;
}

Points squeezed(const Footing& footing, const PosedSkin& body, const Points& x) {
  const std::vector<double> gap = gaps(footing.foot, body, x);
  Points to = x;
  for (std::size_t v = 0; v < gap.size(); ++v) {
    const Vec3 foot = row(body.x, footing.foot[v]), way = row(x, static_cast<int>(v)) - foot;
    const double out = way.norm(), free = footing.part[v] * gap[v],
                 left = last_part * gap[v] - free;  // 0 or less if the part was as near at rest
    if (!(out > free)) continue;
    // Smooth and rising, but always below last_part of the gap.
    const double less = left > 0 ? free + left * (out - free) / (out - free + left) : free;
    const double share = std::clamp((far - out) / (far - near), 0.0, 1.0);
    to.row(static_cast<Eigen::Index>(v)) += share * (less / out - 1) * way.transpose();
  }
  return to;
}

}  // namespace selvedge
