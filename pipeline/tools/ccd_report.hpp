#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/tools/ccd_queries.hpp"

namespace selvedge {

// Counts of the answers of time_of_contact at distance zero to queries with known truth.
struct CcdCount {
  int queries = 0, positives = 0;                // positive: a contact, by the file
  int false_negatives = 0, false_positives = 0;  // contact denied; contact asserted

  int negatives() const { return queries - positives; }
};

struct CcdReport {
  int files = 0;
  CcdCount all;
  CcdCount degenerate;             // those that is_degenerate names
  double mean_us = 0, max_us = 0;  // time per query, the least of three runs each
  std::string slowest;             // file:line of the query with max_us
  std::vector<std::string> wrong;  // file:line of the first false answers, negatives first
};

// Whether the four nodes are exactly in one plane at the start or at the end of the motion, or none of them moves.
// There contact begins or ends without crossing, edges are parallel, motion is coplanar or faces have no area.
bool is_degenerate(const CcdQuery&);

// Answers all queries of the files. Throws Error as read_ccd_queries does.
CcdReport ccd_report(const std::vector<std::filesystem::path>& files);

// Whether no contact is denied.
inline bool is_clean(const CcdReport& report) { return report.all.false_negatives == 0; }

std::string ccd_json(const CcdReport&);
std::string ccd_text(const CcdReport&);

}  // namespace selvedge
