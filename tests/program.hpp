#pragma once

namespace selvedge {

// Path of the program that was built beside the tests. In a file of its own, for it differs between builds: a compile
// cache serves all other files in each of them.
const char* tested_program();

}  // namespace selvedge
