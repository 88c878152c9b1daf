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

    matrices: dict  # of each garment by its name, in the order of the cloths: of each frame of the run
    meshes: list  # names of their files, without the suffix
    unit_scale: float  # metres in a unit of Blender


class Garment:
    """A garment and what is seen of it while Blender goes through the frames."""

    def __init__(self, thing, number, folder):
        self.name, self.folder, self.pinned = thing.name, folder, sampling.pinned_vertices(thing)
        self.number = f"_{number}" if number else ""
        self.mesh = f"garment{self.number}"
        self.start, self.paths, self.matrices = None, [], []

    def add(self, thing, depsgraph, unit, in_run):
        """A frame; `in_run`: whether the run has it, too."""
        if self.start is None or self.pinned:
            x, counts, corners = sampling.shown_mesh(thing, depsgraph)
            self.start = self.start or (scene_file.to_file_axes(x, unit), counts, corners)
            self.paths.append(scene_file.to_file_axes(x[self.pinned], unit))
        if in_run:
            self.matrices.append(sampling.world_matrix(thing.evaluated_get(depsgraph)))

    def end(self, thing, unit):
        """The cloth as the scene file has it; writes its meshes."""
        settings, (x, counts, corners) = thing.selvedge, self.start
        if len(x) != len(thing.data.vertices):
            raise Failure(f"`{self.name}` has other vertices behind its modifiers", "move its deforming modifiers up")
        mesh, rest = f"{self.mesh}.obj", ""
        (self.folder / mesh).write_text(scene_file.obj_text(x, counts, corners))
        if settings.rest == "MODELLED":
            placed = sampling.placed(sampling.modelled_mesh(thing), self.matrices[0])
            modelled = scene_file.to_file_axes(placed, unit)
            if not np.array_equal(modelled, x):
                rest = f"rest{self.number}.obj"
                (self.folder / rest).write_text(scene_file.obj_text(modelled, counts, corners))
        displacements = np.array(self.paths) - self.paths[0] if self.pinned else None
        pins = scene_file.Pins(self.pinned, displacements)
        return scene_file.Cloth(self.name, mesh, rest, settings.material, pins)


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
    folder, unit = bake_folder(garment), unit_scale_of(scene)
    tracks = [Track(thing, k, folder) for k, thing in enumerate(sampling.obstacles_of(garment))]
    garments = [Garment(thing, k, folder) for k, thing in enumerate(sampling.garments_of(garment))]
    track_names = [track.name for track in tracks]
    shown = scene.frame_current, scene.frame_subframe
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with sampling.before_the_caches([one.name for one in garments]):
            for frame in range(first, first + step * count + 1):
                scene.frame_set(frame)
                depsgraph, things = view_layer.depsgraph, scene.objects
                for name, track in zip(track_names, tracks):
                    x, counts, corners = sampling.shown_mesh(things[name], depsgraph)
                    track.add(scene_file.to_file_axes(x, unit), counts, corners, frame)
                for one in garments:
                    one.add(things[one.name], depsgraph, unit, (frame - first) % step == 0)
                yield frame
        cloths = [one.end(scene.objects[one.name], unit) for one in garments]
        settings = scene.objects[garments[0].name].selvedge
        (folder / "scene.yaml").write_text(scene_file.scene_text(described(settings, scene, span, cloths, tracks)))
        return Written({one.name: one.matrices for one in garments}, [one.mesh for one in garments], unit)
    finally:
        for track in tracks:
            track.drop()
        scene.frame_set(shown[0], subframe=shown[1])


def described(settings, scene, span, cloths, tracks):
    """The scene file's content."""
    fps = scene.render.fps / scene.render.fps_base
    gravity = scene_file.to_file_axes(scene.gravity if scene.use_gravity else (0, 0, 0), 1)
    return scene_file.Scene(
        cloths=cloths,
        frames=span[2],
        fps=fps / span[1],
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
    """The folder of a bake, whose first garment this is. Raises Failure where it is to be beside a file that has no
    place yet."""
    name = garment.selvedge.folder
    if name.startswith("//") and not bpy.data.filepath:
        raise Failure("the folder of the bake is beside the .blend file, and that is not saved yet", "save it first")
    return pathlib.Path(bpy.path.abspath(name)) / bpy.path.clean_name(garment.name)
