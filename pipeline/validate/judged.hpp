#pragma once

namespace selvedge {

// How a figure is judged. validate_report.cpp has a form for each, in this order.
enum class Judged {
  relative,  // |measured / expected - 1| at most the bound
  at_most,   // measured at most the bound
  at_least,  // measured at least the bound
  rises,     // measured above that of the run before by the bound
};

}  // namespace selvedge
