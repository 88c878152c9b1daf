#pragma once

#include "learned/repulsion/plain_adam.hpp"
#include "pipeline/formats/hdf5_fields.hpp"

namespace selvedge {

// A plain network below a group of a file of ours: sizes, bend, and parameters as 32-bit floats. What is read is
// checked; both throw Error.
void write_plain_network(const h5::File&, const std::string& group, const PlainNetwork&);
PlainNetwork read_plain_network(const h5::Fields&, const std::string& group);

// Adam's moments, which stand for as many parameters (else Error).
void write_plain_adam(const h5::File&, const std::string& group, const PlainAdam&);
PlainAdam read_plain_adam(const h5::Fields&, const std::string& group, long long parameters);

// A list of 32-bit floats. Both throw Error.
void write_floats(const h5::File&, const std::string& name, const std::vector<float>&);
std::vector<float> read_floats(const h5::Fields&, const std::string& name);

}  // namespace selvedge
