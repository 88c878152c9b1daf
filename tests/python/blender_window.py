"""Run by a Blender with a window: blender --python blender_window.py -- ZIP FOLDER PROGRAM.

Presses the add-on's buttons: Bake and Stop, then Resume, then Bake, in the midst of which Blender quits. Writes what
was seen as FOLDER/seen.json.
"""

import json
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from blender_boxes import FIRST, boxes, install, said, sheet  # noqa: E402

archive, folder, program = sys.argv[sys.argv.index("--") + 1 :]
folder, seen = pathlib.Path(folder), {"frames": []}


def press(**options):
    """The button Bake."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    with bpy.context.temp_override(window=window, area=area):
        return bpy.ops.selvedge.bake("INVOKE_DEFAULT", **options)


def at_work():
    return bpy.context.window_manager.selvedge.garment


def simulating():
    return bpy.context.window_manager.selvedge.text.startswith("frame ")


def story(garment, body):
    seen["pressed"] = sorted(press())
    seen["body"] = garment.selvedge.body == body  # the other selected mesh
    seen["twice"] = bpy.ops.selvedge.bake.poll()
    while not simulating():
        yield
    shown = bpy.context.window_manager.selvedge
    seen["progress"], seen["fraction"] = shown.text, shown.fraction
    bpy.ops.selvedge.stop()
    while at_work():
        yield
    seen["stopped"] = said(garment)
    press(resume=True)
    while at_work():
        seen["frames"].append(bpy.context.window_manager.selvedge.text)
        yield
    seen["resumed"] = said(garment)
    garment.selvedge.material = "cottn"
    press()
    while at_work():
        yield
    seen["fault"] = said(garment)
    garment.selvedge.material = "cotton"
    press()
    while not simulating():
        yield
    (folder / "seen.json").write_text(json.dumps(seen, indent=1))


def begin():
    """Once there is a window."""
    install(archive, program)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = FIRST, FIRST + 60
    body, garment = boxes(), sheet()
    for thing in (body, garment):
        thing.select_set(True)
    bpy.context.view_layer.objects.active = garment
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "sheet.blend"))
    pages = story(garment, body)

    def turn():
        if next(pages, "end") != "end":
            return 0.05
        bpy.ops.wm.quit_blender()

    bpy.app.timers.register(turn)


for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.app.timers.register(begin, first_interval=0.5)
