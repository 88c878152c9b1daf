"""glTF as pygltflib reads it; skipped without that package or the program (SELVEDGE_PROGRAM)."""

import os

import numpy as np
import pytest
import shirt as garment

pygltflib = pytest.importorskip("pygltflib")
PROGRAM = os.environ.get("SELVEDGE_PROGRAM")

TYPES = {5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


def rows(file, number):
    """An accessor as numbers."""
    accessor = file.accessors[number]
    view = file.bufferViews[accessor.bufferView]
    kind, width = np.dtype(TYPES[accessor.componentType]), WIDTHS[accessor.type]
    stride = view.byteStride or kind.itemsize * width
    begin = (view.byteOffset or 0) + (accessor.byteOffset or 0)
    blob = file.binary_blob()
    found = [np.frombuffer(blob, kind, width, begin + i * stride) for i in range(accessor.count)]
    return np.array(found).astype(float)


@pytest.mark.skipif(not PROGRAM, reason="SELVEDGE_PROGRAM is not set")
def test_a_shirt_comes_out_as_its_file_had_it(tmp_path):
    shirt = garment.simulated(PROGRAM, tmp_path)
    garment.run(PROGRAM, "export", tmp_path / "out", "--format", "glb", "--out", tmp_path)
    file = pygltflib.GLTF2().load(str(tmp_path / "run.glb"))
    (node,) = file.nodes
    first, second = file.meshes[node.mesh].primitives
    assert first.attributes.POSITION == second.attributes.POSITION
    base = rows(file, first.attributes.POSITION)
    # The seam is split in the file, and its normals are smooth: glTF needs no vertex more.
    assert node.name == "shirt" and len(base) == len(shirt.x)
    step = max(node.scale)
    for frame, x in enumerate(shirt.frames):
        local = base + rows(file, first.targets[frame]["POSITION"])
        assert np.abs(local * node.scale + node.translation - x).max() < 0.51 * step + 1e-6
        normals = rows(file, first.attributes.NORMAL) + rows(file, first.targets[frame]["NORMAL"])
        assert np.abs(normals - garment.normals_of(x, shirt.faces)).max() < 2e-3
    assert np.abs(shirt.frames[0] - shirt.x).max() < 1e-5
    faces = [rows(file, primitive.indices).astype(int).reshape(-1, 3) for primitive in (first, second)]
    assert (np.concatenate(faces) == shirt.faces).all() and len(faces[0]) == shirt.left
    uv = rows(file, first.attributes.TEXCOORD_0)
    assert np.abs(np.column_stack([uv[:, 0], 1 - uv[:, 1]]) - shirt.uv).max() < 1e-6
    assert [primitive.extras["groups"] for primitive in (first, second)] == ["left", "right"]
    red, blue = (file.materials[primitive.material] for primitive in (first, second))
    assert (red.name, blue.name) == ("red cotton", "blue")
    assert np.abs(np.array(red.pbrMetallicRoughness.baseColorFactor) - [0.5, 0.1, 0.1, 1]).max() < 1e-6
    texture = file.textures[blue.pbrMetallicRoughness.baseColorTexture.index]
    assert file.images[texture.source].uri == "cloth.png"
