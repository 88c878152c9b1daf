#pragma once

#include "learned/network/weights.hpp"

namespace selvedge {

// Weights of HOOD as the start of a network with more inputs (Liao et al. 2024). The result is the same for any new
// inputs. Node encoder columns for `acceleration_inputs` and node network columns for edge sets that `from` lacks are
// zero; weights that only these read are random (`seed`). `to` may lack cloth-cloth edges that `from` was never trained
// with. Throws Error where `to` differs from `from` in anything else.
NetworkWeights widen_weights(const Architecture& from, const NetworkWeights&, const Architecture& to,
                             std::uint64_t seed);

}  // namespace selvedge
