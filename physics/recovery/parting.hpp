#pragma once

#include <vector>

#include "physics/recovery/put_on.hpp"
#include "physics/recovery/recovery.hpp"

namespace selvedge {

// What a step of cloth that starts tangled has to know.
struct Parting {
  Exemption left_alone;                 // what is still tangled or switched off: contact leaves it alone
  std::vector<Separation> separations;  // that the solve must keep
  std::vector<char> drawn;              // 1 for vertices that are drawn to their skinned targets (drawn.hpp), or empty
  std::vector<char> trapped;            // 1 for trapped vertices (recovery.hpp), which are drawn more stiffly, or empty
};

// Parts a tangled start, in the order of docs/recovery.md. edge_length: the cloth's mean [m]. `clean`: the cloth is not
// tangled at the start. Overwrites the cloth's rows of `nodes` (at the start of the step) and velocities v.
Parting part_at_start(const ContactWorld&, SelfCrossings&, const Eigen::VectorXd& inverse_mass, double edge_length,
                      bool clean, const RecoveryTargets&, const RecoveryOptions&, Points& nodes, Points& v,
                      UntanglingBudget&);

}  // namespace selvedge
