#include "pipeline/shapes/implicit_form.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace selvedge {
namespace {

constexpr std::array columns{&LoftSection::u_low, &LoftSection::u_high, &LoftSection::v_low, &LoftSection::v_high};

// The p-norm of scaled coordinates minus 1, divided by the length of its gradient.
double scaled_norm_value(const Vec3& q, const Vec3& radii, double exponent) {
  const Vec3 s = q.cwiseQuotient(radii).cwiseAbs();
  const double norm = exponent == 2 ? s.norm() : std::pow(s.array().pow(exponent).sum(), 1 / exponent);
  if (norm < 1e-6) return -radii.minCoeff();
  const Vec3 powers = exponent == 2 ? Vec3(s / norm) : Vec3((s / norm).array().pow(exponent - 1));
  return (norm - 1) / powers.cwiseQuotient(radii).norm();
}

LoftSection section_at(const Loft& loft, double at) {
  const auto& list = loft.sections;
  std::size_t k = 0;
  while (k + 2 < list.size() && at > list[k + 1].at) ++k;
  const double h = list[k + 1].at - list[k].at, t = (at - list[k].at) / h;
  const double h00 = (1 + 2 * t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t);
  LoftSection section{at, 0, 0, 0, 0};
  for (const auto column : columns)
    section.*column = h00 * (list[k].*column) + h10 * h * (loft.slopes[k].*column) + (1 - h00) * (list[k + 1].*column) +
                      t * t * (t - 1) * h * (loft.slopes[k + 1].*column);
  return section;
}

double value(const Loft& loft, const Vec3& p) {
  const int u = (loft.axis + 1) % 3, v = (loft.axis + 2) % 3;
  const double low = loft.sections.front().at, high = loft.sections.back().at, s = p[loft.axis];
  const double at = std::clamp(s, low, high);
  const LoftSection section = section_at(loft, at);
  const Vec3 q(p[u] - (section.u_low + section.u_high) / 2, p[v] - (section.v_low + section.v_high) / 2, s - at);
  const Vec3 radii((section.u_high - section.u_low) / 2, (section.v_high - section.v_low) / 2,
                   s < low ? loft.cap_low : loft.cap_high);
  return scaled_norm_value(q, radii, loft.exponent);
}

double value(const Ellipsoid& e, const Vec3& p) {
  return scaled_norm_value(e.axes.transpose() * (p - e.centre), e.radii, 2);
}

double value(const Cone& cone, const Vec3& p) {
  const Vec3 axis = cone.to - cone.from;
  const double t = std::clamp((p - cone.from).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return (p - cone.from - t * axis).norm() - (1 - t) * cone.from_radius - t * cone.to_radius;
}

double value(const Solid& solid, const Vec3& p) {
  return std::visit([&](const auto& kind) { return value(kind, p); }, solid);
}

Vec3 mirrored(const Vec3& p) { return {-p.x(), p.y(), p.z()}; }

using Bounds = Eigen::AlignedBox3d;

Bounds bounds(const Loft& loft) {
  Bounds box;
  const int u = (loft.axis + 1) % 3, v = (loft.axis + 2) % 3;
  for (const LoftSection& section : loft.sections)
    for (const double end : {-loft.cap_low, loft.cap_high}) {
      Vec3 low, high;
      low[loft.axis] = high[loft.axis] = section.at + end;
      low[u] = section.u_low;
      high[u] = section.u_high;
      low[v] = section.v_low;
      high[v] = section.v_high;
      box.extend(low);
      box.extend(high);
    }
  return box;
}

Bounds bounds(const Ellipsoid& e) {
  const Vec3 reach = (e.axes * e.radii.asDiagonal()).rowwise().norm();
  return {e.centre - reach, e.centre + reach};
}

Bounds bounds(const Cone& cone) {
  Bounds box(cone.from.array() - cone.from_radius, cone.from.array() + cone.from_radius);
  return box.merged(Bounds(cone.to.array() - cone.to_radius, cone.to.array() + cone.to_radius));
}

// Values are at most the distance. Parts farther than the blend, with a margin for that, are skipped.
double value(const Limb& limb, const Vec3& p) {
  constexpr double nothing = 1e3, room = 0.02;
  double all = nothing;
  for (const Part& part : limb.parts) {
    const double reach = (part.cut ? std::abs(all) : all) + 2 * part.blend + room;
    const auto one_side = [&](const Vec3& q) {
      const bool is_far = part.bounds.squaredExteriorDistance(q) > reach * std::abs(reach);
      return is_far ? nothing : value(part.solid, q);
    };
    double one = one_side(p);
    if (part.paired) one = merged(one, one_side(mirrored(p)), part.blend);
    all = part.cut ? -merged(-all, one, part.blend) : merged(all, one, all == nothing ? 0 : part.blend);
  }
  return all;
}

}  // namespace

Loft make_loft(int axis, double cap_low, double cap_high, double exponent, std::vector<LoftSection> sections) {
  assert(sections.size() >= 2);
  Loft loft{axis, cap_low, cap_high, exponent, std::move(sections), {}};
  const auto& list = loft.sections;
  loft.slopes.assign(list.size(), LoftSection{});
  for (std::size_t k = 1; k + 1 < list.size(); ++k)
    for (const auto column : columns) {
      const double h0 = list[k].at - list[k - 1].at, h1 = list[k + 1].at - list[k].at;
      const double d0 = (list[k].*column - list[k - 1].*column) / h0;
      const double d1 = (list[k + 1].*column - list[k].*column) / h1;
      if (d0 * d1 <= 0) continue;
      const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
      loft.slopes[k].*column = (w0 + w1) / (w0 / d0 + w1 / d1);
    }
  return loft;
}

Form make_form(std::vector<Limb> limbs) {
  for (Limb& limb : limbs)
    for (Part& part : limb.parts) part.bounds = std::visit([](const auto& kind) { return bounds(kind); }, part.solid);
  return {std::move(limbs)};
}

double signed_value(const Form& form, const Vec3& p) {
  double all = 0;
  for (std::size_t k = 0; k < form.limbs.size(); ++k) {
    const Limb& limb = form.limbs[k];
    double one = value(limb, p);
    if (limb.paired) one = merged(one, value(limb, mirrored(p)), limb.blend);
    all = k == 0 ? one : merged(all, one, limb.blend);
  }
  return all;
}

double merged(double a, double b, double blend) {
  if (blend <= 0) return std::min(a, b);
  const double h = std::max(blend - std::abs(a - b), 0.0);
  return std::min(a, b) - h * h / (4 * blend);
}

Vec3 projected(const std::function<double(const Vec3&)>& value, const Vec3& p) {
  Vec3 q = p;
  for (int round = 0; round < 4; ++round) {
    const double distance = value(q);
    if (std::abs(distance) < 1e-6) break;
    constexpr double difference = 1e-6;
    Vec3 g;
    for (int k = 0; k < 3; ++k) g[k] = (value(q + difference * Vec3::Unit(k)) - distance) / difference;
    Vec3 step = -distance * g / std::max(g.squaredNorm(), 0.25);
    constexpr double longest = 0.01;
    if (step.norm() > longest) step *= longest / step.norm();
    q += step;
  }
  return q;
}

Vec3 projected(const Form& form, const Vec3& p) {
  return projected([&](const Vec3& q) { return signed_value(form, q); }, p);
}

}  // namespace selvedge
