# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the sidebar of the 3D viewport."""

import textwrap

import bpy

from . import sampling
from .operators import usable_garment

MOST_ROWS = 12  # of frames with pairs
MOST_WARNINGS = 4


class VIEW3D_PT_selvedge(bpy.types.Panel):
    bl_label = "Selvedge Cloth"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Selvedge"

    def draw(self, context):
        layout = self.layout
        garment = usable_garment(context)
        if not garment:
            layout.label(text="Select the mesh of a garment", icon="INFO")
            return
        wide = letters_a_line(context)
        draw_choices(layout, garment, context.scene)
        draw_buttons(layout, garment, context.window_manager.selvedge)
        draw_result(layout, garment.selvedge, wide)


def letters_a_line(context):
    """About as many as fit beside an icon, in Blender's own font."""
    return max(12, int((context.region.width / context.preferences.system.ui_scale - 75) / 7.5))


def draw_choices(layout, garment, scene):
    settings = garment.selvedge
    column = layout.column()
    column.use_property_split, column.use_property_decorate = True, False
    column.prop(settings, "body")
    column.prop(settings, "obstacles")
    column.prop(settings, "together")
    column.prop(settings, "material")
    column.prop_search(settings, "pins", garment, "vertex_groups")
    column.prop(settings, "thickness")
    column.prop(settings, "friction")
    column.prop(settings, "quality")
    column.prop(settings, "rest")
    column.prop(settings, "scene_range")
    if settings.scene_range:
        column.label(text=f"Frames {scene.frame_start} to {scene.frame_end}, step {scene.frame_step}")
    else:
        column.prop(settings, "frame_start")
        column.prop(settings, "frame_end")
    column.prop(settings, "overrides")
    column.prop(settings, "folder")


def draw_buttons(layout, garment, job):
    if job.garment:
        if hasattr(layout, "progress"):  # Blender 4.0
            layout.progress(text=job.text, factor=job.fraction)
        else:
            row = layout.row()
            row.enabled = False
            row.prop(job, "fraction", text=job.text, slider=True)
        layout.operator("selvedge.stop", icon="CANCEL", text="Stop" if not job.stop else "Stopping")
        return
    row = layout.row(align=True)
    row.operator("selvedge.bake", icon="PHYSICS")
    row.operator("selvedge.bake", text="Resume").resume = True
    if sampling.cache_of(garment) or garment.selvedge.message:
        row.operator("selvedge.clear", icon="TRASH")


def draw_result(layout, settings, wide):
    if settings.baked_with:
        layout.label(text=f"Baked together with {settings.baked_with.name}", icon="LINKED")
    if settings.error:
        draw_text(layout.box(), settings.error, wide, "ERROR", alert=True)
    if settings.message:
        draw_text(layout.box(), settings.message, wide, "CHECKMARK" if settings.clean else "ERROR", not settings.clean)
    if settings.bad:
        box = layout.box()
        box.label(text="Frames with intersecting pairs")
        for row in settings.bad[:MOST_ROWS]:
            frames = f"{row.first}" if row.first == row.last else f"{row.first} to {row.last}"
            line = box.row()
            line.alert = True  # red
            line.operator("selvedge.go_to_frame", text=f"{frames}: {row.pairs} pairs").frame = row.first
        if len(settings.bad) > MOST_ROWS:
            box.label(text=f"and {len(settings.bad) - MOST_ROWS} more, in red on the timeline")
    if settings.warnings:
        box = layout.box()
        for warning in settings.warnings[:MOST_WARNINGS]:
            draw_text(box, warning.text, wide, "INFO")
        if len(settings.warnings) > MOST_WARNINGS:
            box.label(text=f"and {len(settings.warnings) - MOST_WARNINGS} more warnings")


def draw_text(layout, text, wide, icon, alert=False):
    column = layout.column(align=True)
    column.alert = alert
    lines = [line for part in text.splitlines() for line in textwrap.wrap(part, wide)]
    for k, line in enumerate(lines):
        column.label(text=line, icon=icon if k == 0 else "BLANK1")


def register():
    bpy.utils.register_class(VIEW3D_PT_selvedge)


def unregister():
    bpy.utils.unregister_class(VIEW3D_PT_selvedge)
