#include "physics/steppers/fit_carried.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

using Gram = CarriedFit::Gram;
using OfVertex = CarriedFit::OfVertex;

constexpr double least_ridge = 1e-9;  // of the mean diagonal, for terms that are 0 or the same in all frames

OfVertex sum_of(const CarriedFit& fit) {
  OfVertex sum;
  for (const OfVertex& one : fit.vertices) {
    sum.gram += one.gram;
    sum.moment += one.moment;
    sum.left += one.left;
    sum.frames += one.frames;
  }
  return sum;
}

}  // namespace

bool add_frame(const Scene& scene, const CarriedTerms& terms, const Points& motion, CarriedFit& fit) {
  if (!terms.known || std::ranges::any_of(terms.rows, [](const Points& rows) { return rows.rows() == 0; }))
    return false;
  const CarriedSet standard = default_carried_set();
  fit.vertices.resize(static_cast<std::size_t>(motion.rows()));
  for (Eigen::Index v = 0; v < motion.rows(); ++v) {
    const auto i = static_cast<std::size_t>(v);
    if (!terms.worn[i] || std::ranges::binary_search(scene.pins, static_cast<int>(v))) continue;
    Eigen::Matrix<double, 3, carried_term_count> columns;
    for (int k = 0; k < carried_term_count; ++k)
      columns.col(k) = terms.rows[static_cast<std::size_t>(k)].row(v).transpose();
    const Vec3 left = motion.row(v).transpose() - columns * standard;
    if (!columns.allFinite() || !left.allFinite()) continue;
    OfVertex& one = fit.vertices[i];
    one.gram += columns.transpose() * columns;
    one.moment += columns.transpose() * left;
    one.left += left.squaredNorm();
    ++one.frames;
  }
  return true;
}

CarriedSet fitted_scene_set(const CarriedFit& fit) {
  const OfVertex sum = sum_of(fit);
  const double ridge = least_ridge * sum.gram.trace() / carried_term_count;
  if (!(ridge > 0)) return default_carried_set();
  const Gram held = sum.gram + ridge * Gram::Identity();
  return default_carried_set() + held.ldlt().solve(sum.moment);
}

CarriedModel fitted_own_sets(const CarriedFit& fit, double weight) {
  CarriedModel model;
  model.scene = fitted_scene_set(fit);
  model.own = model.scene.transpose().replicate(static_cast<Eigen::Index>(fit.vertices.size()), 1);
  const OfVertex sum = sum_of(fit);
  if (sum.frames == 0) return model;
  const Gram prior = weight / static_cast<double>(sum.frames) *
                     (sum.gram + least_ridge * sum.gram.trace() / carried_term_count * Gram::Identity());
  const CarriedSet change = model.scene - default_carried_set();
#pragma omp parallel for schedule(static, 256)
  for (std::size_t v = 0; v < fit.vertices.size(); ++v) {
    const OfVertex& one = fit.vertices[v];
    if (one.frames == 0) continue;
    const Gram held = one.gram + prior;
    model.own.row(static_cast<Eigen::Index>(v)) += held.ldlt().solve(one.moment - one.gram * change).transpose();
  }
  return model;
}

double distance_left(const CarriedFit& fit, const CarriedModel& model) {
  double left = 0;
  long frames = 0;
  for (std::size_t v = 0; v < fit.vertices.size(); ++v) {
    const OfVertex& one = fit.vertices[v];
    const CarriedSet set = model.own.rows() > 0 ? CarriedSet(model.own.row(static_cast<Eigen::Index>(v))) : model.scene;
    const CarriedSet change = set - default_carried_set();
    left += one.left - 2 * change.dot(one.moment) + change.dot(one.gram * change);
    frames += one.frames;
  }
  return frames > 0 ? std::sqrt(std::max(left, 0.0) / static_cast<double>(frames)) : 0;
}

}  // namespace selvedge
