#include "learned/repulsion/drape_network.hpp"

#include <cassert>
#include <cmath>

#include "collision/geometry/factorisations.hpp"
#include "learned/network/dense_products.hpp"

namespace selvedge {
namespace {

// The truth's displacement from the rest shape, in garment space.
Points garment_displacement(const DrapeCase& drape) {
  Points result(drape.rest.rows(), 3);
  for (int v = 0; v < result.rows(); ++v) {
    const VertexFrame& frame = drape.frames[static_cast<std::size_t>(v)];
    const Vec3 there = Mat3(frame.leftCols<3>()).inverse() * (row(drape.truth, v) - frame.col(3));
    result.row(v) = there.transpose() - drape.rest.row(v);
  }
  return result;
}

void set_input_scales(std::span<const DrapeCase* const> cases, DrapeNetwork& made) {
  constexpr double constant = 1e-6;
  const std::size_t inputs = cases[0]->inputs.size();
  const auto count = static_cast<double>(cases.size());
  for (std::size_t k = 0; k < inputs; ++k) {
    double mean = 0, square = 0;
    for (const DrapeCase* drape : cases) mean += static_cast<double>(drape->inputs[k]) / count;
    for (const DrapeCase* drape : cases) square += std::pow(static_cast<double>(drape->inputs[k]) - mean, 2) / count;
    made.input_mean.push_back(static_cast<float>(mean));
    made.input_scale.push_back(square > constant * constant ? static_cast<float>(1 / std::sqrt(square)) : 0.0f);
  }
}

}  // namespace

DrapeNetwork make_drape_network(const DrapeShape& shape, std::span<const DrapeCase* const> cases, std::uint64_t seed) {
  assert(!cases.empty());
  DrapeNetwork made;
  set_input_scales(cases, made);
  for (std::size_t k = 0; k < shape.unread.size(); ++k)
    if (shape.unread[k]) made.input_scale[k] = 0;
  made.mean = Points::Zero(cases[0]->rest.rows(), 3);
  for (const DrapeCase* drape : cases) made.mean += garment_displacement(*drape) / static_cast<double>(cases.size());
  PlainShape plain;
  plain.inputs = static_cast<int>(cases[0]->inputs.size());
  plain.outputs.assign(static_cast<std::size_t>(std::max(shape.layers - 1, 0)), shape.width);
  if (shape.mesh.levels > 0) {
    assert(shape.ring && shape.ring->vertex_count() == made.mean.rows());
    made.mesh = make_mesh_layers(*shape.ring, shape.mesh, seed + 1);
    made.mesh.back().kernels.layers[0].weight *= static_cast<float>(shape.last_scale);
  }
  plain.outputs.push_back(made.mesh.empty() ? static_cast<int>(made.mean.size())
                                            : made.mesh[0].sources * made.mesh[0].channels_in());
  made.plain = make_plain_network(plain, seed);
  if (made.mesh.empty()) made.plain.layers.back().weight *= static_cast<float>(shape.last_scale);
  return made;
}

void fit_linear_part(std::span<const DrapeCase* const> cases, double ridge, std::span<const double> trust,
                     DrapeNetwork& network) {
  Eigen::MatrixXd read = drape_inputs(network, cases).cast<double>();
  for (std::size_t k = 0; k < trust.size(); ++k) read.col(static_cast<Eigen::Index>(k)) *= trust[k];
  Eigen::MatrixXd wanted(read.rows(), network.mean.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Points apart = (garment_displacement(*cases[i]) - network.mean) / network.unit;
    wanted.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXd>(apart.data(), apart.size());
  }
  Eigen::MatrixXd products = read * read.transpose();
  network.linear = Eigen::MatrixXf::Zero(wanted.cols(), read.cols());
  if (!(products.trace() > 0)) return;  // nothing is read
  products.diagonal().array() += ridge * products.trace() / static_cast<double>(read.rows());
  Eigen::MatrixXd fitted = solve_symmetric(products, wanted).transpose() * read;
  for (std::size_t k = 0; k < trust.size(); ++k) fitted.col(static_cast<Eigen::Index>(k)) *= trust[k];
  network.linear = fitted.cast<float>();
}

FeatureRows drape_outputs(const DrapeNetwork& network, const FeatureRows& inputs) {
  FeatureRows outputs = evaluate(network.mesh, evaluate(network.plain, inputs));
  // A column-major matrix is the row-major transpose.
  const Eigen::Map<const FeatureRows> transposed(network.linear.data(), network.linear.cols(), network.linear.rows());
  if (network.linear.size() > 0) outputs += product(inputs, transposed);
  return outputs;
}

FeatureRows drape_inputs(const DrapeNetwork& network, std::span<const DrapeCase* const> cases) {
  FeatureRows rows(static_cast<Eigen::Index>(cases.size()), static_cast<Eigen::Index>(network.input_mean.size()));
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (std::size_t k = 0; k < network.input_mean.size(); ++k)
      rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          (cases[i]->inputs[k] - network.input_mean[k]) * network.input_scale[k];
  return rows;
}

Points drape_positions(const DrapeNetwork& network, const DrapeCase& drape, const FeatureRows& outputs,
                       Eigen::Index which) {
  Points x(drape.rest.rows(), 3);
  for (int v = 0; v < x.rows(); ++v) {
    const Vec3 there = row(drape.rest, v) + row(network.mean, v) +
                       network.unit * outputs.row(which).segment<3>(3 * v).transpose().cast<double>();
    const VertexFrame& frame = drape.frames[static_cast<std::size_t>(v)];
    x.row(v) = (frame.leftCols<3>() * there + frame.col(3)).transpose();
  }
  return x;
}

Points drape_positions(const DrapeNetwork& network, const DrapeCase& drape) {
  const DrapeCase* const one = &drape;
  return drape_positions(network, drape, drape_outputs(network, drape_inputs(network, {&one, 1})), 0);
}

Eigen::RowVectorXf by_drape_outputs(const DrapeNetwork& network, const DrapeCase& drape, const Points& by_positions) {
  Eigen::RowVectorXf result(by_positions.size());
  for (int v = 0; v < by_positions.rows(); ++v)
    result.segment<3>(3 * v) =
        (network.unit * by_positions.row(v) * drape.frames[static_cast<std::size_t>(v)].leftCols<3>()).cast<float>();
  return result;
}

}  // namespace selvedge
