#pragma once

#include "pipeline/weights/pickle_value.hpp"

namespace selvedge {

// Reads the pickle (protocol 2) of a torch.save file as plain values. It runs nothing: it knows only the globals
// collections.OrderedDict, torch.FloatStorage, torch.LongStorage and torch._utils._rebuild_tensor_v2, each as a case in
// this reader. Throws Error that names any other global, opcode or structure. Throws Error also for a file with more
// than a million values, nested deeper than 100, that contains itself, or unfolds to more than 20 million values.
// `where` begins every message. Python's module pickletools describes the opcodes.
Pickle read_pickle(std::string_view bytes, const std::string& where);

// The value under a text key; nullptr if `value` is no dictionary or lacks the key.
const PickleValue* find(const Pickle&, const PickleValue& value, std::string_view key);

}  // namespace selvedge
