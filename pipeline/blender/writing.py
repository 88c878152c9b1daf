# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the scene of a bake into its folder, while Blender goes through the frames."""

import dataclasses
import pathlib

import bpy
import numpy as np

from . import point_cache, sampling, scene_file
from .program import Failure


@dataclasses.dataclass
class Written:
    """What reading back needs of the scene that was written."""

    matrices: list  # of the garment, in each frame of the run
    unit_scale: float  # metres in a unit of Blender


class Track:
    """An obstacle and the cache of its positions."""

    def __init__(self, thing, number, folder):
        self.name, self.folder, self.file = thing.name, folder, f"body_{number}"
        self.cache, self.moved = None, False

    def add(self, x, counts, corners, frame):
        if self.cache is None:
            if not len(counts):
                raise Failure(f"`{self.name}` has no faces", "take it out of the collection of obstacles")
            self.first, self.faces = x, len(counts)
            (self.folder / f"{self.file}.obj").write_text(scene_file.obj_text(x, counts, corners))
            self.cache = point_cache.Writer(self.folder / f"{self.file}.pc2", len(x))
        if len(x) != len(self.first) or len(counts) != self.faces:
            raise Failure(
                f"`{self.name}` has other vertices or faces in frame {frame} than in the first one",
                "turn off the modifier that changes them, or take another body",
            )
        self.moved = self.moved or not np.array_equal(x, self.first)
        self.cache.add(x)

    def end(self):
        """The obstacle as the scene file has it."""
        if not self.moved:
            self.drop()
            return scene_file.Obstacle(self.name, f"{self.file}.obj")
        self.cache.keep()
        return scene_file.Obstacle(self.name, f"{self.file}.obj", f"{self.file}.pc2")

    def drop(self):
        if self.cache and not self.cache.file.closed:
            self.cache.drop()


def unit_scale_of(scene):
    units = scene.unit_settings
    return units.scale_length if units.system != "NONE" else 1.0


def write_scene(garment, scene, view_layer, span):
    """A generator of the frames that were read. Returns Written. `span`: first frame, step and number of steps."""
    first, step, count = span
    folder = bake_folder(garment)
    unit = unit_scale_of(scene)
    tracks = [Track(thing, k, folder) for k, thing in enumerate(sampling.obstacles_of(garment))]
    names, pinned = [track.name for track in tracks], sampling.pinned_vertices(garment)
    own_name, matrices, paths, start = garment.name, [], [], None
    shown = scene.frame_current, scene.frame_subframe
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with sampling.before_the_cache(garment.name):
            for frame in range(first, first + step * count + 1):
                scene.frame_set(frame)
                depsgraph, things = view_layer.depsgraph, scene.objects
                for name, track in zip(names, tracks):
                    x, counts, corners = sampling.shown_mesh(things[name], depsgraph)
                    track.add(scene_file.to_file_axes(x, unit), counts, corners, frame)
                garment = things[own_name]
                if start is None or pinned:
                    x, counts, corners = sampling.shown_mesh(garment, depsgraph)
                    start = start or (scene_file.to_file_axes(x, unit), counts, corners)
                    paths.append(scene_file.to_file_axes(x[pinned], unit))
                if (frame - first) % step == 0:
                    matrices.append(sampling.world_matrix(garment.evaluated_get(depsgraph)))
                yield frame
        text = scene_file.scene_text(described(garment, scene, span, start, (pinned, paths), tracks, matrices[0]))
        (folder / "scene.yaml").write_text(text)
        return Written(matrices, unit)
    finally:
        for track in tracks:
            track.drop()
        scene.frame_set(shown[0], subframe=shown[1])


def described(garment, scene, span, start, pins, tracks, matrix):
    """The scene file's content; writes the garment's meshes beside it."""
    settings, (x, counts, corners), (pinned, paths) = garment.selvedge, start, pins
    folder, unit = bake_folder(garment), unit_scale_of(scene)
    if len(x) != len(garment.data.vertices):
        raise Failure(f"`{garment.name}` has other vertices behind its modifiers", "move its deforming modifiers up")
    (folder / "garment.obj").write_text(scene_file.obj_text(x, counts, corners))
    rest = ""
    if settings.rest == "MODELLED":
        modelled = scene_file.to_file_axes(sampling.placed(sampling.modelled_mesh(garment), matrix), unit)
        if not np.array_equal(modelled, x):
            rest = "rest.obj"
            (folder / rest).write_text(scene_file.obj_text(modelled, counts, corners))
    fps = scene.render.fps / scene.render.fps_base
    gravity = scene_file.to_file_axes(scene.gravity if scene.use_gravity else (0, 0, 0), 1)
    displacements = np.array(paths) - paths[0] if pinned else None
    return scene_file.Scene(
        cloth=garment.name,
        mesh="garment.obj",
        rest=rest,
        frames=span[2],
        fps=fps / span[1],
        material=settings.material,
        pins=scene_file.Pins(pinned, displacements),
        obstacles=[track.end() for track in tracks],
        sample_fps=fps,
        gravity=tuple(gravity),
        thickness=rounded(settings.thickness),
        friction=rounded(settings.friction),
        quality=settings.quality.lower(),
    )


def rounded(value):
    """A number of Blender, which has floats, as it was typed in."""
    return float(f"{value:.6g}")


def bake_folder(garment):
    """The folder of a garment's bake. Raises Failure where it is to be beside a file that has no place yet."""
    name = garment.selvedge.folder
    if name.startswith("//") and not bpy.data.filepath:
        raise Failure("the folder of the bake is beside the .blend file, and that is not saved yet", "save it first")
    return pathlib.Path(bpy.path.abspath(name)) / bpy.path.clean_name(garment.name)
