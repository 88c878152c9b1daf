"""Stand-ins for files that a reader has: a T-shirt as OBJ, and a figure as a rigged GLB.

figure.py makes shirt.obj and figure.glb in the working folder.
Surface and T-shirt are the program's own mannequin and garment, in the pose with the arms out, in metres. Weights are
by the distance from the bones. Only the program and NumPy are needed.
"""

import json
import pathlib
import struct
import subprocess

import numpy as np

SCENE = """
cloths: [{name: shirt, garment: {cut: tshirt, edge: 3.5 cm}}]
obstacles: [{name: figure, body: {model: mannequin}}]
run: {frames: 1}
"""

# Name, parent, place in metres above the floor (docs/mannequin.md); the right side is mirrored.
LEFT = [
    ("pelvis", None, (0, 0.94, 0)), ("left_hip", "pelvis", (0.092, 0.872, 0)), ("spine1", "pelvis", (0, 1.04, -0.01)),
    ("left_knee", "left_hip", (0.118, 0.475, 0)), ("spine2", "spine1", (0, 1.165, -0.016)),
    ("left_ankle", "left_knee", (0.134, 0.085, -0.02)), ("spine3", "spine2", (0, 1.22, -0.014)),
    ("left_foot", "left_ankle", (0.145, 0.028, 0.095)), ("neck", "spine3", (0, 1.43, -0.034)),
    ("left_collar", "spine3", (0.075, 1.365, -0.025)), ("head", "neck", (0, 1.515, -0.004)),
    ("left_shoulder", "left_collar", (0.18, 1.382, -0.021)), ("left_elbow", "left_shoulder", (0.45, 1.385, -0.019)),
    ("left_wrist", "left_elbow", (0.7, 1.386, -0.017)),
]  # fmt: skip
FLOOR = np.array([0, 0.94, 0])  # the mannequin's origin is its pelvis
SHARP = 6  # weights fall off with this power of the distance from a bone


def joints():
    """Names, parents by number, places [m], j x 3: SMPL's first 22."""
    names, parents, places = [], [], []
    for name, parent, place in LEFT:
        for side in ("left", "right") if name.startswith("left") else ("",):
            names.append(name.replace("left", side) if side else name)
            above = parent.replace("left", side) if parent and side else parent
            parents.append(names.index(above) if above else -1)
            places.append(np.array(place) * ((-1, 1, 1) if side == "right" else 1) - FLOOR)
    return names, parents, np.array(places)


def read_obj(file):
    lines = [line.split() for line in file.read_text().splitlines()]
    x = np.array([line[1:4] for line in lines if line[:1] == ["v"]], float)
    return x, np.array([[corner.split("/")[0] for corner in line[1:]] for line in lines if line[:1] == ["f"]], int) - 1


def make_surfaces():
    """Writes shirt.obj and returns vertices and triangles of the figure."""
    pathlib.Path("worn.yaml").write_text(SCENE)
    for command in ("simulate worn.yaml --out worn --no-view", "export worn --format obj --out worn --obstacles"):
        subprocess.run(["selvedge", *command.split()], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    pathlib.Path("shirt.obj").write_bytes(pathlib.Path("worn/cloth_00000.obj").read_bytes())
    return read_obj(pathlib.Path("worn/obstacle_0_figure_00000.obj"))


def skin_weights(x, parents, places):
    """n x j: of each vertex, by the distance from the bones that begin at each joint; the four largest."""
    distance = np.full((len(x), len(places)), np.inf)
    for joint, place in enumerate(places):
        ends = [places[child] for child, parent in enumerate(parents) if parent == joint] or [place * 1.02]
        for end in ends:
            along = np.clip((x - place) @ (end - place) / ((end - place) @ (end - place)), 0, 1)
            off = np.linalg.norm(x - place - along[:, None] * (end - place), axis=1)
            distance[:, joint] = np.minimum(distance[:, joint], off)
    weights = (distance.min(axis=1, keepdims=True) / np.maximum(distance, 1e-9)) ** SHARP
    weights[weights < np.sort(weights, axis=1)[:, -4:-3]] = 0
    return weights / weights.sum(axis=1, keepdims=True)


def write_glb(file, x, triangles):
    names, parents, places = joints()
    weights = skin_weights(x, parents, places)
    most = np.argsort(-weights, axis=1)[:, :4]
    picked = np.take_along_axis(weights, most, axis=1)
    inverse = np.tile(np.eye(4), (len(names), 1, 1))
    inverse[:, 3, :3] = -places  # column by column, as glTF has matrices
    views, accessors, data = [], [], b""

    def add(values, component, kind, dtype):
        nonlocal data
        packed = np.ascontiguousarray(values, dtype).tobytes()
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data += packed + bytes(-len(packed) % 4)
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind, "count": len(values)})
        return len(accessors) - 1

    place = add(x, 5126, "VEC3", "<f4")
    accessors[place] |= {"min": x.min(axis=0).tolist(), "max": x.max(axis=0).tolist()}
    attributes = {
        "POSITION": place,
        "JOINTS_0": add(most, 5123, "VEC4", "<u2"),
        "WEIGHTS_0": add(picked / picked.sum(axis=1, keepdims=True), 5126, "VEC4", "<f4"),
    }
    primitive = {"attributes": attributes, "indices": add(triangles.reshape(-1, 1), 5125, "SCALAR", "<u4")}
    nodes = [{"name": "figure", "mesh": 0, "skin": 0}]
    for joint, name in enumerate(names):
        up = places[parents[joint]] if parents[joint] >= 0 else 0
        children = [child + 1 for child, parent in enumerate(parents) if parent == joint]
        node = {"name": name, "translation": (places[joint] - up).tolist()}
        nodes.append(node | ({"children": children} if children else {}))
    bound = add(inverse.reshape(-1, 16), 5126, "MAT4", "<f4")
    skin = {"joints": list(range(1, len(nodes))), "inverseBindMatrices": bound}
    content = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": nodes, "skins": [skin],
        "meshes": [{"name": "figure", "primitives": [primitive]}], "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }  # fmt: skip
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A)
    file.write_bytes(head + text + struct.pack("<II", len(data), 0x004E4942) + data)


if __name__ == "__main__":
    write_glb(pathlib.Path("figure.glb"), *make_surfaces())
