#pragma once

#include "pipeline/weights/pickle_value.hpp"

namespace selvedge {

// The storage named by a persistent id of torch.save: ('storage', type, key, location, count). Throws Error for any
// other tuple. The location, a device, is ignored.
TorchStorage torch_storage(const Pickle&, const PickleTuple& id, const std::string& where);

// The tensor that torch._utils._rebuild_tensor_v2 makes from (storage, offset, shape, stride, requires_grad, hooks).
// Throws Error for other arguments, and for a tensor that does not lie inside its storage.
TorchTensor torch_tensor(const Pickle&, const PickleTuple& arguments, const std::string& where);

}  // namespace selvedge
