#pragma once

#include <vector>

#include "learned/graph/graph.hpp"

namespace selvedge {

// Mean and standard deviation of each normalised column. A column's feature is (raw - mean) / deviation.
struct Statistics {
  std::vector<float> mean, deviation;
};

// Whether they are as weights begin, mean 0 and deviation 1 everywhere, because nothing was gathered.
bool are_blank(const Statistics&);

// Sums of the normalised columns of a feature set in training. Authors' checkpoints hold them as float. Own training
// sums in double.
template <class Real>
struct BasicAccumulators {
  Real rows = 0, updates = 0;
  std::vector<Real> sum, sum_squared;  // one per column

  explicit BasicAccumulators(int columns = 0) : sum(columns, 0), sum_squared(columns, 0) {}
};
using Accumulators = BasicAccumulators<float>;
using DoubleAccumulators = BasicAccumulators<double>;

constexpr int most_updates = 1000000;  // later updates are ignored

// Adds the first columns of the rows, as many as there are sums. It counts as an update without rows too, and does
// nothing after `most_updates`. A batch is summed in double and rounded once.
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
