#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "collision/geometry/error.hpp"

namespace selvedge::testing {

// What is said of what `read` refuses, by an Error with a cure; empty if it refuses nothing.
template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    CHECK_FALSE(error.cure().empty());
    return error.what();
  }
  return "";
}

}  // namespace selvedge::testing
