"""Run by Blender: blender --background --python blender_twin.py -- SCENE.npz RESULT.npz.

A sheet of Blender's stock cotton, quality 5, collision quality 2, contact with itself at 0.3 edges, over a ball or pinned.
Y is up, as in the scene.
"""

import sys
import time

import bpy
import numpy as np

scene_file, result_file = sys.argv[sys.argv.index("--") + 1 :]
given = np.load(scene_file)
frames, start = int(given["frames"]), given["x"].astype(float)

bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
scene = bpy.context.scene
scene.gravity = (0, -9.81, 0)
scene.render.fps = int(given["fps"])
scene.frame_start, scene.frame_end = 0, frames


def add(name, x, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(x.tolist(), [], faces.tolist())
    thing = bpy.data.objects.new(name, mesh)
    scene.collection.objects.link(thing)
    return thing


if "ball" in given:
    ball = add("ball", given["ball"], given["ball_triangles"])
    ball.modifiers.new("collision", "COLLISION")
    ball.collision.thickness_outer = 0.002
    ball.collision.cloth_friction = 5
side = round(len(start) ** 0.5)
first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1, 1)
sheet = add("sheet", start, first + [0, 1, side + 1, side])  # of squares, whose diagonals it does not let shear
cloth = sheet.modifiers.new("cloth", "CLOTH")
settings = cloth.settings
settings.quality, settings.mass, settings.air_damping, settings.bending_stiffness = 5, 0.3, 1, 0.5
for kind in ("tension", "compression", "shear"):
    setattr(settings, f"{kind}_stiffness", 15)
    setattr(settings, f"{kind}_damping", 5)
edge = np.linalg.norm(start[1] - start[0])
contact = cloth.collision_settings
contact.collision_quality, contact.distance_min = 2, 0.002
contact.use_self_collision, contact.self_distance_min = True, 0.3 * edge
if len(given["pins"]):
    group = sheet.vertex_groups.new(name="pins")
    group.add(given["pins"].tolist(), 1, "REPLACE")
    settings.vertex_group_mass = "pins"
cloth.point_cache.frame_start, cloth.point_cache.frame_end = 0, frames

x, seconds = [start.astype(np.float32)], []
scene.frame_set(0)
for frame in range(1, frames + 1):
    began = time.perf_counter()
    scene.frame_set(frame)
    own = sheet.evaluated_get(bpy.context.evaluated_depsgraph_get())
    seconds.append(time.perf_counter() - began)
    flat = np.empty(3 * len(own.data.vertices), np.float32)
    own.data.vertices.foreach_get("co", flat)
    x.append(flat.reshape(-1, 3))
np.savez(result_file, x=np.array(x), seconds=np.array(seconds))
