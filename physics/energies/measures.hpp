#pragma once

#include <span>
#include <vector>

#include "physics/energies/bending.hpp"
#include "physics/energies/membrane.hpp"

namespace selvedge {

struct StepperTraits;

// Everything of a scene that its energies need and positions do not change. Build it once for a run.
struct EnergyTerms {
  Eigen::VectorXd masses;           // [kg]
  std::vector<Material> materials;  // of the cloths
  std::vector<MembraneElement> membrane;
  CurvatureBending curvature;
  std::vector<Hinge> hinges;
  bool with_membrane = true, with_bending = true, with_springs = true;  // false: that energy is not a number
};
EnergyTerms energy_terms(const Scene&);
// Of a stepper's run, without the energies of forces that the stepper ignores.
EnergyTerms energy_terms(const Scene&, const StepperTraits&);

struct Energies {  // [J]; gravity is -sum m acceleration . x
  double kinetic = 0, gravity = 0, membrane = 0, bending = 0, springs = 0;
  double total() const { return kinetic + gravity + membrane + bending + springs; }
};
// The elements that energies are summed over, wherever they are held. Members are as in EnergyTerms.
struct EnergyElements {
  const Eigen::VectorXd& masses;
  const std::vector<Material>& materials;
  std::span<const MembraneElement> membrane;
  const SparseMatrix& flat;  // of CurvatureBending
  std::span<const CurvedVertex> curved;
  std::span<const Hinge> hinges;
};
// x, v: one row for each vertex of the cloth. The last form builds the terms for this one call.
Energies energies(const Scene&, const EnergyElements&, const Points& x, const Points& v, const Vec3& acceleration);
Energies energies(const Scene&, const EnergyTerms&, const Points& x, const Points& v, const Vec3& acceleration);
Energies energies(const Scene&, const Points& x, const Points& v, const Vec3& acceleration);

// The root mean square of the rows' lengths; 0 without rows.
double root_mean_square(const Points&);
double largest_row(const Points&);  // the longest one's length; 0 without rows

// Principal stretches of every triangle: columns smallest, largest. 1 at rest, and for triangles without rest area. The
// second form has the scene's elements already.
using Stretches = Eigen::Matrix<double, Eigen::Dynamic, 2>;
Stretches principal_stretches(const Scene&, const Points& x);
Stretches principal_stretches(std::span<const MembraneElement>, Eigen::Index triangles, const Points& x);

// [kg m/s]
Vec3 linear_momentum(const Scene&, const Points& v);
// About the origin [kg m2/s].
Vec3 angular_momentum(const Scene&, const Points& x, const Points& v);

}  // namespace selvedge
