#pragma once

#include <vector>

#include "physics/recovery/put_on.hpp"
#include "physics/recovery/recovery.hpp"

namespace selvedge {

// Where a step begins, of cloth that starts tangled.
struct Parting {
  Exemption left;                  // what is tangled still, and what is switched off: contact leaves it alone
  std::vector<Separation> gained;  // what the solve must not lose again
  std::vector<char> carried;       // 1 for vertices that are drawn to their skinned targets (carrying.hpp), or empty
  std::vector<char> waits;         // the same of what is tangled where an obstacle crosses itself: firmly
};

// What a state that is not clean goes through, in the order of docs/recovery.md. edge_length: the cloth's mean [m].
// `clean`: nothing is tangled at the start, for cloth at least. Overwrites the cloth's rows of `nodes`, at the start,
// and velocities v.
Parting part_at_start(const ContactWorld&, SelfCrossings&, const Eigen::VectorXd& inverse_mass, double edge_length,
                      bool clean, const WornPlaces&, const RecoveryOptions&, Points& nodes, Points& v,
                      UntanglingBudget&);

}  // namespace selvedge
