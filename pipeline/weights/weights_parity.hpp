#pragma once

#include <string>
#include <vector>

#include "learned/network/weights.hpp"
#include "pipeline/weights/parity_dump.hpp"

namespace selvedge {

// The difference between our result and the recorded one. For edges it is the number that only one of both has.
struct ParityRow {
  std::string quantity, unit;
  double difference = 0, limit = 0;
};

struct ParityReport {
  std::string network;  // name of its architecture
  int cloth_vertices = 0, nodes = 0, edges = 0;
  std::vector<ParityRow> rows;
};

// Takes the dump's step with our graph and engine, and compares. Limits: parity README, "Tolerances". The limit of the
// output is for values up to 4.2 and that of positions for coordinates up to 1 m. Both grow with larger values, because
// the differences are rounding. A step that gathered statistics needs the sums before it, which a checkpoint has and a
// weight file lacks. Throws Error where they are missing and where the network does not fit the step.
ParityReport weights_parity(const Architecture&, const NetworkWeights&, const ParityDump&,
                            const FeatureSums<float>* sums = nullptr);

bool is_clean(const ParityReport&);
std::string parity_text(const ParityReport&);
std::string parity_json(const ParityReport&);

}  // namespace selvedge
