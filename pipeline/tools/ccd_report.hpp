#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/tools/ccd_queries.hpp"

namespace selvedge {

// How time_of_contact at distance zero answers queries whose truth is known.
struct CcdCount {
  int queries = 0, positives = 0;                // positive: a contact, by the file
  int false_negatives = 0, false_positives = 0;  // contact denied, contact asserted

  int negatives() const { return queries - positives; }
};

struct CcdReport {
  int files = 0;
  CcdCount all;
  CcdCount degenerate;             // of these, the ones that is_degenerate names
  double mean_us = 0, max_us = 0;  // a query, the least of three runs each
  std::string slowest;             // file:line of the query behind max_us
  std::vector<std::string> wrong;  // file:line of false answers, negatives first; the first few
};

// The four nodes are exactly in one plane at the start or at the end of the motion, or none of them moves: where
// contact begins or ends without crossing, edges are parallel, motion is coplanar or faces are without an area.
bool is_degenerate(const CcdQuery&);

CcdReport ccd_report(const std::vector<std::filesystem::path>& files);

// No contact denied.
inline bool is_clean(const CcdReport& report) { return report.all.false_negatives == 0; }

std::string ccd_json(const CcdReport&);
std::string ccd_text(const CcdReport&);

}  // namespace selvedge
