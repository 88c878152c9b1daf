#include <algorithm>
#include <cassert>
#include <cmath>

#include "physics/membrane_density.hpp"

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
namespace selvedge {
namespace {

struct Svd {  // F = s1 u1 v1^T + s2 u2 v2^T, normal = u1 x u2; V = [v1 v2] is a rotation
  double s1, s2;
  Vec3 u1, u2, normal;
  Eigen::Matrix2d V;
};

Vec3 any_perpendicular(const Vec3& unit) {
  Vec3::Index smallest;
  unit.cwiseAbs().minCoeff(&smallest);
  return unit.cross(Vec3::Unit(smallest)).normalized();
}

// One-sided Jacobi: exact orthogonality of u1 and u2 also where s2 is 0 or equals s1.
Svd svd(const Mat32& F) {
  const double p = F.col(0).squaredNorm(), q = F.col(1).squaredNorm(), r = F.col(0).dot(F.col(1));
  const double half = 0.5 * (p - q), length = std::sqrt(half * half + r * r);
  double c = 1, s = 0;  // v1 is the half angle of (half, r), so that s1 >= s2
  if (length > 0) {
    if (half >= 0) {
      c = std::sqrt(0.5 * (1 + half / length));
      s = 0.5 * r / (length * c);
    } else {
      s = std::copysign(std::sqrt(0.5 * (1 - half / length)), r);
      c = 0.5 * r / (length * s);
    }
  }
  Svd result;
  result.V << c, -s, s, c;
  const Vec3 g1 = F.col(0) * c + F.col(1) * s, g2 = F.col(1) * c - F.col(0) * s;
  result.s1 = g1.norm();
  result.u1 = result.s1 > 0 ? Vec3(g1 / result.s1) : Vec3::UnitX();
  const Vec3 across = g2 - result.u1.dot(g2) * result.u1;
  result.s2 = across.norm();
  // Below rounding of s1 the direction of `across` is noise that need not be perpendicular to u1.
  result.u2 = result.s2 > 1e-14 * result.s1 ? Vec3(across / result.s2) : any_perpendicular(result.u1);
  result.normal = result.u1.cross(result.u2);
  return result;
}

// First derivatives of psi in s, and the Hessian's eigenvalues: the stretch block, then one for each other mode.
struct Spectrum {
  double first1, first2;
  double stretch11, stretch12, stretch22;
  double twist, flip;   // (u1 v2^T -+ u2 v1^T) / sqrt(2): (psi_1 +- psi_2) / (s1 +- s2)
  double tilt1, tilt2;  // n v1^T and n v2^T: psi_1 / s1, psi_2 / s2
};

Spectrum stvk_spectrum(double mu, double lambda, double s1, double s2) {
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

Spectrum neo_hookean_spectrum(double mu, double lambda, double s1, double s2) {
  const double k = lambda + mu, j = s1 * s2;
  const double slope = k * (j - 1) - mu;  // d psi / dJ
  // At zero stretch the ridge of psi makes these two minus infinity; any large finite value serves.
  const double floor1 = std::max(s1, 1e-12), floor2 = std::max(s2, 1e-12);
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

void clamp_to_psd(Spectrum& m) {
  m.twist = std::max(m.twist, 0.0);
  m.flip = std::max(m.flip, 0.0);
  m.tilt1 = std::max(m.tilt1, 0.0);
  m.tilt2 = std::max(m.tilt2, 0.0);
  const double mean = 0.5 * (m.stretch11 + m.stretch22), half = 0.5 * (m.stretch11 - m.stretch22);
  const double radius = std::sqrt(half * half + m.stretch12 * m.stretch12);
  if (mean - radius >= 0) return;
  // At most one eigenvalue, mean + radius, is positive; its projector is (I + (A - mean I) / radius) / 2.
  const double scale = mean + radius > 0 ? 0.5 * (mean + radius) / radius : 0;
  m.stretch11 = scale * (radius + half);
  m.stretch22 = scale * (radius - half);
  m.stretch12 *= scale;
}

}  // namespace

MembraneDensity isotropic_density(const Material& material, const Mat32& F, bool hessian, bool psd) {
  const double mu = material.lame_mu, lambda = material.lame_lambda;
  const Svd f = svd(F);
  Spectrum m = material.membrane == MembraneModel::stvk ? stvk_spectrum(mu, lambda, f.s1, f.s2)
                                                        : neo_hookean_spectrum(mu, lambda, f.s1, f.s2);
  MembraneDensity density;
  density.energy = isotropic_energy(material, F);
  density.axes = f.V;
  density.stress_a = m.first1 * f.u1;
  density.stress_b = m.first2 * f.u2;
  if (!hessian) return density;
  if (psd) clamp_to_psd(m);
  const double shear = 0.5 * (m.twist + m.flip), swap = 0.5 * (m.flip - m.twist);
  const Mat3 uu1 = f.u1 * f.u1.transpose(), uu2 = f.u2 * f.u2.transpose(), nn = f.normal * f.normal.transpose();
  const Mat3 u12 = f.u1 * f.u2.transpose();
  density.hessian_aa = m.stretch11 * uu1 + shear * uu2 + m.tilt1 * nn;
  density.hessian_bb = shear * uu1 + m.stretch22 * uu2 + m.tilt2 * nn;
  density.hessian_ab = m.stretch12 * u12 + swap * u12.transpose();
  return density;
}

double isotropic_energy(const Material& material, const Mat32& F) {
  const double mu = material.lame_mu, lambda = material.lame_lambda;
  const double p = F.col(0).squaredNorm(), q = F.col(1).squaredNorm(), r = F.col(0).dot(F.col(1));
  if (material.membrane == MembraneModel::stvk) {
    const double gp = 0.5 * (p - 1), gq = 0.5 * (q - 1), gr = 0.5 * r;
    return mu * (gp * gp + gq * gq + 2 * gr * gr) + 0.5 * lambda * (gp + gq) * (gp + gq);
  }
  assert(material.membrane == MembraneModel::stable_neo_hookean);
  const double j = F.col(0).cross(F.col(1)).norm();
  // (s1 - s2)^2 as (s1^2 - s2^2)^2 / (s1 + s2)^2, which does not cancel near rest.
  const double sum = p + q + 2 * j;
  const double difference = sum > 0 ? ((p - q) * (p - q) + 4 * r * r) / sum : 0;
  return 0.5 * mu * difference + 0.5 * (lambda + mu) * (j - 1) * (j - 1);
}

}  // namespace selvedge
