#include "learned/network/dense_products.hpp"

namespace selvedge {

FeatureRows product(const RowsView& a, const RowsView& b) { return a * b; }

FeatureRows product_transposed(const RowsView& a, const RowsView& b) { return a * b.transpose(); }

void add_transposed_product(const RowsView& a, const RowsView& b, Eigen::Ref<FeatureRows> sum) {
  sum.noalias() += a.transpose() * b;
}

}  // namespace selvedge
