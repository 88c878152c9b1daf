#pragma once

#include <string>

namespace selvedge {

// What the kernels are compiled for: plain x86-64 (or whatever the machine is), AVX2 with FMA, AVX-512. Results differ
// between them by rounding.
enum class InstructionSet { plain, avx2, avx512 };

bool is_supported(InstructionSet);      // by this machine
InstructionSet best_instruction_set();  // of those that are supported
std::string name_of(InstructionSet);

}  // namespace selvedge
