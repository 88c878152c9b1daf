"""A stand-in for a published checkpoint of HOOD: checkpoint.py FILE.pth.

Its names, shapes and archive are those of the authors' files, but for the width of the layers, which is small. Its
numbers are random, so that the network knows nothing. torch is not needed.
"""

import collections
import io
import pickle
import sys
import types
import zipfile

import numpy as np

WIDTH, ROWS = 16, 1000  # of rows the statistics have seen
LEVELS = [["world", "mesh", "coarse0"], ["world", "coarse0", "coarse1"], ["world", "coarse1"]]
LEARNED = "model._learned_model."


def layers(prefix, inputs, outputs):
    sizes = [inputs, WIDTH, WIDTH, outputs]
    for layer in range(3):
        yield f"{LEARNED}{prefix}.layers.{2 * layer}.weight", (sizes[layer + 1], sizes[layer])
        yield f"{LEARNED}{prefix}.layers.{2 * layer}.bias", (sizes[layer + 1],)


def normed(prefix, inputs):
    yield from layers(prefix + ".0", inputs, WIDTH)
    yield f"{LEARNED}{prefix}.1.weight", (WIDTH,)
    yield f"{LEARNED}{prefix}.1.bias", (WIDTH,)


def edge_key(edges):
    return edges.replace("coarse", "coarse_edge") if edges.startswith("coarse") else edges + "_edge"


def tensors():
    """Names and shapes, in the order of the file."""
    yield from normed("node_encoder", 24)
    yield from layers("decoder", WIDTH, 3)
    for edges, inputs in (("mesh", 12), ("world", 9), ("coarse0", 12), ("coarse1", 12), ("coarse2", 12)):
        yield from normed("edgeset_encoders." + edges, inputs)
    for level, edges in enumerate([*LEVELS, *LEVELS[1::-1]]):
        for step in range(3):
            for name in edges:
                yield from normed(f"levels.{level}.{step}.edge_processor_dict.{edge_key(name)}", 3 * WIDTH)
            yield from normed(f"levels.{level}.{step}.node_processor_dict.node", WIDTH * (1 + len(edges)))
    for name, columns in (("output", 3), ("node", 21), ("mesh_edge", 9), ("world_edge", 9)):
        for part, shape in (("acc_count", (1,)), ("num_accumulations", (1,))):
            yield f"model._{name}_normalizer._{part}", shape
        for part in ("acc_sum", "acc_sum_squared"):
            yield f"model._{name}_normalizer._{part}", (1, columns)
    yield "model.nodetype_embedding.weight", (9, 9)
    yield "model.vertexlevel_embedding.weight", (4, 4)


def numbers(name, shape, random):
    if name.endswith(("_count", "_accumulations")):
        return np.full(shape, ROWS)
    if "_normalizer" in name:  # mean 0; deviation 1, of the output 0.5 mm a frame squared
        deviation = 5e-4 if "output" in name else 1
        return np.full(shape, ROWS * deviation**2) if name.endswith("squared") else np.zeros(shape)
    if name.endswith(".1.weight"):
        return np.ones(shape)
    return random.normal(size=shape) / np.sqrt(shape[-1])


def fake_torch():
    """Modules that pickle takes for torch's own, so that it writes their names."""
    torch, inner = types.ModuleType("torch"), types.ModuleType("torch._utils")

    class FloatStorage:
        pass

    def _rebuild_tensor_v2():
        pass

    for thing, module in ((FloatStorage, torch), (_rebuild_tensor_v2, inner)):
        thing.__module__, thing.__qualname__ = module.__name__, thing.__name__
        setattr(module, thing.__name__, thing)
    torch._utils = inner
    sys.modules["torch"], sys.modules["torch._utils"] = torch, inner
    return torch


class Storage:
    def __init__(self, key, count):
        self.key, self.count = key, count


class Tensor:
    def __init__(self, torch, key, values):
        stride = tuple(step // values.itemsize for step in values.strides)
        arguments = (Storage(key, values.size), 0, values.shape, stride, False, collections.OrderedDict())
        self.made_by = torch._utils._rebuild_tensor_v2, arguments

    def __reduce__(self):
        return self.made_by


class Pickler(pickle.Pickler):
    def __init__(self, file, torch):
        super().__init__(file, protocol=2)
        self.storage = torch.FloatStorage

    def persistent_id(self, thing):
        return ("storage", self.storage, thing.key, "cpu", thing.count) if isinstance(thing, Storage) else None


def main():
    torch, random, packed = fake_torch(), np.random.default_rng(1), io.BytesIO()
    arrays = {name: numbers(name, shape, random).astype("<f4") for name, shape in tensors()}
    module = collections.OrderedDict()
    for key, (name, values) in enumerate(arrays.items()):
        module[name] = Tensor(torch, str(key), values)
    Pickler(packed, torch).dump({"training_module": module})
    with zipfile.ZipFile(sys.argv[1], "w") as archive:
        archive.writestr("archive/data.pkl", packed.getvalue())
        for key, values in enumerate(arrays.values()):
            archive.writestr(f"archive/data/{key}", values.tobytes())
        archive.writestr("archive/version", "3\n")


main()
