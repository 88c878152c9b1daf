#include "pipeline/commands/dataset_command.hpp"

#include <iostream>

#include "pipeline/host/interrupt.hpp"

namespace selvedge {

int dataset_command(const DatasetRequest& request, bool json) {
  const InterruptWatch watch;
  DatasetRequest followed = request;
  followed.log = &std::cerr;
  followed.stop = InterruptWatch::interrupted;
  const DatasetSummary summary = make_dataset(followed);
  (json ? std::cerr : std::cout) << dataset_text(summary);
  if (!summary.finished) std::cerr << "stopped; the same command goes on\n";
  if (json) std::cout << dataset_json(summary);
  return summary.finished ? 0 : 1;
}

}  // namespace selvedge
