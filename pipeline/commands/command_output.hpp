#pragma once

#include <iostream>
#include <string>

#include "pipeline/host/interrupt.hpp"

namespace selvedge {

// Where a command's text for people goes.
inline std::ostream& people(bool json) { return json ? std::cerr : std::cout; }

// Prints the result of a command, for people and with `json` as an object, and returns the exit status.
int end_command(bool json, const std::string& text, const std::string& object, bool well);

// The line of a command that was stopped before its end; empty if it was not.
std::string stopped_text(bool finished);

// What takes times says on standard error that a training takes the cores.
void warn_of_training();

// Long work that says how it goes on and can be interrupted.
template <class Request>
Request followed(Request request) {
  request.log = &std::cerr;
  request.stop = InterruptWatch::interrupted;
  return request;
}

}  // namespace selvedge
