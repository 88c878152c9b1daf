"""Run by a Blender with a window: blender --python blender_window.py -- ZIP FOLDER PROGRAM.

Presses the add-on's buttons: Bake and Stop, then Resume, then Bake, in the midst of which Blender quits. Writes what
was seen as FOLDER/seen.json.
"""

import json
import pathlib
import sys

import bpy
import numpy as np

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


def red_columns():
    """How many columns of the window's pixels have a red one, as the strip has."""
    file = folder / "window.png"
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.screen.screenshot(filepath=str(file))
    image = bpy.data.images.load(str(file))
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    red, green, blue, _ = pixels.reshape(height, width, 4).transpose(2, 0, 1)
    return int(((red > 0.7) & (green < 0.25) & (blue < 0.25)).any(axis=0).sum())


def timeline(garment):
    """The strip of frames with pairs, in a timeline as large as the 3D viewport."""
    area = next(area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == "VIEW_3D")
    area.ui_type = "TIMELINE"
    for found in ("before", "strip"):
        if found == "strip":
            row = garment.selvedge.bad.add()
            row.first, row.last, row.pairs = FIRST + 20, FIRST + 40, 3
        for _ in range(20):
            area.tag_redraw()
            yield
        seen[found] = red_columns()
    garment.selvedge.bad.clear()
    area.ui_type = "VIEW_3D"
    yield


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
    yield from timeline(garment)
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
    scene.frame_start, scene.frame_end = FIRST, FIRST + 600  # so many that no machine ends before it is told to stop
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


bpy.context.preferences.view.show_splash = False  # it would cover what is looked at
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.app.timers.register(begin, first_interval=0.5)
