#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/energies/membrane_density.hpp"

// Baraff-Witkin cloth in the I5/I6 form of Kim 2020, "A finite element formulation of Baraff-Witkin cloth":
//   psi = warp / 2 (|a| - 1)^2 + weft / 2 (|b| - 1)^2 + shear / 2 (a . b)^2,   a = F u, b = F v.
// Each of the three terms is projected by its own closed-form eigen-system.
namespace selvedge {
namespace {

// k / 2 (|f| - 1)^2: eigenvalue k along f, k (1 - 1 / |f|) across it (twice), negative under compression.
void add_stretch(double k, const Vec3& f, bool psd, Vec3& stress, Mat3& hessian) {
  const double length = f.norm();
  if (!(length > 0)) {  // the tip of the cone has no direction to push in
    hessian.setZero();
    stress.setZero();
    return;
  }
  const Vec3 unit = f / length;
  stress = k * (length - 1) * unit;
  double across = k * (1 - 1 / length);
  if (psd) across = std::max(across, 0.0);
  hessian = across * Mat3::Identity() + (k - across) * unit * unit.transpose();
}

// k / 2 s^2, s = a . b. In c = (a + b) / sqrt(2), d = (b - a) / sqrt(2) the Hessian is k [sI + cc^T, cd^T; dc^T, -sI +
// dd^T] on the modes (q, q) / sqrt(2) and (q, -q) / sqrt(2): eigenvalues s (q across c), -s (q across d), and those of
// [s + c^2, cd; cd, d^2 - s], of which one is positive and one negative.
void add_shear(double k, const Vec3& a, const Vec3& b, bool psd, MembraneDensity& density) {
  const double s = a.dot(b);
  if (!psd) {
    density.hessian_aa += k * b * b.transpose();
    density.hessian_bb += k * a * a.transpose();
    density.hessian_ab += k * (s * Mat3::Identity() + b * a.transpose());
    return;
  }
  constexpr double half_root = 0.5 * std::numbers::sqrt2;
  const Vec3 c = (a + b) * half_root, d = (b - a) * half_root;
  const double cc = c.squaredNorm(), dd = d.squaredNorm();
  const double mean = 0.5 * (cc + dd), radius = std::sqrt(4 * s * s + cc * dd);  // half the diagonal's difference: 2 s
  if (!(radius > 0)) return;
  const Vec3 c_unit = cc > 0 ? Vec3(c / std::sqrt(cc)) : Vec3::Zero();
  const Vec3 d_unit = dd > 0 ? Vec3(d / std::sqrt(dd)) : Vec3::Zero();
  const double top = 0.5 * (mean + radius) / radius;
  Mat3 plus = top * (radius + 2 * s) * c_unit * c_unit.transpose();
  Mat3 minus = top * (radius - 2 * s) * d_unit * d_unit.transpose();
  const Mat3 mixed = top * c * d.transpose();
  if (s > 0)
    plus += s * (Mat3::Identity() - c_unit * c_unit.transpose());
  else
    minus -= s * (Mat3::Identity() - d_unit * d_unit.transpose());
  density.hessian_aa += 0.5 * k * (plus + minus + mixed + mixed.transpose());
  density.hessian_bb += 0.5 * k * (plus + minus - mixed - mixed.transpose());
  density.hessian_ab += 0.5 * k * (plus - minus - mixed + mixed.transpose());
}

}  // namespace

MembraneDensity baraff_witkin_density(const Material& material, const Mat32& F, bool hessian, bool psd) {
  const Vec3 a = F.col(0), b = F.col(1);
  MembraneDensity density;
  density.axes.setIdentity();
  add_stretch(material.warp, a, psd, density.stress_a, density.hessian_aa);
  add_stretch(material.weft, b, psd, density.stress_b, density.hessian_bb);
  const double s = material.shear * a.dot(b);
  density.stress_a += s * b;
  density.stress_b += s * a;
  if (!hessian) return density;
  density.hessian_ab.setZero();
  add_shear(material.shear, a, b, psd, density);
  return density;
}

double baraff_witkin_energy(const Material& material, const Mat32& F) {
  const double u = F.col(0).norm() - 1, v = F.col(1).norm() - 1, s = F.col(0).dot(F.col(1));
  return 0.5 * (material.warp * u * u + material.weft * v * v + material.shear * s * s);
}

}  // namespace selvedge
