#include "physics/energies/hinge_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

// Written without branches, for the compiler to take several lanes at a time.
namespace selvedge {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double smallest_rise = 1e-4;  // of a wing, as a fraction of the edge: hinge_bending.cpp

// atan(u) / u for |u| <= tan(pi / 8), in u^2; off by 3.5e-17 at most.
constexpr double arc_coefficients[] = {1.0,
                                       -0.3333333333332844,
                                       0.1999999999885511,
                                       -0.14285714180976467,
                                       0.11111106180455946,
                                       -0.09090773074808413,
                                       0.07689953496306848,
                                       -0.0664023393042932,
                                       0.05688349226808552,
                                       -0.04348052215715138,
                                       0.02113537315767703};

// As std::atan2, to a few units in the last place; 0 where both are 0.
[[gnu::always_inline]] inline double arc_tangent(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y);
  const double larger = ax < ay ? ay : ax, smaller = ax < ay ? ax : ay;
  const double z = smaller / (larger > 0 ? larger : 1);
  const bool steep = z > 0.41421356237309503;
  const double u = (steep ? z - 1 : z) / (steep ? z + 1 : 1), square = u * u;
  double sum = arc_coefficients[10];
  for (int k = 9; k >= 0; --k) sum = sum * square + arc_coefficients[k];
  const double first = u * sum + (steep ? pi / 4 : 0), half = ax < ay ? pi / 2 - first : first;
  return std::copysign(x < 0 ? pi - half : half, y);
}

struct Side {
  double x, y, z;
};
[[gnu::always_inline]] inline Side cross_of(const Side& a, const Side& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[gnu::always_inline]] inline double dot_of(const Side& a, const Side& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[gnu::always_inline]] inline Side side_of(const HingeLanes::Lane (&from)[3], int l) {
  return {from[0][l], from[1][l], from[2][l]};
}

void load_hinges(std::span<const Hinge> hinges, const Points& x, HingeLanes& lanes) {
  lanes.count = static_cast<int>(std::min<std::size_t>(hinges.size(), HingeLanes::width));
  for (int l = 0; l < HingeLanes::width; ++l) {  // lanes that are not in use take after the last one
    const Hinge& hinge = hinges[static_cast<std::size_t>(std::min(l, lanes.count - 1))];
    for (int k = 0; k < 3; ++k) {
      const double origin = x(hinge.nodes[0], k);
      lanes.edge[k][l] = x(hinge.nodes[1], k) - origin;
      lanes.tip_a[k][l] = x(hinge.nodes[2], k) - origin;
      lanes.tip_b[k][l] = x(hinge.nodes[3], k) - origin;
    }
    lanes.weight[l] = hinge.weight;
    lanes.rest_angle[l] = hinge.rest_angle;
    lanes.current[l] = hinge.length == HingeLength::current ? 1 : 0;
  }
}

template <bool gradient>
[[gnu::always_inline]] inline void energies_of_hinges(HingeLanes& lanes) {
  for (int l = 0; l < HingeLanes::width; ++l) {
    const Side edge = side_of(lanes.edge, l), a = side_of(lanes.tip_a, l), b = side_of(lanes.tip_b, l);
    const Side normal_a = cross_of(edge, a), normal_b = cross_of(b, edge);
    const double squared = dot_of(edge, edge), length = std::sqrt(squared);
    const double sine = dot_of(edge, cross_of(normal_a, normal_b)) / (length > 0 ? length : 1);
    const double off = arc_tangent(sine, dot_of(normal_a, normal_b)) - lanes.rest_angle[l];
    const double difference = off > pi ? off - 2 * pi : (off < -pi ? off + 2 * pi : off);
    const double weight = lanes.weight[l] * (lanes.current[l] * squared + (1 - lanes.current[l]));
    lanes.energy[l] = 0.5 * weight * difference * difference;
    if (!gradient) continue;
    // d angle / d tip = -n / height, with n the wing's unit normal; the edge's ends share what balances it.
    const double area_a = std::sqrt(dot_of(normal_a, normal_a)), area_b = std::sqrt(dot_of(normal_b, normal_b));
    const bool defined = (area_a > 0) & (area_b > 0) & (length > 0);
    const double one_length = defined ? length : 1, least = smallest_rise * one_length;
    const double height_a = area_a / one_length, height_b = area_b / one_length;
    const double pull = defined ? -weight * difference : 0;
    const double scale_a = pull / (defined ? area_a * (height_a < least ? least : height_a) : 1);
    const double scale_b = pull / (defined ? area_b * (height_b < least ? least : height_b) : 1);
    const double share_a = dot_of(a, edge) / (one_length * one_length) * scale_a;
    const double share_b = dot_of(b, edge) / (one_length * one_length) * scale_b;
    const double stretch = defined ? lanes.current[l] * lanes.weight[l] * difference * difference : 0;
    const double na[3] = {normal_a.x, normal_a.y, normal_a.z}, nb[3] = {normal_b.x, normal_b.y, normal_b.z},
                 e[3] = {edge.x, edge.y, edge.z};
    for (int k = 0; k < 3; ++k) {
      const double second = stretch * e[k] - share_a * na[k] - share_b * nb[k];
      const double force_a = scale_a * na[k], force_b = scale_b * nb[k];
      lanes.force[3 + k][l] = second;
      lanes.force[6 + k][l] = force_a;
      lanes.force[9 + k][l] = force_b;
      lanes.force[k][l] = -(second + force_a + force_b);
    }
  }
}

}  // namespace

// One clone of each an instruction set, as in physics/linear/pcg_kernels.cpp.
SELVEDGE_CLONES void hinge_energies(std::span<const Hinge> hinges, const Points& x, bool gradient, HingeLanes& lanes) {
  load_hinges(hinges, x, lanes);
  if (gradient)
    energies_of_hinges<true>(lanes);
  else
    energies_of_hinges<false>(lanes);
}

}  // namespace selvedge
