#include "learned/losses/force_input.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace selvedge {
namespace {

constexpr LossRamp never{0, 0};

// The losses whose forces are seen: those of the cloth, a softer contact with the body, and perhaps contours.
LossOptions losses_of_forces(const LossOptions& options, const ForceOptions& force) {
  LossOptions soft = options;
  soft.collision.weight = {force.contact_stiffness, force.contact_stiffness};
  soft.collision.penalty = DepthPenalty::quadratic;
  soft.collision.samples = ClothSamples::vertices;  // as in a run, which has no loss options
  soft.collision.thickness = force.contact_thickness;
  soft.contours.weight = {force.contour_weight, force.contour_weight};
  soft.friction.weight = soft.repulsion.weight = never;
  if (!force.inertia) soft.inertia = never;
  return soft;
}

}  // namespace

std::vector<double> jacobi_diagonal(const LossGarment& garment, double dt) {
  std::vector<double> diagonal(garment.mass.size());
  for (std::size_t v = 0; v < diagonal.size(); ++v) diagonal[v] = garment.mass[v] / (dt * dt);
  for (const MembraneElement& e : garment.membranes) {
    const Material& material = garment.materials[static_cast<std::size_t>(e.material)];
    const double stiffness = (2 * material.lame_mu + material.lame_lambda) * e.area;
    const Eigen::RowVector2d second = e.inverse.row(0), third = e.inverse.row(1);
    diagonal[static_cast<std::size_t>(e.nodes[0])] += stiffness * (second + third).squaredNorm();
    diagonal[static_cast<std::size_t>(e.nodes[1])] += stiffness * second.squaredNorm();
    diagonal[static_cast<std::size_t>(e.nodes[2])] += stiffness * third.squaredNorm();
  }
  for (const Spring& spring : garment.springs)
    for (const int v : {spring.a, spring.b}) diagonal[static_cast<std::size_t>(v)] += 2 * spring.stiffness;
  return diagonal;
}

void set_springs(std::span<const Spring> springs, LossGarment& garment) {
  garment.springs.clear();
  const std::vector<double> cloth = jacobi_diagonal(garment, std::numeric_limits<double>::infinity());
  for (Spring spring : springs) {
    spring.stiffness = std::min(
        {spring.stiffness, cloth[static_cast<std::size_t>(spring.a)], cloth[static_cast<std::size_t>(spring.b)]});
    garment.springs.push_back(spring);
  }
}

Points force_input(const LossInputs& in, const LossOptions& options, const ForceOptions& force, LossSearch& search) {
  Points slope = Points::Zero(in.predicted->rows(), 3);
  add_losses(in, losses_of_forces(options, force), search, &slope);
  const std::vector<double> diagonal =
      jacobi_diagonal(*in.garment, in.is_initial ? options.relaxation_dt : in.timestep);
  for (Eigen::Index v = 0; v < slope.rows(); ++v) {
    const auto at = static_cast<std::size_t>(v);
    const Eigen::RowVector3d step = -slope.row(v) / diagonal[at];
    const double length = step.norm();
    const bool counts = !in.garment->pinned[at] && diagonal[at] > 0 && std::isfinite(length) && length > 0;
    slope.row(v) = counts ? step : Eigen::RowVector3d::Zero();
  }
  return slope;
}

Points shown_force(const LossInputs& inputs, int pass, double contour_weight, LossSearch& search) {
  ForceOptions force;
  force.inertia = pass > 0;
  force.contour_weight = inputs.contours ? contour_weight : 0;
  return force_input(inputs, LossOptions{}, force, search);
}

}  // namespace selvedge
