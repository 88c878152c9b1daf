# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts a baked cloth onto its garment: the cache and its modifier, markers of bad frames. Takes all of it away, too."""

import bpy
import numpy as np

from . import audit, point_cache, sampling, scene_file, writing

# What a bake leaves in its folder; nothing else there is touched.
OWN_FILES = (
    *("scene.yaml", "garment.obj", "rest.obj", "garment.pc2"),
    *("garment_*.obj", "rest_*.obj", "garment_*.pc2", "body_*.obj", "body_*.pc2", "*.part"),
)
RUN_FILES = ("run.h5", "run.xdmf", "summary.json", "config.yaml", "checkpoint.h5", "draping.h5", "run.lock")


def write_cache(exported, matrices, unit_scale, target):
    """The program's positions in the garment's own axes, as the modifier wants them."""
    frames = point_cache.read(exported)
    out = point_cache.Writer(target, frames.shape[1])
    for x, matrix in zip(frames, matrices):
        out.add(sampling.brought_back(scene_file.to_blender_axes(x, unit_scale), matrix))
    out.keep()


def put_cache(garment, file, first, step):
    """The modifier that plays the file; there is one, and it stands where the cloth was simulated."""
    modifier = sampling.cache_of(garment) or garment.modifiers.new(sampling.CACHE, "MESH_CACHE")
    place = sampling.cache_place(garment)
    if garment.modifiers.find(modifier.name) != place:  # before it has a file, which fits the vertices of that place
        with bpy.context.temp_override(object=garment):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=place)
    modifier.cache_format, modifier.filepath = "PC2", kept_path(file)
    modifier.frame_start, modifier.frame_scale = first / step, 1 / step  # Blender shows sample frame * scale - start
    garment.update_tag()


def kept_path(file):
    """Relative to the .blend file where that can be, so that both may move together."""
    try:
        return bpy.path.relpath(str(file)) if bpy.data.filepath else str(file)
    except ValueError:  # another drive
        return str(file)


def marker_prefix(garment):
    return f"selvedge {garment.name}: "


def show_audit(garments, scene, bad, step):
    """Frames with pairs, as a list in the settings of each garment, which the timeline shows as a red strip, and as
    markers of the first one."""
    for garment in garments:
        forget_audit(garment, scene)
        for first, last, pairs in audit.ranges(bad, step):
            row = garment.selvedge.bad.add()
            row.first, row.last, row.pairs = first, last, pairs
            if garment == garments[0]:
                scene.timeline_markers.new(f"{marker_prefix(garment)}{pairs} pairs", frame=first)


def forget_audit(garment, scene):
    garment.selvedge.bad.clear()
    for marker in [one for one in scene.timeline_markers if one.name.startswith(marker_prefix(garment))]:
        scene.timeline_markers.remove(marker)


def baked_together(garment):
    """Further garments that the last bake of this one has moved."""
    return [thing for thing in bpy.data.objects if thing.type == "MESH" and thing.selvedge.baked_with == garment]


def release(garment, scene):
    """Takes modifier, markers and verdict from a garment."""
    if modifier := sampling.cache_of(garment):
        garment.modifiers.remove(modifier)
    forget_audit(garment, scene)
    settings = garment.selvedge
    settings.message, settings.error, settings.baked_with = "", "", None
    settings.warnings.clear()


def clear(garment, scene):
    """Takes away what a bake has left on its garments, and its files. Of a garment that was baked together with another
    one the files stay: they are the other one's."""
    files_are_its_own = garment.selvedge.baked_with is None
    for thing in [garment, *baked_together(garment)]:
        release(thing, scene)
    if not files_are_its_own:
        return
    folder = writing.bake_folder(garment)
    for place, patterns in ((folder / "run", RUN_FILES), (folder, OWN_FILES)):
        for file in [file for pattern in patterns for file in place.glob(pattern)]:
            file.unlink()
        if place.is_dir() and not any(place.iterdir()):
            place.rmdir()
