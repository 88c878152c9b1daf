#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace selvedge {

// A report for people: a line for each value, behind its label.
struct LabelLines {
  int width;  // of labels
  std::string text = {};

  void operator()(std::string_view label, std::string_view value) {
    text += fmt::format("{:<{}}{}\n", label, width, value);
  }
};

}  // namespace selvedge
