#include "physics/energies/hinge_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

// Written without branches, for the compiler to take several lanes at a time.
//
// The angle's second derivative splits into one part a triangle ("wing"), and each part couples only motion along the
// wing's normal (nu) with motion in its plane (xi along the edge, eta across it). With L the edge length, h the wing's
// height, r = (-(1 - t), -t, 1) the height of the tip over the edge and q = (-1, 1, 0) the edge itself, over the
// corners e0, e1, tip:
//   d theta = -r.nu / h,   d2 theta = 2 [ (r.nu)(r.eta) / h^2 + (q.nu)(r.xi) / (h L) + (q.nu)(q.eta) / (2 L^2) ].
// With s = h / L that is 1 / (h L) [0 M; M^T 0], M = Y Z^T, where Y has the columns r and q, and Z over (xi, eta) has
// (0, r / s) and (r, q s / 2). Its absolute value is sqrt(M M^T) = Y A Y^T beside sqrt(M^T M) = Z B Z^T with, by the
// square root of 2 x 2 matrices, G = Y^T Y and H = Z^T Z,
//   A = (H + k adj G) / w,  B = (G + adj H / k) / w,  k = sqrt(det H / det G),  w = sqrt(tr(G H) + 2 k det G).
// The determinants are sums of positive terms: det G = 3, det H = |r|^4 / s^2 + 3 / 4. Hence a PSD projection in closed
// form: half the sum of the part and its absolute value, for each wing on its own, beside the Gauss-Newton part. The
// sum bounds the true Hessian from above.
namespace selvedge {
namespace {

constexpr double pi = std::numbers::pi;
// Of a wing's height over the edge's length; lower wings count as this, which bounds a sliver's force.
constexpr double smallest_rise = 1e-4;

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
    lanes.difference[l] = difference;
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

[[gnu::always_inline]] inline Side scaled(double a, const Side& v) { return {a * v.x, a * v.y, a * v.z}; }
[[gnu::always_inline]] inline Side sum_of(const Side& a, const Side& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

// Adds a b^T to a block.
[[gnu::always_inline]] inline void add_outer(const Side& a, const Side& b, int l, HingeLanes::Lane (&block)[9]) {
  const double rows[3] = {a.x, a.y, a.z}, columns[3] = {b.x, b.y, b.z};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) block[3 * i + j][l] += rows[i] * columns[j];
}

// One wing of each hinge.
struct WingLanes {
  HingeLanes::Lane normal[3], across[3];  // unit
  HingeLanes::Lane foot, slope;           // where the tip stands over the edge [its length]; 1 / height
  HingeLanes::Lane flatness, scale;       // height / edge; weight x difference / (height x edge)
};

// Where the edge runs, its length and what stands on it; all is finite, and nothing where it is not defined.
struct HingeFrames {
  HingeLanes::Lane along[3], length, weight;  // unit, [m], [N m]
  WingLanes wings[2];
};

[[gnu::always_inline]] inline void set_frames(const HingeLanes& lanes, HingeFrames& frames) {
  for (int l = 0; l < HingeLanes::width; ++l) {
    const Side edge = side_of(lanes.edge, l), tips[2] = {side_of(lanes.tip_a, l), side_of(lanes.tip_b, l)};
    const Side normals[2] = {cross_of(edge, tips[0]), cross_of(tips[1], edge)};
    const double squared = dot_of(edge, edge),
                 areas[2] = {std::sqrt(dot_of(normals[0], normals[0])), std::sqrt(dot_of(normals[1], normals[1]))};
    const bool defined = (areas[0] > 0) & (areas[1] > 0) & (squared > 0);
    const double length = std::sqrt(defined ? squared : 1), least = smallest_rise * length;
    const double weight = lanes.weight[l] * (lanes.current[l] * squared + (1 - lanes.current[l]));
    const Side along = scaled(1 / length, edge);
    frames.along[0][l] = along.x;
    frames.along[1][l] = along.y;
    frames.along[2][l] = along.z;
    frames.length[l] = length;
    frames.weight[l] = defined ? weight : 0;
    for (int w = 0; w < 2; ++w) {
      WingLanes& wing = frames.wings[w];
      const double area = defined ? areas[w] : 1, rise = area / length, height = rise < least ? least : rise;
      const Side normal = scaled(1 / area, normals[w]);
      const Side across = w == 0 ? cross_of(normal, along) : cross_of(along, normal);
      wing.normal[0][l] = normal.x;
      wing.normal[1][l] = normal.y;
      wing.normal[2][l] = normal.z;
      wing.across[0][l] = across.x;
      wing.across[1][l] = across.y;
      wing.across[2][l] = across.z;
      wing.foot[l] = dot_of(tips[w], edge) / (length * length);
      wing.slope[l] = 1 / height;
      wing.flatness[l] = height / length;
      wing.scale[l] = defined ? weight * lanes.difference[l] / (height * length) : 0;
    }
  }
}

// The Gauss-Newton part, and with c = Hinge::weight, d the difference, a and b the derivatives of the angle and of the
// squared length, what the current length does beside the weight:
//   c d (a b^T + b a^T) + c d^2 [I, -I; -I, I].
// The first part is indefinite, and a and b are perpendicular. Of the second, what lies along the edge is c d^2 / (4
// l^2) b b^T; four times as much makes a perfect square of it together with the Gauss-Newton part c l^2 a a^T.
template <bool psd>
[[gnu::always_inline]] inline void add_slopes(const HingeFrames& frames, HingeLanes& lanes) {
  for (int l = 0; l < HingeLanes::width; ++l) {
    const Side along = side_of(frames.along, l);
    const WingLanes &wing_a = frames.wings[0], &wing_b = frames.wings[1];
    const Side tip_a = scaled(-wing_a.slope[l], side_of(wing_a.normal, l)),
               tip_b = scaled(-wing_b.slope[l], side_of(wing_b.normal, l));
    const double foot_a = wing_a.foot[l], foot_b = wing_b.foot[l], weight = frames.weight[l];
    const Side first = sum_of(scaled(foot_a - 1, tip_a), scaled(foot_b - 1, tip_b)),
               second = sum_of(scaled(-foot_a, tip_a), scaled(-foot_b, tip_b));
    for (int pair = 0; pair < HingeLanes::pairs; ++pair)
      for (int k = 0; k < 9; ++k) lanes.block[pair][k][l] = 0;
    const double bent = weight > 0 ? lanes.current[l] * lanes.weight[l] * lanes.difference[l] : 0;
    const double own = bent * lanes.difference[l];
    const Side longer = scaled(2 * bent * frames.length[l], along);  // c d db / d e1, and minus that for e0
    const Side of_first = sum_of(scaled(weight, first), scaled(-1, longer)),
               of_second = sum_of(scaled(weight, second), longer);
    add_outer(of_first, second, l, lanes.block[0]);
    add_outer(first, longer, l, lanes.block[0]);
    add_outer(scaled(psd ? -3 * own : 0, along), along, l, lanes.block[0]);
    for (int k = 0; k < 9; k += 4) lanes.block[0][k][l] -= own;
    add_outer(of_first, tip_a, l, lanes.block[1]);
    add_outer(of_first, tip_b, l, lanes.block[2]);
    add_outer(of_second, tip_a, l, lanes.block[3]);
    add_outer(of_second, tip_b, l, lanes.block[4]);
    add_outer(scaled(weight, tip_a), tip_b, l, lanes.block[5]);
  }
}

// The second derivative of the angle, of one wing.
template <bool psd>
[[gnu::always_inline]] inline void add_wings(const HingeFrames& frames, int side, HingeLanes& lanes) {
  const WingLanes& wing = frames.wings[side];
  for (int l = 0; l < HingeLanes::width; ++l) {
    const double foot = wing.foot[l], s = wing.flatness[l], scale = wing.scale[l];
    const double r[3] = {foot - 1, -foot, 1}, q[3] = {-1, 1, 0};
    const double rr = r[0] * r[0] + r[1] * r[1] + 1, rq = 1 - 2 * foot, over = 1 / s;
    const double h00 = rr * over * over, h01 = 0.5 * rq, h11 = rr + 0.5 * s * s;  // H; G is rr, rq; rq, 2
    const double det_h = h00 * rr + 0.75, k = std::sqrt(det_h / 3);
    const double strength = 0.5 * std::abs(scale) / std::sqrt(rr * h00 + 2 * rq * h01 + 2 * h11 + 6 * k);
    const double a00 = strength * (h00 + 2 * k), a01 = strength * (h01 - k * rq), a11 = strength * (h11 + k * rr);
    const double b00 = strength * (rr + h11 / k), b01 = strength * (rq - h01 / k), b11 = strength * (2 + h00 / k);
    const double mixed = psd ? 0.5 * scale : scale;
    const Side normal = side_of(wing.normal, l), along = side_of(frames.along, l), across = side_of(wing.across, l);
    const auto add = [&](int i, int j, HingeLanes::Lane(&block)[9]) __attribute__((always_inline)) {
      const double zi = r[i] * over, zj = r[j] * over, ti = 0.5 * s * q[i], tj = 0.5 * s * q[j];  // rows of Z for eta
      const double lifted = mixed * (r[i] * zj + q[i] * tj);
      Side from_normal = sum_of(scaled(mixed * q[i] * r[j], along), scaled(lifted, across));
      Side from_along = scaled(mixed * r[i] * q[j], normal), from_across = scaled(lifted, normal);
      if (psd) {
        const double up = r[i] * (a00 * r[j] + a01 * q[j]) + q[i] * (a01 * r[j] + a11 * q[j]);
        from_normal = sum_of(from_normal, scaled(up, normal));
        from_along =
            sum_of(from_along, sum_of(scaled(b11 * r[i] * r[j], along), scaled(r[i] * (b01 * zj + b11 * tj), across)));
        const double away = zi * (b00 * zj + b01 * tj) + ti * (b01 * zj + b11 * tj);
        from_across = sum_of(from_across, sum_of(scaled(r[j] * (b01 * zi + b11 * ti), along), scaled(away, across)));
      }
      add_outer(normal, from_normal, l, block);
      add_outer(along, from_along, l, block);
      add_outer(across, from_across, l, block);
    };
    add(0, 1, lanes.block[0]);
    add(0, 2, lanes.block[1 + side]);
    add(1, 2, lanes.block[3 + side]);
  }
}

template <bool psd>
[[gnu::always_inline]] inline void hessians_of_hinges(HingeLanes& lanes) {
  HingeFrames frames;
  set_frames(lanes, frames);
  add_slopes<psd>(frames, lanes);
  add_wings<psd>(frames, 0, lanes);
  add_wings<psd>(frames, 1, lanes);
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

SELVEDGE_CLONES void hinge_hessians(bool psd, HingeLanes& lanes) {
  if (psd)
    hessians_of_hinges<true>(lanes);
  else
    hessians_of_hinges<false>(lanes);
}

}  // namespace selvedge
