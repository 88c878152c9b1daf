#pragma once

#include <vector>

#include "physics/energies/external.hpp"
#include "physics/linear/linear_system.hpp"
#include "physics/solve/assembly.hpp"
#include "physics/solve/step_problem.hpp"

namespace selvedge {

// The incremental potential of one step, all that is constant during the step worked out:
//   E(x) = sum_i m_i |x_i - y_i|^2 / (2 h^2) + m_i a_i |x_i - x0_i|^2 / (2 h) + elastic(x)
//        + (x - x0) . K0 (x - x0) / (2 h) + sum_t d_t . D_t d_t / (2 h) + contact(x) + friction(x) + added(x),
// with a the mass damping, K0 the PSD elastic Hessian at x0, each element times its stiffness damping, and D_t the drag
// of triangle t, whose centroid moves by d_t relative to the air. Sums over vertices run over the free ones alone.
struct StepPotential {
  const Elastic* elastic = nullptr;
  const StepProblem* problem = nullptr;
  double slip_width = 0;             // [m]
  std::vector<char> free;            // has mass and is not pinned
  Points ballistic;                  // y
  std::vector<double> inertia;       // m / h^2 [N/m]
  std::vector<double> drag;          // m a / h [N/m]; empty without mass damping
  PairBlocks damping;                // pairs of K0 / h; empty without stiffness damping
  std::vector<double> flat_damping;  // stiffness damping over h of each vertex; empty without
  std::vector<WindFace> wind;        // at x0
  // For the linear system:
  std::vector<double> diagonal, flat_scale;
  std::vector<ContactBlock> contacts;  // then the wind's, then, once derivatives were taken, the added term's
  ContactLists lists;
};

// Kept between calls for its memory alone.
struct StepScratch {
  AssemblyScratch assembly;
  std::vector<Vec3> contact_forces;
  Points motion;
};

// The vertices that a step moves: with mass and not pinned.
std::vector<char> free_vertices(const Scene&, const Eigen::VectorXd& masses);

// Works out all of it at the start of the problem's step. slip_speed: below it lagged friction is viscous [m/s]. Keeps
// pointers to the elements and the problem.
void prepare(const Scene&, const Elastic&, const Eigen::VectorXd& masses, const StepProblem&, double slip_speed,
             StepScratch&, StepPotential&);

// One sum for each chunk [J], see append_elastic_energies.
void energies(const StepPotential&, const Points& x, StepScratch&, std::vector<double>& energies);

// Gradient [N], zero where not free; with hessian its pair blocks, and the contacts' stiffness in potential.contacts.
void derivatives(StepPotential&, const Points& x, StepScratch&, Points& gradient, PairBlocks* hessian,
                 HessianForm = HessianForm::filtered);

}  // namespace selvedge
