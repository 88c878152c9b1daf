#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/config/config.hpp"
#include "pipeline/validate/judged.hpp"

namespace selvedge {

// A parameter of a case: a number in a range, or a word of a list. `otherwise` and `brief` are values with commas
// between: those of the full and of the short form.
struct ValidationParameter {
  std::string name, otherwise, brief, about;
  Range range = {};
  std::vector<std::string> choices = {};  // empty: a number
};

// The parameters of one run.
struct ValidationValues {
  std::map<std::string, std::string> all;
  std::filesystem::path out;
  double number(const std::string& name) const { return std::stod(all.at(name)); }
  int integer(const std::string& name) const { return static_cast<int>(std::stol(all.at(name))); }
  const std::string& word(const std::string& name) const { return all.at(name); }
};

struct Measured {
  std::string quantity;
  double measured = 0, expected = 0;
  Judged judged = Judged::relative;
  double bound = 0;
  bool counts = true;
};

struct ValidationCase {
  std::string name, about;
  std::vector<ValidationParameter> parameters;
  std::vector<Measured> (*run)(const ValidationValues&) = nullptr;
};

// In the order in which they are reported.
const std::vector<ValidationCase>& validation_cases();

// The cases by the kind of scene; validation_cases() joins them.
std::vector<ValidationCase> bending_cases();   // cantilever, hinge, greenhill, lateral
std::vector<ValidationCase> shell_cases();     // end_shear, end_moment
std::vector<ValidationCase> membrane_cases();  // catenary, hanging, stretch
std::vector<ValidationCase> motion_cases();    // vibration
std::vector<ValidationCase> turning_cases();   // pin, turn
std::vector<ValidationCase> friction_cases();  // incline, capstan
std::vector<ValidationCase> drape_cases();     // drape

}  // namespace selvedge
