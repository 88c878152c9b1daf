#pragma once

namespace selvedge {

// The path of the program that was built beside the tests. It differs between builds. Its own file lets a compile cache
// serve all other files.
const char* tested_program();

}  // namespace selvedge
