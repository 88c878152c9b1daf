#include "collision/contact/exact_contact.hpp"

#include <algorithm>
#include <cstdint>

#include "collision/exact/exact_integer.hpp"
#include "collision/exact/polygon_signs.hpp"

namespace selvedge {
namespace {

using Exact = ExactInteger;

constexpr std::uint64_t whole = std::uint64_t{1} << 40;  // number of finest intervals in a window
constexpr double fine = 0x1p-30;                         // a certain contact is known in time within this
constexpr double unit_roundoff = 0x1p-53;

// Corners at both ends of the searched window as integers, scaled by a power of two for each axis. This keeps all
// signs: every product has each axis at most once, and every sum is of products of the same axes.
struct Window {
  int corners;
  Corners<Exact> first, last;
};

Corner<Exact> between(const Corner<Exact>& first, const Corner<Exact>& last, std::uint64_t at, std::uint64_t of) {
  const Exact after(static_cast<double>(at), 0), before(static_cast<double>(of - at), 0);
  Corner<Exact> corner;
  for (int axis = 0; axis < 3; ++axis) corner[axis] = first[axis] * before + last[axis] * after;
  return corner;
}

Corner<Exact> difference(const Vec3& to, const Vec3& from, const std::array<int, 3>& exponent) {
  Corner<Exact> corner;
  for (int axis = 0; axis < 3; ++axis)
    corner[axis] = Exact(to[axis], exponent[axis]) - Exact(from[axis], exponent[axis]);
  return corner;
}

std::array<int, 3> common_exponents(const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1) {
  std::array<int, 3> exponent;
  for (int axis = 0; axis < 3; ++axis) {
    exponent[axis] = lowest_exponent(x0[0][axis]);
    for (const auto* x : {&x0, &x1})
      for (const Vec3& node : *x) exponent[axis] = std::min(exponent[axis], lowest_exponent(node[axis]));
  }
  return exponent;
}

Window window(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1, double from, double to) {
  const std::array<int, 3> exponent = common_exponents(x0, x1);
  const auto grains = [](double time) { return static_cast<std::uint64_t>(time / time_grain); };
  Window w{0, {}, {}};
  for (const CornerNodes& nodes : polygon_corners(kind)) {
    const Corner<Exact> start = difference(x0[nodes.to], x0[nodes.from], exponent);
    const Corner<Exact> end = difference(x1[nodes.to], x1[nodes.from], exponent);
    w.first[w.corners] = between(start, end, grains(from), grains(1));
    w.last[w.corners] = between(start, end, grains(to), grains(1));
    ++w.corners;
  }
  return w;
}

PolygonSigns exact_signs(const Window& w, std::uint64_t first, std::uint64_t last) {
  Corners<Exact> p, q;
  for (int k = 0; k < w.corners; ++k) {
    p[k] = between(w.first[k], w.last[k], first, whole);
    q[k] = between(w.first[k], w.last[k], last, whole);
  }
  return polygon_signs(w.corners, p, q, [](const Exact& value, int) { return value.sign(); });
}

// The same in floating point, unknown where rounding may change the sign. Coordinates are below 2. The error of an
// interpolated one is at most 4 u of |start| + |end| < 4, and 2 u of its speed, below 4, since the time is rounded too:
// 24 u. So the error of a product of two, below 4, is 4 x 24 u + 4 u, and that of a turn's coefficient, a sum of four
// of them, less than 420 u. The error of a product of such a coefficient, below 16, and a coordinate is 2 x 420 u + 16
// x 24 u + 32 u, and that of a volume's coefficient, a sum of six of them, less than 8400 u.
PolygonSigns rounded_signs(const MovingPolygon& polygon, double first, double last) {
  constexpr std::array<double, 4> lost{0, 32 * unit_roundoff, 512 * unit_roundoff, 16384 * unit_roundoff};
  Corners<double> p, q;
  for (int k = 0; k < polygon.corners; ++k) {
    const Vec3 at_first = polygon.at(k, first), at_last = polygon.at(k, last);
    p[k] = {at_first.x(), at_first.y(), at_first.z()};
    q[k] = {at_last.x(), at_last.y(), at_last.z()};
  }
  return polygon_signs(polygon.corners, p, q, [&](double value, int degree) {
    return value > lost[degree] ? 1 : value < -lost[degree] ? -1 : unknown;
  });
}

}  // namespace

std::optional<FoundContact> exact_contact(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                          const MovingPolygon& polygon, double from, double to, int& intervals) {
  const double unit = (to - from) / static_cast<double>(whole);
  const auto moment = [&](std::uint64_t units) { return from + static_cast<double>(units) * unit; };
  std::optional<Window> exact;
  std::uint64_t time = 0, width = whole;  // in units; time is a multiple of width
  while (time < whole) {
    PolygonSigns s = rounded_signs(polygon, moment(time), moment(time + width));
    const bool decided = is_free(s) || is_certain(s);
    if (!decided) {
      if (!exact) exact = window(kind, x0, x1, from, to);
      s = exact_signs(*exact, time, time + width);
    }
    const bool capped = --intervals < 0;
    if (!capped && is_free(s)) {
      time += width;
      if (time % (2 * width) == 0) width *= 2;
      continue;
    }
    const bool certain =
        (static_cast<double>(width) * unit <= fine && is_certain(s)) || (!decided && touches_at_first(s));
    // The rounding error of `moment` is less than two grains.
    if (capped || certain || width == 1) return FoundContact{std::max(from, moment(time) - 2 * time_grain), certain};
    width /= 2;
  }
  return std::nullopt;
}

}  // namespace selvedge
