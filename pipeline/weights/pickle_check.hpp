#pragma once

#include "pipeline/weights/pickle_value.hpp"

namespace selvedge {

// Throws Error if the values below the root contain themselves, nest too deeply, unfold to too many, have a duplicate
// key, or contain a global or a bare storage.
void check_pickle(const Pickle&, const std::string& where);

// Throws the Error for a file that this reader refuses.
[[noreturn]] void refuse_pickle(const std::string& what, const std::string& where);

}  // namespace selvedge
