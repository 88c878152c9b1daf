#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "pipeline/validate/judged.hpp"

namespace selvedge {

struct ValidateRequest {
  std::vector<std::string> cases;      // by name; none: all
  std::vector<std::string> overrides;  // parameter=value[,value...] in place of the cases' own
  std::filesystem::path out = "out/validate";
  bool short_form = false;      // the cases' short lists of parameters
  std::ostream* log = nullptr;  // a line as each run ends
};

struct ValidationRow {
  std::string name;        // of the case
  std::string parameters;  // of the run, name=value
  std::string quantity;    // what was measured
  double measured = 0;
  std::optional<double> expected;
  Judged judged = Judged::relative;
  double bound = 0;
  std::optional<double> error;  // relative
  std::optional<double> order;  // of convergence, from the next coarser run of otherwise the same parameters
  bool counts = true;           // false: shown beside the others, need not pass
  bool passed = false;
  double seconds = 0;  // of the run
  std::map<std::string, std::string> values;
};

// Every run of every case: all combinations of its parameters' values. Throws Error for an unknown case, parameter or
// value. Leaves validate.txt, validate.csv, validate.json in the folder, and plots.
std::vector<ValidationRow> validate(const ValidateRequest&);

bool passed(const std::vector<ValidationRow>&);  // of those that count every one, and there is one

std::string validate_table(const std::vector<ValidationRow>&);
std::string validate_markdown(const std::vector<ValidationRow>&);
std::string validate_csv(const std::vector<ValidationRow>&);
std::string validate_json(const std::vector<ValidationRow>&);

// Writes cantilever.svg and drape.svg, those for which there are rows. Returns a line that says which.
std::string plot_validation(const std::vector<ValidationRow>&, const std::filesystem::path& folder);

}  // namespace selvedge
