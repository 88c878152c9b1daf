# SPDX-License-Identifier: GPL-3.0-or-later
"""A red strip on the timeline where the active garment has frames with intersecting pairs."""

import bpy
import gpu
from gpu_extras.batch import batch_for_shader

from . import audit

RED = (0.9, 0.15, 0.12, 0.9)
HEIGHT = 7  # pixels, at a scale of 1

handlers = []


def draw():
    context = bpy.context
    thing = context.object
    if not thing or thing.type != "MESH" or context.space_data.mode != "TIMELINE" or not thing.selvedge.bad:
        return
    view, height = context.region.view2d, HEIGHT * context.preferences.system.ui_scale
    place = lambda frame: view.view_to_region(frame, 0, clip=False)[0]
    rows = [(row.first, row.last) for row in thing.selvedge.bad]
    corners, triangles = audit.strip(rows, place, context.region.width, height)
    shader = gpu.shader.from_builtin("UNIFORM_COLOR" if bpy.app.version >= (4, 0, 0) else "2D_UNIFORM_COLOR")
    batch = batch_for_shader(shader, "TRIS", {"pos": corners}, indices=triangles)
    shader.bind()
    shader.uniform_float("color", RED)
    batch.draw(shader)


def register():
    if not bpy.app.background:
        handlers.append(bpy.types.SpaceDopeSheetEditor.draw_handler_add(draw, (), "WINDOW", "POST_PIXEL"))


def unregister():
    while handlers:
        bpy.types.SpaceDopeSheetEditor.draw_handler_remove(handlers.pop(), "WINDOW")
