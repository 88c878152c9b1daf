#pragma once

#include "learned/network/weights.hpp"

namespace selvedge {

// Weights of HOOD as a start for a network that sees more (Liao et al. 2024): the same result as before, whatever the
// new inputs are. Columns of the node encoder for `acceleration_inputs` are zero, and so are those of the node networks
// for sums of edge sets that `from` lacks; what only these read is random (`seed`). Edges of cloth with cloth that
// `from` has and was never trained with may be missing in `to`: without such edges the result is the same. Throws Error
// where `to` is not `from` with such inputs and sets more, all steps alike.
NetworkWeights widen_weights(const Architecture& from, const NetworkWeights&, const Architecture& to,
                             std::uint64_t seed);

}  // namespace selvedge
