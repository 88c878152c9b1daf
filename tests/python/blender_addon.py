"""Run by Blender, or by a Python that has bpy: blender_addon.py -- ZIP FOLDER PROGRAM.

Installs the add-on from its zip, bakes a sheet on a body of boxes in several ways, and writes what Blender shows as
FOLDER/shown.npz and what it says as FOLDER/said.json.
"""

import json
import os
import pathlib
import sys

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from blender_boxes import FIRST, LAST, addon, boxes, install, said, sheet, shown, world  # noqa: E402


def gaps(garment, body):
    """The distance of each vertex of the garment from the body, in the last frame; below 0 inside."""
    bpy.context.scene.frame_set(LAST)
    tree = BVHTree.FromPolygons(world(body).tolist(), [list(one.vertices) for one in body.data.polygons])
    found = []
    for point in world(garment):
        near, normal, _, far = tree.find_nearest(point)
        found.append(far if (point - np.array(near)) @ np.array(normal) > 0 else -far)
    return np.array(found)


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


def together(bake, garment, folder, x):
    """A second sheet above the first one is baked with it, and then no more."""
    upper = sheet(name="upper", height=0.43)
    upper.selvedge.material = "silk"
    garments = bpy.data.collections.new("garments")
    for one in (garment, upper):
        garments.objects.link(one)
    garment.selvedge.together = garments
    clean = bake.bake(garment)
    report = {"clean": clean, "lower": said(garment), "upper": said(upper), "with": upper.selvedge.baked_with.name}
    frames = range(FIRST, bpy.context.scene.frame_end + 1)
    report["frames"] = len(frames)
    x["together sheet"], x["together upper"] = shown(garment, frames), shown(upper, frames)
    own = folder / "selvedge" / "sheet"
    (own / "run").rename(folder / "together_run")
    (folder / "together.yaml").write_text((own / "scene.yaml").read_text())
    garments.objects.unlink(upper)
    bake.bake(garment)
    report["upper alone"] = said(upper)
    report["with after"] = upper.selvedge.baked_with.name if upper.selvedge.baked_with else ""
    garment.selvedge.together = None
    bpy.data.objects.remove(upper)
    return report


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
    own = addon().preferences
    program, own.program = own.program, "no-such-program"
    found["program"] = failure(bake, garment)
    own.program = program
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
    report["together"] = together(bake, garment, folder, x)
    report["faults"] = faults(bake, garment, body)
    report["tangled"] = tangled(bake, garment)

    bpy.context.view_layer.objects.active = garment
    bpy.ops.selvedge.bake()
    report["operator"] = said(garment)
    bpy.ops.wm.save_mainfile()
    bpy.ops.selvedge.clear()
    report["cleared"] = said(garment)
    report["left"] = sorted(str(file.relative_to(folder)) for file in (folder / "selvedge").rglob("*"))
    bpy.ops.preferences.addon_disable(module=addon().module)
    report["unregistered"] = not hasattr(bpy.types.Object, "selvedge")
    np.savez(folder / "shown.npz", **x)
    (folder / "said.json").write_text(json.dumps(report, indent=1))
    if not bpy.app.binary_path:
        os._exit(0)  # the module bpy 4.2.0 crashes when Python ends, where a class with a function was registered


main()
