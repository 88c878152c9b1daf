#pragma once

#include "pipeline/weights/pickle_value.hpp"

namespace selvedge {

// Reads the pickle (protocol 2) of a torch.save file as plain values. It runs nothing: the only globals it knows are
// collections.OrderedDict, torch.FloatStorage, torch.LongStorage and torch._utils._rebuild_tensor_v2, and each is a
// case in this reader. Any other global, opcode or structure throws Error, which names it; so does a file that asks for
// more than a million values, nests deeper than 100, contains itself, or unfolds to more than 20 million values.
// `where` begins every message. The opcodes are described in
// the module pickletools of Python.
Pickle read_pickle(std::string_view bytes, const std::string& where);

// The value under a text key; nullptr where `value` is no dictionary or has no such key.
const PickleValue* find(const Pickle&, const PickleValue& value, std::string_view key);

}  // namespace selvedge
