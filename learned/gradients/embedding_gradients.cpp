#include "learned/gradients/embedding_gradients.hpp"

#include "learned/graph/make_graph.hpp"

namespace selvedge {
namespace {

// Sums the rows of each value first, because there are few values.
template <class ValueOf>
void add_table_gradient(const ValueOf& value_of, Eigen::Index rows, const LatentRows& d_first,
                        const FeatureRows& first_layer, const Statistics& statistics, int column,
                        FeatureRows& gradient) {
  FeatureRows sums = FeatureRows::Zero(gradient.rows(), first_layer.rows());
  for (Eigen::Index i = 0; i < rows; ++i)
    sums.row(value_of(i)) += Eigen::Map<const Eigen::RowVectorXf>(d_first.row(static_cast<int>(i)), first_layer.rows());
  const FeatureRows by_feature = sums * first_layer.middleCols(column, gradient.cols());
  for (Eigen::Index k = 0; k < gradient.cols(); ++k) {
    const auto at = static_cast<std::size_t>(column + k);
    const float deviation = at < statistics.deviation.size() ? statistics.deviation[at] : 1.f;
    gradient.col(k) += by_feature.col(k) / deviation;
  }
}

}  // namespace

void add_node_gradients(const Architecture& a, const Graph& graph, const FeatureRows& first_layer,
                        const FeatureTables& tables, const LatentRows& d_first, FeatureTables& gradients) {
  const EmbeddingColumns columns = embedding_columns(a.features);
  const Eigen::Index rows = graph.nodes.rows();
  const auto add = [&](const std::vector<int>& values, int column, int wanted, FeatureRows& gradient) {
    if (gradient.cols() == 0 || gradient.cols() != wanted || static_cast<Eigen::Index>(values.size()) != rows) return;
    add_table_gradient([&](Eigen::Index i) { return values[static_cast<std::size_t>(i)]; }, rows, d_first, first_layer,
                       tables.node, column, gradient);
  };
  add(graph.node_types, columns.type, a.features.type_columns, gradients.node_type);
  add(graph.node_levels, columns.level, a.features.level_columns, gradients.vertex_level);
}

void add_label_gradients(const Architecture& a, const EdgeSet& set, const std::vector<int>& order,
                         const FeatureRows& first_layer, const FeatureTables& tables, const LatentRows& d_first,
                         FeatureTables& gradients) {
  if (set.labels.empty() || set.labels.size() != order.size() || gradients.edge_type.cols() == 0 ||
      gradients.edge_type.cols() != a.features.label_columns)
    return;
  add_table_gradient(
      [&](Eigen::Index i) { return set.labels[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])]; },
      static_cast<Eigen::Index>(order.size()), d_first, first_layer, statistics_for(set.key, a.features, tables),
      embedding_columns(a.features).label, gradients.edge_type);
}

}  // namespace selvedge
