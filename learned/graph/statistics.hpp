#pragma once

#include <vector>

#include "learned/graph/graph.hpp"

namespace selvedge {

// Mean and standard deviation of each normalised column. A column's feature is (raw - mean) / deviation.
struct Statistics {
  std::vector<float> mean, deviation;
};

// Whether nothing was ever gathered for them: mean 0 and deviation 1 everywhere, as weights begin.
bool are_blank(const Statistics&);

// What is summed up of the normalised columns of a feature set while a network is trained. Float holds what the
// authors' checkpoints hold; own training sums in double.
template <class Real>
struct BasicAccumulators {
  Real rows = 0, updates = 0;
  std::vector<Real> sum, sum_squared;  // one a column

  explicit BasicAccumulators(int columns = 0) : sum(columns, 0), sum_squared(columns, 0) {}
};
using Accumulators = BasicAccumulators<float>;
using DoubleAccumulators = BasicAccumulators<double>;

constexpr int most_updates = 1000000;  // after so many nothing more is summed up

// Adds the first columns of the rows, as many as there are sums. Counted as an update without rows too; nothing happens
// after `most_updates`. A batch is summed in double and rounded once.
template <class Real>
void accumulate(BasicAccumulators<Real>&, const FeatureRows& raw);

// mean = sum / rows, deviation = sqrt(max(sum_squared / rows - mean^2, 0)), at least 1e-8. Each operation is rounded to
// Real on its own: in a nearly constant column this rounding is the deviation (parity README, 9). Without rows: mean 0,
// deviation 1e-8.
template <class Real>
Statistics statistics_of(const BasicAccumulators<Real>&);

// Normalises the first columns of the rows in place, as many as there are statistics.
void normalise(const Statistics&, FeatureRows&);

}  // namespace selvedge
