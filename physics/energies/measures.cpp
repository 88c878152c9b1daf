#include "physics/energies/measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/energies/joints.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

EnergyTerms energy_terms(const Scene& scene) {
  EnergyTerms terms{lumped_masses(scene), {}, membrane_elements(scene), curvature_bending(scene), hinges(scene)};
  for (const Cloth& cloth : scene.cloths) terms.materials.push_back(cloth.material);
  return terms;
}

EnergyTerms energy_terms(const Scene& scene, const StepperTraits& traits) {
  EnergyTerms terms = energy_terms(scene);
  const auto has = [&](const char* force) { return std::ranges::find(traits.ignores, force) == traits.ignores.end(); };
  terms.with_membrane = has("membrane");
  terms.with_bending = has("bending (curvature)") && has("bending (hinge)");
  for_each_joint_list([&](auto list, const JointKind& kind) {
    if (!has(kind.name) && !(scene.*list).empty()) terms.with_springs = false;
  });
  return terms;
}

Energies energies(const Scene& scene, const EnergyElements& elements, const Points& x, const Points& v,
                  const Vec3& acceleration) {
  Energies energy;
  energy.kinetic = 0.5 * elements.masses.dot(v.rowwise().squaredNorm());
  energy.gravity = -elements.masses.dot(x * acceleration);
  energy.membrane = membrane_energy(elements.materials, elements.membrane, x);
  if (elements.flat.nonZeros() > 0) {
    const Points forces = elements.flat * x;
    energy.bending += 0.5 * forces.cwiseProduct(x).sum();
  }
  for (const CurvedVertex& vertex : elements.curved) energy.bending += curved_energy(vertex, x);
  for (const Hinge& hinge : elements.hinges) energy.bending += hinge_energy(hinge, x);
  for_each_joint_list([&](auto list, const JointKind&) {
    for (const auto& joint : scene.*list) energy.springs += joint_energy(joint, x);
  });
  return energy;
}

Energies energies(const Scene& scene, const EnergyTerms& terms, const Points& x, const Points& v,
                  const Vec3& acceleration) {
  const EnergyElements elements{terms.masses,         terms.materials,        terms.membrane,
                                terms.curvature.flat, terms.curvature.curved, terms.hinges};
  Energies energy = energies(scene, elements, x, v, acceleration);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!terms.with_membrane) energy.membrane = none;
  if (!terms.with_bending) energy.bending = none;
  if (!terms.with_springs) energy.springs = none;
  return energy;
}

Energies energies(const Scene& scene, const Points& x, const Points& v, const Vec3& acceleration) {
  return energies(scene, energy_terms(scene), x, v, acceleration);
}

double largest_row(const Points& points) {
  return points.rows() > 0 ? std::sqrt(points.rowwise().squaredNorm().maxCoeff()) : 0.0;
}

double root_mean_square(const Points& points) {
  return points.rows() > 0 ? std::sqrt(points.squaredNorm() / static_cast<double>(points.rows())) : 0.0;
}

Stretches principal_stretches(const Scene& scene, const Points& x) {
  return principal_stretches(membrane_elements(scene), scene.surface.triangles.rows(), x);
}

Stretches principal_stretches(std::span<const MembraneElement> elements, Eigen::Index triangles, const Points& x) {
  Stretches stretches;
  stretches.setOnes(triangles, 2);
  for (const MembraneElement& element : elements) {
    const Mat32 F = deformation_gradient(element, x);
    const double p = F.col(0).squaredNorm(), q = F.col(1).squaredNorm(), r = F.col(0).dot(F.col(1));
    const double largest = std::sqrt(0.5 * (p + q) + std::sqrt(0.25 * (p - q) * (p - q) + r * r));
    // The smallest by the area ratio: the difference under its own root would cancel.
    const double smallest = largest > 0 ? F.col(0).cross(F.col(1)).norm() / largest : 0;
    stretches.row(element.triangle) << smallest, largest;
  }
  return stretches;
}

Vec3 linear_momentum(const Scene& scene, const Points& v) { return v.transpose() * lumped_masses(scene); }

Vec3 angular_momentum(const Scene& scene, const Points& x, const Points& v) {
  const Eigen::VectorXd masses = lumped_masses(scene);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < masses.size(); ++i) sum += masses[i] * row(x, i).cross(row(v, i));
  return sum;
}

}  // namespace selvedge
