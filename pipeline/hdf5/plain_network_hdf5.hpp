#pragma once

#include "learned/repulsion/plain_network.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"

namespace selvedge {

// A plain network in a group of one of our files: sizes, bend, and parameters as 32-bit floats. Reading checks it; both
// functions throw Error.
void write_plain_network(const h5::File&, const std::string& group, const PlainNetwork&);
PlainNetwork read_plain_network(const h5::Fields&, const std::string& group);

// Adam's moments. Their number must be that of the parameters (else Error).
void write_plain_adam(const h5::File&, const std::string& group, const PlainAdam&);
PlainAdam read_plain_adam(const h5::Fields&, const std::string& group, long long parameters);

// A list of 32-bit floats. Both functions throw Error.
void write_floats(const h5::File&, const std::string& name, const std::vector<float>&);
std::vector<float> read_floats(const h5::Fields&, const std::string& name);

}  // namespace selvedge
