#pragma once

#include <string>

namespace selvedge {

// Instruction sets of the kernels: plain x86-64 (or the machine's own), AVX2 with FMA, AVX-512. Results differ by
// rounding.
enum class InstructionSet { plain, avx2, avx512 };

bool is_supported(InstructionSet);      // by this machine
InstructionSet best_instruction_set();  // of the supported ones
std::string name_of(InstructionSet);

}  // namespace selvedge
