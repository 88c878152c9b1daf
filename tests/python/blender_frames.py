"""Run by Blender: blender --background --python blender_frames.py -- FOLDER FRAMES FPS.

Imports run.glb, and moves cloth.obj by the point cache cloth.pc2; writes what Blender shows at every frame, in the axes
of the files, as FOLDER/blender.npz.
"""

import pathlib
import sys

import bpy
import numpy as np

np.bool = bool  # Debian's Blender 3.4 imports glTF with a name that Debian's numpy 1.24 no longer has

folder, frames, fps = sys.argv[sys.argv.index("--") + 1 :]
folder, frames = pathlib.Path(folder), range(int(frames))
scene = bpy.context.scene
scene.render.fps = int(fps)  # that of the run: frame k of Blender is frame k of the run


def emptied():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()


def shown(thing):
    """World positions, frames x n x 3 [m]: Z is up in Blender, Y in the files."""
    found = []
    for frame in frames:
        scene.frame_set(frame)
        own = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
        x = np.empty(3 * len(own.data.vertices), np.float32)
        own.data.vertices.foreach_get("co", x)
        to_world = np.array(own.matrix_world)
        world = x.reshape(-1, 3).astype(float) @ to_world[:3, :3].T + to_world[:3, 3]
        found.append(np.stack([world[:, 0], world[:, 2], -world[:, 1]], axis=1))
    return np.array(found)


result = {}
emptied()
bpy.ops.import_scene.gltf(filepath=str(folder / "run.glb"), merge_vertices=False)
for thing in [thing for thing in bpy.data.objects if thing.type == "MESH"]:
    result["glb " + thing.name] = shown(thing)

emptied()
bpy.ops.import_scene.obj(filepath=str(folder / "cloth.obj"), split_mode="OFF", axis_forward="-Z", axis_up="Y")
thing = next(thing for thing in bpy.context.selected_objects if thing.type == "MESH")
cache = thing.modifiers.new("cache", "MESH_CACHE")
cache.cache_format, cache.filepath, cache.frame_start = "PC2", str(folder / "cloth.pc2"), 0
result["pc2 cloth"] = shown(thing)
np.savez(folder / "blender.npz", **result)
