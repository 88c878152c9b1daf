#pragma once

#include <Eigen/Core>

#include "learned/graph/graph.hpp"

namespace selvedge {

using RowsView = Eigen::Ref<const FeatureRows>;

// Products of matrices stored by rows. They are compiled only here, because each use of Eigen's product takes seconds
// to compile.
FeatureRows product(const RowsView& a, const RowsView& b);                                       // a b
FeatureRows product_transposed(const RowsView& a, const RowsView& b);                            // a b^T
void add_transposed_product(const RowsView& a, const RowsView& b, Eigen::Ref<FeatureRows> sum);  // sum += a^T b

}  // namespace selvedge
