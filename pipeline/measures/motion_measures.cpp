#include "pipeline/measures/motion_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/energies/measures.hpp"

namespace selvedge {

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

StrainMeasure strain_of(const Scene& scene, const Points& x) {
  const auto stretches = principal_stretches(scene, x);
  std::vector<double> strains;
  for (const double s : stretches.reshaped()) strains.push_back(std::abs(s - 1));
  if (strains.empty()) return {};
  StrainMeasure measure;
  for (const double s : strains) measure.mean += s;
  measure.mean /= static_cast<double>(strains.size());
  measure.most = *std::ranges::max_element(strains);
  measure.p99 = percentile(std::move(strains), 0.99);
  return measure;
}

double MotionTrace::add(const Points& x) {
  double squared = 0;
  if (x3.rows() == x.rows()) squared = ((x - 2 * x1 + x2) - (x1 - 2 * x2 + x3)).rowwise().squaredNorm().mean();
  x3 = std::move(x2);
  x2 = std::move(x1);
  x1 = x;
  return squared;
}

void MotionSpectrum::add(const Points& all) {
  constexpr Eigen::Index most = 500;
  const Eigen::Index count = std::min(all.rows(), most);
  Points some(count, 3);
  for (Eigen::Index k = 0; k < count; ++k) some.row(k) = all.row(k * all.rows() / count);
  x.push_back(std::move(some));
}

std::vector<double> MotionSpectrum::power() const {
  if (x.size() < 3) return {};
  const std::size_t frames = x.size() - 1;
  std::vector<double> result(frames / 2 + 1, 0);
  const double vertices = std::max<double>(1, static_cast<double>(x[0].rows()));
  for (std::size_t k = 1; k < result.size(); ++k) {
    Points cosines = Points::Zero(x[0].rows(), 3), sines = cosines;
    for (std::size_t f = 0; f < frames; ++f) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k * f % frames) / static_cast<double>(frames);
      const Points velocity = x[f + 1] - x[f];
      cosines += std::cos(angle) * velocity;
      sines += std::sin(angle) * velocity;
    }
    const double both = 2 * k == frames ? 1 : 2;  // the frequency and its negative
    result[k] = both * (cosines.squaredNorm() + sines.squaredNorm()) /
                (vertices * static_cast<double>(frames) * static_cast<double>(frames));
  }
  return result;
}

double MotionSpectrum::high_share() const {
  const std::vector<double> all = power();
  double sum = 0, high = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    sum += all[k];
    if (4 * k > x.size() - 1) high += all[k];
  }
  return sum > 0 ? high / sum : 0;
}

}  // namespace selvedge
