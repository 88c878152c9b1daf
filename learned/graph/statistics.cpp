#include "learned/graph/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {

bool are_blank(const Statistics& statistics) {
  return std::ranges::all_of(statistics.mean, [](float m) { return m == 0; }) &&
         std::ranges::all_of(statistics.deviation, [](float d) { return d == 1; });
}

template <class Real>
void accumulate(BasicAccumulators<Real>& sums, const FeatureRows& raw) {
  if (sums.updates >= most_updates) return;
  for (std::size_t column = 0; column < sums.sum.size(); ++column) {
    double sum = 0, squared = 0;
    for (Eigen::Index i = 0; i < raw.rows(); ++i) {
      const double value = raw(i, static_cast<Eigen::Index>(column));
      sum += value;
      squared += value * value;
    }
    sums.sum[column] += static_cast<Real>(sum);
    sums.sum_squared[column] += static_cast<Real>(squared);
  }
  sums.rows += static_cast<Real>(raw.rows());
  sums.updates += 1;
}

template <class Real>
Statistics statistics_of(const BasicAccumulators<Real>& sums) {
  constexpr Real floor = static_cast<Real>(1e-8);
  const std::size_t columns = sums.sum.size();
  Statistics result{std::vector<float>(columns, 0), std::vector<float>(columns, static_cast<float>(floor))};
  if (sums.rows <= 0) return result;
  for (std::size_t column = 0; column < columns; ++column) {
    const Real mean = sums.sum[column] / sums.rows;
    const Real of_squares = sums.sum_squared[column] / sums.rows;
    const Real square = mean * mean;
    const Real variance = of_squares - square;
    result.mean[column] = static_cast<float>(mean);
    result.deviation[column] = static_cast<float>(std::max(std::sqrt(std::max(variance, Real(0))), floor));
  }
  return result;
}

void normalise(const Statistics& statistics, FeatureRows& rows) {
  const auto columns = static_cast<Eigen::Index>(statistics.mean.size());
  const Eigen::Map<const Eigen::Array<float, 1, Eigen::Dynamic>> mean(statistics.mean.data(), columns),
      deviation(statistics.deviation.data(), columns);
#pragma omp parallel for schedule(static)
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    Eigen::Map<Eigen::Array<float, 1, Eigen::Dynamic>> features(rows.row(i).data(), columns);
    features = (features - mean) / deviation;
  }
}

template void accumulate(BasicAccumulators<float>&, const FeatureRows&);
template void accumulate(BasicAccumulators<double>&, const FeatureRows&);
template Statistics statistics_of(const BasicAccumulators<float>&);
template Statistics statistics_of(const BasicAccumulators<double>&);

}  // namespace selvedge
