"""Run by Blender for picture.py: window.py -- ZIP FOLDER PROGRAM PICTURE.png."""

import pathlib
import sys

import bpy
import numpy as np

archive, folder, program, picture = sys.argv[sys.argv.index("--") + 1 :]
folder = pathlib.Path(folder)
FRAMES, SHOWN = 45, 40
TAB = (1044, 547)  # the tab of the add-on, in pixels from the lower left corner of the window


def added(name, file, colour):
    """A mesh of an OBJ file, turned from its axes, y up, to Blender's."""
    rows = [line.split() for line in file.read_text().splitlines()]
    x = [tuple(map(float, row[1:4])) for row in rows if row and row[0] == "v"]
    faces = [[int(corner.split("/")[0]) - 1 for corner in row[1:]] for row in rows if row and row[0] == "f"]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(x, [], faces)
    for face in mesh.polygons:
        face.use_smooth = True
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    thing.rotation_euler = (np.pi / 2, 0, 0)
    thing.color = colour
    return thing


def begin():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.preferences.addon_install(filepath=archive)
    bpy.ops.preferences.addon_enable(module="selvedge_cloth")
    bpy.context.preferences.addons["selvedge_cloth"].preferences.program = program
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = 30, 0, FRAMES
    body = added("person", next((folder / "walk").glob("*person.obj")), (0.75, 0.6, 0.5, 1))
    cache = body.modifiers.new("walk", "MESH_CACHE")
    cache.cache_format, cache.filepath, cache.frame_start = "PC2", str(next((folder / "walk").glob("*person.pc2"))), 0
    shirt = added("shirt", folder / "shirt" / "cloth.obj", (0.15, 0.35, 0.6, 1))
    shirt.selvedge.body, shirt.selvedge.quality = body, "PREVIEW"
    shirt.modifiers.new("thick", "SOLIDIFY").thickness = 0.0015
    bpy.context.view_layer.objects.active = shirt
    shirt.select_set(True)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "shirt.blend"))
    steps = story(shirt)
    bpy.app.timers.register(lambda: next(steps, None))


def look(area):
    space = area.spaces.active
    space.show_region_ui = True
    space.shading.color_type = "OBJECT"
    space.overlay.show_outline_selected = False
    view = space.region_3d
    view.view_location, view.view_distance = (0, -0.35, 1.0), 2.3
    view.view_rotation = (0.79, 0.56, 0.14, 0.2)


def story(shirt):
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    look(area)
    yield 3.0  # time to draw
    for kind, value, x, y in (
        ("MOUSEMOVE", "NOTHING", TAB[0] - 5, TAB[1]),
        ("MOUSEMOVE", "NOTHING", *TAB),
        ("LEFTMOUSE", "PRESS", *TAB),
        ("LEFTMOUSE", "RELEASE", *TAB),
        ("MOUSEMOVE", "NOTHING", 300, 300),
    ):
        window.event_simulate(kind, value, x=x, y=y)
        yield 2.0
    area.type = "CONSOLE"  # nothing to draw in each frame: a processor takes seconds for it
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.selvedge.bake("INVOKE_DEFAULT")
    while bpy.context.window_manager.selvedge.garment:
        yield 0.5
    area.type = "VIEW_3D"
    bpy.context.scene.frame_set(SHOWN)
    yield 3.0
    with bpy.context.temp_override(window=window):
        bpy.ops.screen.screenshot(filepath=picture)
    bpy.ops.wm.quit_blender()


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(begin, first_interval=0.5)
