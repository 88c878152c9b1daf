#pragma once

#include <string>

namespace selvedge {

// Where this process computes: host name, processor and number of threads. Times of different names are not to be
// compared.
std::string machine_name();
std::string host_name();  // the first part of it; "unknown" where the system does not say

}  // namespace selvedge
