#include "collision/contact/ccd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/contact/exact_contact.hpp"
#include "collision/geometry/distance.hpp"

namespace selvedge {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double u = 0x1p-53;         // largest relative rounding error of an operation
constexpr int most_intervals = 1000;  // most intervals in exact arithmetic; the worst cases seen take a few hundred
// A bound of all underflow together, where lengths are of the order of one.
constexpr double underflow = 8 * std::numeric_limits<double>::min();

// A lower bound of (direction . true corner) - room, where the true room is within 4 u of `room`. The corner's
// coordinates, the products and the two sums have an error up to 4 u of sum |terms|, to first order; subtracting room
// and then `lost` adds u each. Together this is less than 6 u (sum |terms| + room); `lost` is a quarter larger, for its
// own rounding.
double gap_below(const Vec3& direction, const Vec3& corner, double room) {
  const double x = direction.x() * corner.x(), y = direction.y() * corner.y(), z = direction.z() * corner.z();
  const double lost = 8 * u * (std::abs(x) + std::abs(y) + std::abs(z) + room) + underflow;
  return (x + y + z) - room - lost;
}

// The time until which, from `time` on, every corner is farther than `limit` from the origin along `along`; `time`
// itself if that is false there. Until then the distance of the polygon from the origin is above the limit.
//
// The proof holds for any vector `along`, so that its own rounding does not matter. Along it each corner's gap is
// linear in time, so it is at least the line from one end's lower bound to the other's. The line's zero is a quotient
// without cancellation: computed within 2 u, to first order; 8 u leave room for the product and the sum after it.
double free_until(const MovingPolygon& p, const Vec3& along, double time, double limit) {
  const double largest = along.cwiseAbs().maxCoeff();
  if (!(largest > 0 && largest < infinity)) return time;
  const Vec3 direction = along / largest;
  const double room = limit * direction.norm();
  double until = infinity;
  for (int k = 0; k < p.corners; ++k) {
    const double before = gap_below(direction, p.start[k], room), after = gap_below(direction, p.end[k], room);
    if (before > 0 && after > 0) continue;
    const double zero = before / (before - after);
    if (before > 0)
      until = std::min(until, zero * (1 - 8 * u) - underflow);
    else if (!(after > 0 && time > zero * (1 + 8 * u) + underflow))
      return time;
  }
  return std::max(time, until);
}

// Directions along which the polygon may be apart from the origin.
struct Directions {
  Vec3 closest;  // from the origin to the polygon's closest point
  Vec3 normal;   // of the polygon, toward the same side
};

Vec3 to_closest(const MovingPolygon& p, double time) {
  const bool triangle = p.corners == 3;
  const Vec3 first = p.at(0, time), second = p.at(1, time);
  const std::array<Vec3, 4> x{Vec3::Zero(), triangle ? first : Vec3(first - second), triangle ? second : first,
                              triangle ? p.at(2, time) : p.at(3, time)};
  const Closest c = triangle ? point_triangle(x[0], x[1], x[2], x[3]) : edge_edge(x[0], x[1], x[2], x[3]);
  return -(c.weights[1] * x[1] + c.weights[2] * x[2] + c.weights[3] * x[3]);
}

Directions directions(const MovingPolygon& p, double time) {
  const Vec3 closest = to_closest(p, time), first = p.at(0, time);
  const Vec3 normal = (p.at(1, time) - first).cross(p.at(2, time) - first);
  return {closest, normal.dot(closest) < 0 ? Vec3(-normal) : normal};
}

// Tries the normal too: a short vector between closest points loses its direction in rounding long before a normal
// does.
double free_until(const MovingPolygon& p, const Directions& apart, double time, double limit) {
  const double until = free_until(p, apart.closest, time, limit);
  return until > time ? until : free_until(p, apart.normal, time, limit);
}

// Conservative advancement to contact itself. Where it cannot advance, or has become slow, a window of time is searched
// exactly. Windows grow as long as they are free; an uncertain contact in a wide window is searched again in a narrow
// one. Times before `time` are always proven free.
std::optional<double> first_contact(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                    int max_iterations) {
  constexpr double narrowest = 0x1p-40, growth = 256;
  constexpr int patience = 16;
  const MovingPolygon p = moving_polygon(kind, x0, x1);
  double time = 0, window = narrowest;
  int intervals = most_intervals;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const double until = free_until(p, directions(p, time), time, 0);
    if (until > 1) return std::nullopt;
    const bool quick = until > time && iteration < patience;
    time = until;
    if (quick) continue;
    const double from = std::floor(time / time_grain) * time_grain, to = std::min(from + window, 1.0);
    const std::optional<FoundContact> contact = exact_contact(kind, x0, x1, p, from, to, intervals);
    if (!contact && to == 1) return std::nullopt;
    time = std::max(time, contact ? contact->time : to);
    if (contact && (contact->certain || window == narrowest)) return time;
    window = contact ? narrowest : growth * window;
  }
  return time;
}

// Conservative advancement to a distance above zero, which needs no exact arithmetic.
std::optional<double> first_approach(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                     double min_separation, int max_iterations) {
  const MovingPolygon p = moving_polygon(kind, x0, x1);
  double limit = min_separation * p.scale, time = 0;
  // Most pairs are apart all the way along the direction between their closest points in the middle of the motion.
  if (free_until(p, to_closest(p, 0.5), 0, limit) > 1) return std::nullopt;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Directions apart = directions(p, time);
    double until = free_until(p, apart, time, limit);
    if (iteration == 0 && !(until > time)) {
      limit = 0.5 * apart.closest.norm();
      until = free_until(p, apart, time, limit);
    }
    if (until > 1) return std::nullopt;
    if (!(until > time)) return time;
    time = until;
  }
  return time;
}

bool all_finite(const std::array<Vec3, 4>& x) {
  return x[0].allFinite() && x[1].allFinite() && x[2].allFinite() && x[3].allFinite();
}

}  // namespace

std::optional<double> time_of_contact(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                      double min_separation, int max_iterations) {
  if (!all_finite(x0) || !all_finite(x1)) return 0.0;
  if (min_separation > 0) return first_approach(kind, x0, x1, min_separation, max_iterations);
  return first_contact(kind, x0, x1, max_iterations);
}

}  // namespace selvedge
