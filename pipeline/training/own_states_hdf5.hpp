#pragma once

#include "pipeline/formats/summed_fields_hdf5.hpp"
#include "pipeline/training/trainer.hpp"

namespace selvedge {

// A checkpoint of ours that is read field by field.
struct TrainingFieldsIn : h5::SummedFieldsIn {
  explicit TrainingFieldsIn(const h5::File& from)
      : SummedFieldsIn{{from}, "begin the training anew, without --resume"} {}
};

// What a process has of its own: the states that it keeps with their targets, and its pool. Reading needs the trainer's
// world and network, and asks for the roll-outs that were waited for; it throws Error where a field does not fit these.
void write_own_states(h5::SummedFieldsOut&, const Trainer&);
void read_own_states(TrainingFieldsIn&, Trainer&);

}  // namespace selvedge
