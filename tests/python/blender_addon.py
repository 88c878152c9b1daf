"""Run by Blender, or by a Python that has bpy: blender_addon.py -- ZIP FOLDER PROGRAM.

Installs the add-on from its zip, bakes a sheet on a body of boxes in several ways, and writes what Blender shows as
FOLDER/shown.npz and what it says as FOLDER/said.json.
"""

import importlib
import json
import os
import pathlib
import sys

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

FIRST, LAST = 10, 40
CORNERS = [(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def install(archive, program):
    """The add-on's module `bake`."""
    if bpy.app.version >= (4, 2, 0):
        bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    else:
        bpy.ops.preferences.addon_install(filepath=archive)
        bpy.ops.preferences.addon_enable(module="selvedge_cloth")
    addon = next(one for one in bpy.context.preferences.addons if one.module.endswith("selvedge_cloth"))
    addon.preferences.program = program
    return importlib.import_module(addon.module + ".bake")


def added(name, x, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(x, [], faces)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def boxes():
    """Two boxes in one mesh, which the bones of an armature move; the whole rises, too."""
    x, faces = [], []
    for middle, half in (((0, 0, 0.1), (0.2, 0.2, 0.1)), ((0.05, 0, 0.3), (0.08, 0.08, 0.08))):
        faces += [tuple(len(x) + v for v in side) for side in SIDES]
        x += [tuple(m + h * c for m, h, c in zip(middle, half, corner)) for corner in CORNERS]
    body = added("boxes", x, faces)
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for k in range(2):
        bone = rig.data.edit_bones.new(f"bone{k}")
        bone.head, bone.tail = (0, 0, 0.2 * k), (0, 0, 0.2 * k + 0.1)
    bpy.ops.object.mode_set(mode="OBJECT")
    for k in range(2):
        body.vertex_groups.new(name=f"bone{k}").add(range(8 * k, 8 * k + 8), 1, "REPLACE")
    body.modifiers.new("rig", "ARMATURE").object = rig
    turned = rig.pose.bones["bone1"]
    turned.rotation_mode = "XYZ"
    for frame, angle in ((FIRST, 0), (LAST, 0.6)):
        turned.rotation_euler = (0, angle, 0)
        turned.keyframe_insert("rotation_euler", frame=frame)
    for frame, height in ((FIRST, 0), (LAST, 0.1)):
        body.location = (0, 0, height)
        body.keyframe_insert("location", frame=frame)
    return body


def sheet(side=17):
    """Quads of a square, placed, turned and scaled by the object; it moves aside, which the cloth must not feel."""
    ticks = np.linspace(-1, 1, side)
    x = [(a, b, 0) for a in ticks for b in ticks]
    faces = [(i, i + side, i + side + 1, i + 1) for i in range(side * (side - 1)) if i % side < side - 1]
    thing = added("sheet", x, faces)
    thing.rotation_euler, thing.scale = (0, 0, 0.5), (0.25, 0.2, 3)
    for frame, place in ((FIRST, 0), (LAST, 0.3)):
        thing.location = (place, 0, 0.42)
        thing.keyframe_insert("location", frame=frame)
    return thing


def world(thing):
    own = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    x = np.empty(3 * len(own.data.vertices), np.float32)
    own.data.vertices.foreach_get("co", x)
    matrix = np.array(own.matrix_world)
    return x.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]


def shown(thing, frames=range(FIRST, LAST + 1)):
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        found.append(world(thing))
    return np.array(found)


def gaps(garment, body):
    """The distance of each vertex of the garment from the body, in the last frame; below 0 inside."""
    bpy.context.scene.frame_set(LAST)
    tree = BVHTree.FromPolygons(world(body).tolist(), [list(one.vertices) for one in body.data.polygons])
    found = []
    for point in world(garment):
        near, normal, _, far = tree.find_nearest(point)
        found.append(far if (point - np.array(near)) @ np.array(normal) > 0 else -far)
    return np.array(found)


def said(garment):
    settings = garment.selvedge
    return {
        "message": settings.message,
        "error": settings.error,
        "clean": settings.clean,
        "bad": [(row.first, row.last, row.pairs) for row in settings.bad],
        "warnings": [one.text for one in settings.warnings],
        "markers": [(one.frame, one.name) for one in bpy.context.scene.timeline_markers],
        "modifiers": [(one.name, one.type) for one in garment.modifiers],
    }


def failure(bake, garment):
    try:
        bake.bake(garment)
    except Exception as why:
        return f"{type(why).__name__}: {why}"
    return ""


def stopped_and_resumed(bake, garment, x):
    """Stops a bake at its third frame and goes on with it. `x` gets what is shown before and after."""
    job = bake.new_job(bpy.context, garment)
    texts = []
    for _ in bake.steps(job):
        texts.append(job.text)
        if job.waiting:
            job.run.poll(0.05)
            job.stopped = job.stopped or bool(job.run.progress and job.run.progress.at >= 3)
    stopped = said(garment)
    x["stopped"] = shown(garment)
    clean = bake.bake(garment, resume=True)
    x["resumed"] = shown(garment)
    return {"stopped": stopped, "texts": sorted(set(texts)), "clean": clean, "resumed": said(garment)}


def pinned(bake, garment, x):
    """Two corners are pinned: they go where the object goes."""
    garment.vertex_groups.new(name="held").add([0, 16], 1, "REPLACE")
    garment.selvedge.pins = "held"
    garment.modifiers["selvedge"].show_viewport = False
    x["pins wanted"] = shown(garment)[:, [0, 16]]
    garment.modifiers["selvedge"].show_viewport = True
    bake.bake(garment)
    x["pins"] = shown(garment)[:, [0, 16]]
    garment.selvedge.pins = ""


def tangled(bake, garment):
    """A start that goes through the body."""
    garment.animation_data_clear()
    garment.location = (0, 0, 0.3)
    clean = bake.bake(garment)
    return {"clean": clean, **said(garment)}


def faults(bake, garment, body):
    found = {}
    garment.selvedge.material = "cottn"
    found["material"] = failure(bake, garment)
    garment.selvedge.material = "cotton"
    body.hide_set(True)
    found["hidden"] = failure(bake, garment)
    body.hide_set(False)
    garment.modifiers.new("thick", "CLOTH")
    found["cloth"] = failure(bake, garment)
    garment.modifiers.remove(garment.modifiers["thick"])
    grows = body.modifiers.new("grows", "BUILD")
    grows.frame_start, grows.frame_duration = FIRST - 5, 20
    found["faces"] = failure(bake, garment)
    body.modifiers.remove(grows)
    garment.selvedge.pins = "nothing"
    found["pins"] = failure(bake, garment)
    garment.selvedge.pins = ""
    garment.selvedge.overrides = "run.framez=3"
    found["override"] = failure(bake, garment)
    garment.selvedge.overrides = ""
    addon = next(one for one in bpy.context.preferences.addons if one.module.endswith("selvedge_cloth"))
    program, addon.preferences.program = addon.preferences.program, "no-such-program"
    found["program"] = failure(bake, garment)
    addon.preferences.program = program
    return found


def main():
    archive, folder, program = sys.argv[sys.argv.index("--") + 1 :]
    folder = pathlib.Path(folder)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bake = install(archive, program)
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 24, 1.001
    scene.frame_start, scene.frame_end = FIRST, LAST
    body, garment = boxes(), sheet()
    garment.modifiers.new("fine", "SUBSURF").levels = 0
    garment.selvedge.body = body
    x, report = {}, {"version": bpy.app.version_string}
    report["unsaved"] = failure(bake, garment)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "sheet.blend"))
    before = [tuple(vertex.co) for vertex in garment.data.vertices]

    scene.frame_set(17)
    fractions = []
    report["clean"] = bake.bake(garment, report=lambda text, fraction: fractions.append(fraction))
    report["frame after"], report["fractions"] = scene.frame_current, [min(fractions), max(fractions)]
    report["whole"] = said(garment)
    report["same mesh"] = before == [tuple(vertex.co) for vertex in garment.data.vertices]
    x["sheet"], x["boxes"], x["gaps"] = shown(garment), shown(body), gaps(garment, body)
    (folder / "selvedge" / "sheet" / "run").rename(folder / "first_run")

    report["resume"] = stopped_and_resumed(bake, garment, x)
    scene.frame_step = 3
    bake.bake(garment)
    x["step"] = shown(garment)
    (folder / "selvedge" / "sheet" / "run").rename(folder / "step_run")
    scene.frame_step = 1
    scene.frame_end = FIRST + 5
    pinned(bake, garment, x)
    report["faults"] = faults(bake, garment, body)
    report["tangled"] = tangled(bake, garment)

    bpy.context.view_layer.objects.active = garment
    bpy.ops.selvedge.bake()
    report["operator"] = said(garment)
    bpy.ops.wm.save_mainfile()
    bpy.ops.selvedge.clear()
    report["cleared"] = said(garment)
    report["left"] = sorted(str(file.relative_to(folder)) for file in (folder / "selvedge").rglob("*"))
    addon = next(one.module for one in bpy.context.preferences.addons if one.module.endswith("selvedge_cloth"))
    bpy.ops.preferences.addon_disable(module=addon)
    report["unregistered"] = not hasattr(bpy.types.Object, "selvedge")
    np.savez(folder / "shown.npz", **x)
    (folder / "said.json").write_text(json.dumps(report, indent=1))
    if not bpy.app.binary_path:
        os._exit(0)  # the module bpy 4.2.0 crashes when Python ends, where a class with a function was registered


main()
