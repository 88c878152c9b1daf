# SPDX-License-Identifier: GPL-3.0-or-later
"""What the program reads: a scene file (YAML) with its meshes (OBJ). Blender is not asked for anything here.

The files have metres with y up; Blender has units of the scene's `unit_scale` metres with z up.
"""

import dataclasses
import json

import numpy as np


def to_file_axes(x, unit_scale):
    """Positions of Blender's world, ... x 3, as the files have them."""
    x = np.asarray(x, float) * unit_scale
    return np.stack([x[..., 0], x[..., 2], -x[..., 1]], axis=-1)


def to_blender_axes(x, unit_scale):
    """The way back."""
    x = np.asarray(x, float) / unit_scale
    return np.stack([x[..., 0], -x[..., 2], x[..., 1]], axis=-1)


def obj_text(x, counts, corners):
    """A mesh: positions n x 3, the number of corners of each face, the vertices of all corners one after another."""
    lines = ["v %.9g %.9g %.9g" % tuple(p) for p in x]
    ends = np.cumsum(counts)
    lines += ["f " + " ".join(map(str, corners[end - count : end] + 1)) for count, end in zip(counts, ends)]
    return "\n".join(lines) + "\n"


@dataclasses.dataclass
class Obstacle:
    name: str
    mesh: str  # file with its faces, beside the scene file
    cache: str = ""  # file with its positions in each frame of Blender; empty: it does not move


@dataclasses.dataclass
class Pins:
    """Vertices that are held or moved."""

    vertices: list[int] = dataclasses.field(default_factory=list)
    displacements: np.ndarray | None = None  # samples x vertices x 3 [m], from the first sample; None: held


@dataclasses.dataclass
class Cloth:
    name: str
    mesh: str
    rest: str = ""  # mesh file with the rest shape; empty: that of `mesh`
    material: str = "cotton"
    pins: Pins = dataclasses.field(default_factory=Pins)


@dataclasses.dataclass
class Scene:
    """Cloths among obstacles. SI units, y up."""

    cloths: list[Cloth]
    frames: int
    fps: float  # of the run
    obstacles: list[Obstacle] = dataclasses.field(default_factory=list)
    sample_fps: float = 30.0  # of the obstacles' caches and of the pins' displacements
    gravity: tuple[float, float, float] = (0.0, -9.81, 0.0)
    thickness: float = 0.002
    friction: float = 0.3
    quality: str = "standard"


def scene_text(scene):
    """The scene file."""
    quoted = lambda text: json.dumps(text, ensure_ascii=False)
    lines = ["cloths:"]
    for cloth in scene.cloths:
        lines += [f"  - name: {quoted(cloth.name)}", f"    mesh: {quoted(cloth.mesh)}"]
        if cloth.rest:
            lines.append(f"    rest: {{from: mesh, file: {quoted(cloth.rest)}}}")
        lines.append(f"    material: {quoted(cloth.material)}")
        lines += pin_lines(cloth.pins, scene.sample_fps)
    if scene.obstacles:
        lines.append("obstacles:")
    for one in scene.obstacles:
        lines.append(f"  - name: {quoted(one.name)}")
        if one.cache:
            files = f"cache: {quoted(one.cache)}, mesh: {quoted(one.mesh)}"
            lines.append(f"    sequence: {{{files}, fps: {scene.sample_fps!r}, start: 0 s}}")
        else:
            lines.append(f"    mesh: {quoted(one.mesh)}")
    lines.append(f"gravity: {numbers(scene.gravity)}")
    lines.append(f"contact: {{thickness: {scene.thickness!r}, friction: {scene.friction!r}}}")
    lines.append(f"run: {{frames: {scene.frames}, fps: {scene.fps!r}, quality: {scene.quality}}}")
    return "\n".join(lines) + "\n"


def numbers(values):
    return "[" + ", ".join(repr(float(v) + 0.0) for v in values) + "]"  # + 0.0: no -0.0


def pin_lines(pins, fps):
    """The list `pins`: vertices with the same displacements are one pin. What the keyframes at both sides of a sample
    say already is left out of it."""
    if not pins.vertices:
        return []
    lines = ["    pins:"]
    for vertices, moved in pins_by_motion(pins):
        lines.append(f"      - vertices: {list(map(int, vertices))}")
        if not moved.any():
            continue
        lines += ["        motion:", "          keyframes:"]
        for k, here in enumerate(moved):
            if 0 < k < len(moved) - 1 and (here == moved[k - 1]).all() and (here == moved[k + 1]).all():
                continue
            lines.append(f"            - {{time: {k / fps!r}, translate: {numbers(here)}}}")
    return lines


def pins_by_motion(pins):
    """Pairs of vertices and their displacements, samples x 3."""
    if pins.displacements is None:
        return [(pins.vertices, np.zeros((1, 3)))]
    groups = {}
    for k, vertex in enumerate(pins.vertices):
        moved = np.ascontiguousarray(pins.displacements[:, k]) + 0.0
        groups.setdefault(moved.tobytes(), (moved, []))[1].append(vertex)
    return [(vertices, moved) for moved, vertices in groups.values()]
