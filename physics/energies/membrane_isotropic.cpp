#include <cmath>

#include "physics/energies/membrane_lanes.hpp"

// Isotropic membranes: psi is a symmetric function of the principal stretches s1 >= s2 >= 0 of the 3 x 2 F. Its Hessian
// has six eigen-modes in closed form: two in-plane stretches (a 2 x 2 block), an in-plane twist and flip, and the two
// tilts out of the plane (Smith, de Goes, Kim 2019, "Analytic eigensystems for isotropic distortion energies", carried
// over to 3 x 2). Clamping the eigenvalues projects to PSD.
//
// St. Venant-Kirchhoff: psi = mu |G|^2 + lambda / 2 tr(G)^2, G = (F^T F - I) / 2.
//
// Stable neo-Hookean, after Smith, de Goes, Kim 2018, for a surface:
//   psi = mu / 2 (I_C - 2) - mu (J - 1) + (lambda + mu) / 2 (J - 1)^2,   I_C = |F|^2 = s1^2 + s2^2,   J = s1 s2,
// which is mu / 2 (s1 - s2)^2 + (lambda + mu) / 2 (J - 1)^2: zero at rest, positive elsewhere, finite for every F. At
// rest its second derivatives in s are 2 mu + lambda and lambda, those of the linear plane-stress membrane. A surface
// has no inside, so J >= 0 and a triangle that passes through zero area crosses a ridge of psi, not a barrier.
//
// Written without branches, for the compiler to take several lanes at a time.
namespace selvedge {
namespace {

struct Vector {
  double x, y, z;
};
[[gnu::always_inline]] inline Vector operator*(double a, const Vector& v) { return {a * v.x, a * v.y, a * v.z}; }
[[gnu::always_inline]] inline Vector operator/(const Vector& v, double a) { return {v.x / a, v.y / a, v.z / a}; }
[[gnu::always_inline]] inline Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[gnu::always_inline]] inline double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[gnu::always_inline]] inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[gnu::always_inline]] inline Vector choose(bool first, const Vector& a, const Vector& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

// Duff et al. 2017, "Building an orthonormal basis, revisited".
[[gnu::always_inline]] inline Vector any_perpendicular(const Vector& unit) {
  const double sign = std::copysign(1.0, unit.z), a = -1 / (sign + unit.z);
  return {1 + sign * unit.x * unit.x * a, sign * unit.x * unit.y * a, -sign * unit.x};
}

// The columns of F.
[[gnu::always_inline]] inline Vector column(const MembraneLanes& lanes, int k, int l) {
  const double p = lanes.inverse[k][l], q = lanes.inverse[2 + k][l];
  return {lanes.edge[0][l] * p + lanes.edge[3][l] * q, lanes.edge[1][l] * p + lanes.edge[4][l] * q,
          lanes.edge[2][l] * p + lanes.edge[5][l] * q};
}

struct Svd {  // F = s1 u1 v1^T + s2 u2 v2^T, normal = u1 x u2; V = [v1 v2] is a rotation by (c, s)
  double s1, s2, c, s;
  Vector u1, u2, normal;
};

// One-sided Jacobi: exact orthogonality of u1 and u2 also where s2 is 0 or equals s1.
[[gnu::always_inline]] inline Svd svd(const Vector& f, const Vector& g) {
  const double r = dot(f, g), half = 0.5 * (dot(f, f) - dot(g, g)), length = std::sqrt(half * half + r * r);
  // v1 is the half angle of (half, r), so that s1 >= s2.
  const double divisor = length > 0 ? length : 1;
  const double large = std::sqrt(0.5 * (1 + std::abs(half) / divisor)), small = 0.5 * std::abs(r) / (divisor * large);
  Svd result;
  result.c = length > 0 ? (half >= 0 ? large : small) : 1;
  result.s = length > 0 ? std::copysign(half >= 0 ? small : large, r) : 0;
  const Vector g1 = result.c * f + result.s * g, g2 = result.c * g + -result.s * f;
  result.s1 = std::sqrt(dot(g1, g1));
  result.u1 = choose(result.s1 > 0, g1 / (result.s1 > 0 ? result.s1 : 1), {1, 0, 0});
  const Vector across = g2 + -dot(result.u1, g2) * result.u1;
  result.s2 = std::sqrt(dot(across, across));
  // Below rounding of s1 the direction of `across` is noise that need not be perpendicular to u1.
  const bool has_direction = result.s2 > 1e-14 * result.s1;
  result.u2 = choose(has_direction, across / (has_direction ? result.s2 : 1), any_perpendicular(result.u1));
  result.normal = cross(result.u1, result.u2);
  return result;
}

// First derivatives of psi in s, and the Hessian's eigenvalues: the stretch block, then one for each other mode.
struct Spectrum {
  double first1, first2;
  double stretch11, stretch12, stretch22;
  double twist, flip;   // (u1 v2^T -+ u2 v1^T) / sqrt(2): (psi_1 +- psi_2) / (s1 +- s2)
  double tilt1, tilt2;  // n v1^T and n v2^T: psi_1 / s1, psi_2 / s2
};

[[gnu::always_inline]] inline Spectrum stvk_spectrum(double mu, double lambda, double s1, double s2) {
  const double p = s1 * s1, q = s2 * s2, j = s1 * s2;
  const double common = 0.5 * lambda * (p + q - 2) - mu;
  Spectrum m;
  m.tilt1 = common + mu * p;
  m.tilt2 = common + mu * q;
  m.first1 = m.tilt1 * s1;
  m.first2 = m.tilt2 * s2;
  m.stretch11 = m.tilt1 + (2 * mu + lambda) * p;
  m.stretch22 = m.tilt2 + (2 * mu + lambda) * q;
  m.stretch12 = lambda * j;
  m.twist = common + mu * (p - j + q);
  m.flip = common + mu * (p + j + q);
  return m;
}

[[gnu::always_inline]] inline Spectrum neo_hookean_spectrum(double mu, double lambda, double s1, double s2) {
  const double k = lambda + mu, j = s1 * s2;
  const double slope = k * (j - 1) - mu;  // d psi / dJ
  // At zero stretch the ridge of psi makes these two minus infinity; any large finite value serves.
  const double floor1 = s1 < 1e-12 ? 1e-12 : s1, floor2 = s2 < 1e-12 ? 1e-12 : s2;
  Spectrum m;
  m.first1 = mu * s1 + slope * s2;
  m.first2 = mu * s2 + slope * s1;
  m.stretch11 = mu + k * s2 * s2;
  m.stretch22 = mu + k * s1 * s1;
  m.stretch12 = slope + k * j;
  m.twist = mu + slope;
  m.flip = mu - slope;
  m.tilt1 = mu + slope * s2 / floor1;
  m.tilt2 = mu + slope * s1 / floor2;
  return m;
}

[[gnu::always_inline]] inline double positive(double value) { return value < 0 ? 0 : value; }

[[gnu::always_inline]] inline void clamp_to_psd(Spectrum& m) {
  m.twist = positive(m.twist);
  m.flip = positive(m.flip);
  m.tilt1 = positive(m.tilt1);
  m.tilt2 = positive(m.tilt2);
  const double mean = 0.5 * (m.stretch11 + m.stretch22), half = 0.5 * (m.stretch11 - m.stretch22);
  const double radius = std::sqrt(half * half + m.stretch12 * m.stretch12);
  const bool negative = mean - radius < 0;
  // At most one eigenvalue, mean + radius, is positive; its projector is (I + (A - mean I) / radius) / 2.
  const double scale = 0.5 * positive(mean + radius) / (radius > 0 ? radius : 1);
  m.stretch11 = negative ? scale * (radius + half) : m.stretch11;
  m.stretch22 = negative ? scale * (radius - half) : m.stretch22;
  m.stretch12 = negative ? scale * m.stretch12 : m.stretch12;
}

[[gnu::always_inline]] inline double stvk_energy(double mu, double lambda, const Vector& f, const Vector& g) {
  const double gp = 0.5 * (dot(f, f) - 1), gq = 0.5 * (dot(g, g) - 1), gr = 0.5 * dot(f, g);
  return mu * (gp * gp + gq * gq + 2 * gr * gr) + 0.5 * lambda * (gp + gq) * (gp + gq);
}

[[gnu::always_inline]] inline double neo_hookean_energy(double mu, double lambda, const Vector& f, const Vector& g) {
  const double p = dot(f, f), q = dot(g, g), r = dot(f, g);
  const Vector normal = cross(f, g);
  const double j = std::sqrt(dot(normal, normal));
  // (s1 - s2)^2 as (s1^2 - s2^2)^2 / (s1 + s2)^2, which does not cancel near rest.
  const double sum = p + q + 2 * j;
  const double difference = ((p - q) * (p - q) + 4 * r * r) / (sum > 0 ? sum : 1);
  return 0.5 * mu * difference + 0.5 * (lambda + mu) * (j - 1) * (j - 1);
}

template <bool stvk>
[[gnu::always_inline]] inline void energies(MembraneLanes& lanes) {
  for (int l = 0; l < MembraneLanes::width; ++l) {
    const Vector f = column(lanes, 0, l), g = column(lanes, 1, l);
    lanes.energy[l] = lanes.area[l] * (stvk ? stvk_energy(lanes.mu[l], lanes.lambda[l], f, g)
                                            : neo_hookean_energy(lanes.mu[l], lanes.lambda[l], f, g));
  }
}

[[gnu::always_inline]] inline void write(const Vector& v, MembraneLanes::Lane (&to)[3], int l) {
  to[0][l] = v.x;
  to[1][l] = v.y;
  to[2][l] = v.z;
}

// p u1 u1^T + q u2 u2^T + r n n^T.
[[gnu::always_inline]] inline void write_symmetric(const Svd& f, double p, double q, double r,
                                                   MembraneLanes::Lane (&to)[6], int l) {
  const Vector a = p * f.u1, b = q * f.u2, c = r * f.normal;
  to[0][l] = a.x * f.u1.x + b.x * f.u2.x + c.x * f.normal.x;
  to[1][l] = a.x * f.u1.y + b.x * f.u2.y + c.x * f.normal.y;
  to[2][l] = a.x * f.u1.z + b.x * f.u2.z + c.x * f.normal.z;
  to[3][l] = a.y * f.u1.y + b.y * f.u2.y + c.y * f.normal.y;
  to[4][l] = a.y * f.u1.z + b.y * f.u2.z + c.y * f.normal.z;
  to[5][l] = a.z * f.u1.z + b.z * f.u2.z + c.z * f.normal.z;
}

template <bool stvk, bool hessian, bool psd>
[[gnu::always_inline]] inline void densities(MembraneLanes& lanes) {
  for (int l = 0; l < MembraneLanes::width; ++l) {
    const double mu = lanes.mu[l], lambda = lanes.lambda[l];
    const Svd f = svd(column(lanes, 0, l), column(lanes, 1, l));
    Spectrum m = stvk ? stvk_spectrum(mu, lambda, f.s1, f.s2) : neo_hookean_spectrum(mu, lambda, f.s1, f.s2);
    lanes.axis_a[0][l] = lanes.axis_b[1][l] = f.c;
    lanes.axis_a[1][l] = f.s;
    lanes.axis_b[0][l] = -f.s;
    write(m.first1 * f.u1, lanes.stress_a, l);
    write(m.first2 * f.u2, lanes.stress_b, l);
    if (!hessian) continue;
    if (psd) clamp_to_psd(m);
    const double shear = 0.5 * (m.twist + m.flip), swap = 0.5 * (m.flip - m.twist);
    write_symmetric(f, m.stretch11, shear, m.tilt1, lanes.aa, l);
    write_symmetric(f, shear, m.stretch22, m.tilt2, lanes.bb, l);
    const double u1[3] = {f.u1.x, f.u1.y, f.u1.z}, u2[3] = {f.u2.x, f.u2.y, f.u2.z};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) lanes.ab[3 * i + j][l] = m.stretch12 * u1[i] * u2[j] + swap * u2[i] * u1[j];
  }
}

}  // namespace

// One clone of each an instruction set, as in physics/linear/pcg_kernels.cpp.

SELVEDGE_CLONES void isotropic_energies(MembraneModel model, MembraneLanes& lanes) {
  if (model == MembraneModel::stvk)
    energies<true>(lanes);
  else
    energies<false>(lanes);
}

SELVEDGE_CLONES void isotropic_densities(MembraneModel model, bool hessian, bool psd, MembraneLanes& lanes) {
  const bool stvk = model == MembraneModel::stvk;
  if (!hessian)
    stvk ? densities<true, false, false>(lanes) : densities<false, false, false>(lanes);
  else if (psd)
    stvk ? densities<true, true, true>(lanes) : densities<false, true, true>(lanes);
  else
    stvk ? densities<true, true, false>(lanes) : densities<false, true, false>(lanes);
}

}  // namespace selvedge
