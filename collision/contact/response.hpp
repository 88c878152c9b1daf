#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "collision/contact/contact_world.hpp"
#include "collision/contact/node_pair.hpp"

namespace selvedge {

// A pair that meets during a step, linearised at the impact: at the step's end normal . sum w_i x_i >= target must
// hold.
struct Impact {
  NodePair pair;
  Eigen::Vector4d weights;
  Vec3 normal;                     // from the second primitive toward the first, at the time of impact
  double time = 0;                 // in [0, 1] of the step
  double target = 0;               // [m]
  double friction = 0;             // Coulomb's coefficient
  double multiplier = 0;           // accumulated normal impulse times the time step [kg m]
  Vec3 tangential = Vec3::Zero();  // accumulated friction impulse times the time step [kg m]
};

// The impact of a pair on the straight paths x0 -> x1, if it comes within `separation` [m]. With a world its normal is
// that of contact_normal.hpp.
std::optional<Impact> find_impact(const NodePair&, const Points& x0, const Points& x1, double separation,
                                  const ContactWorld* = nullptr);

double impact_gap(const Impact&, const Points& x);  // normal . sum w_i x_i [m]

// Inverse of the pair's effective mass, in any direction: sum w_i^2 / m_i [1/kg].
double compliance(const Impact&, const Eigen::VectorXd& inverse_mass);

double mean_inverse_mass(const Eigen::VectorXd&);  // of free nodes [1/kg]; 0 if none is free

// Inelastic impulse of Bridson, Fedkiw and Anderson 2002 (section 7.3) in positions: moves the ends x1 of the four
// nodes, by their inverse masses [1/kg] (0: prescribed), so that the gap reaches its target. Then it reduces the pair's
// slip over the step by as much as Coulomb friction allows (to zero where the pair sticks).
void apply_impulse(Impact&, const Eigen::VectorXd& inverse_mass, const Points& x0, Points& x1);

struct Projection {
  double violation = 0;    // largest that remains [m]
  std::int64_t moved = 0;  // number of free nodes moved, summed over impacts and sweeps
};

// Inelastic impact zone (Harmon et al. 2008, with inequalities): the smallest mass-weighted change of x1 that brings
// every impact to its target, by projected Gauss-Seidel on the multipliers, which start from their last values. Sliding
// stays, but for Coulomb friction bounded by the normal impulse of the same pair.
Projection project_zone(std::span<Impact*> impacts, const Eigen::VectorXd& inverse_mass, const Points& x0, Points& x1,
                        int max_sweeps, double tolerance);

// The angular velocity [1/s] for an inertia [kg m2] and an angular momentum [kg m2 / s]. Nodes on a line have no
// inertia about the line; the velocity about it is 0.
Vec3 angular_velocity(const Mat3& inertia, const Vec3& momentum);

// Rigid impact zone (Provot 1997; Bridson et al. 2002, section 7.4): the nodes move on from x0 as one rigid body with
// the linear and angular momentum of their paths x0 -> x1, turned by the whole angle of the step, so that no distance
// among them changes. Prescribed nodes may not be among them.
void rigidify_zone(std::span<const int> nodes, const Eigen::VectorXd& inverse_mass, const Points& x0, Points& x1);

}  // namespace selvedge
