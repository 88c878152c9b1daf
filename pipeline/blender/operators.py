# SPDX-License-Identifier: GPL-3.0-or-later
"""What the buttons of the panel do."""

import time

import bpy
from bpy.props import BoolProperty, IntProperty

from . import bake, program, reading_back
from .settings import program_path

SLICE = 0.05  # seconds of work between two looks at the window


def usable_garment(context):
    thing = context.object
    return thing if thing and thing.type == "MESH" else None


class SELVEDGE_OT_bake(bpy.types.Operator):
    """Simulate the active mesh as cloth on its body"""

    bl_idname = "selvedge.bake"
    bl_label = "Bake"
    bl_options = {"REGISTER"}

    resume: BoolProperty(name="Resume", description="Go on where the last bake was stopped", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context):
        return usable_garment(context) is not None and not context.window_manager.selvedge.garment

    def execute(self, context):
        try:
            bake.bake(context.object, self.resume)
        except program.Failure as why:
            self.report({"ERROR"}, str(why))
            return {"CANCELLED"}
        return self._told(context.object.selvedge)

    def invoke(self, context, event):
        garment = context.object
        others = [one for one in context.selected_objects if one.type == "MESH" and one != garment]
        if not garment.selvedge.body and len(others) == 1:
            garment.selvedge.body = others[0]
        self.job = bake.new_job(context, garment, self.resume)
        self.steps = bake.steps(self.job)
        shown = context.window_manager.selvedge
        shown.garment, shown.text, shown.fraction, shown.stop = garment.name, "begins", 0, False
        self.timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        shown = context.window_manager.selvedge
        if event.type == "ESC" and event.value == "PRESS":
            shown.stop = True
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        self.job.stopped = self.job.stopped or shown.stop
        begun = time.monotonic()
        try:
            next(self.steps)
            while not self.job.waiting and time.monotonic() - begun < SLICE:
                next(self.steps)
        except StopIteration:
            return self._ended(context)
        except Exception:
            self._release(context)
            raise
        shown.text, shown.fraction = self.job.text, min(1.0, self.job.fraction)
        redraw(context)
        return {"PASS_THROUGH"}

    def _ended(self, context):
        self._release(context)
        settings = self.job.garment.selvedge
        if settings.error:
            self.report({"ERROR"}, settings.error)
            return {"CANCELLED"}
        return self._told(settings)

    def _told(self, settings):
        self.report({"INFO"} if settings.clean else {"WARNING"}, f"selvedge: {settings.message}")
        return {"FINISHED"}

    def _release(self, context):
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.selvedge.garment = ""
        redraw(context)

    def cancel(self, context):
        """Blender ends, or opens another file: the program ends with a checkpoint."""
        self.steps.close()
        self._release(context)


def redraw(context):
    """The panel alone: the viewport draws itself where something in it has changed."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            for region in area.regions if area.type == "VIEW_3D" else ():
                if region.type == "UI":
                    region.tag_redraw()


class SELVEDGE_OT_stop(bpy.types.Operator):
    """End the bake; what was simulated is shown, and Resume goes on"""

    bl_idname = "selvedge.stop"
    bl_label = "Stop"

    def execute(self, context):
        context.window_manager.selvedge.stop = True
        return {"FINISHED"}


class SELVEDGE_OT_clear(bpy.types.Operator):
    """Take the baked cloth from the mesh and delete its files"""

    bl_idname = "selvedge.clear"
    bl_label = "Clear"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return usable_garment(context) is not None and not context.window_manager.selvedge.garment

    def execute(self, context):
        try:
            reading_back.clear(context.object, context.scene)
        except (program.Failure, OSError) as why:
            self.report({"ERROR"}, str(why))
            return {"CANCELLED"}
        return {"FINISHED"}


class SELVEDGE_OT_go_to_frame(bpy.types.Operator):
    """Show this frame"""

    bl_idname = "selvedge.go_to_frame"
    bl_label = "Go to Frame"

    frame: IntProperty()

    def execute(self, context):
        context.scene.frame_set(self.frame)
        return {"FINISHED"}


class SELVEDGE_OT_check_program(bpy.types.Operator):
    """Ask the program for its version"""

    bl_idname = "selvedge.check_program"
    bl_label = "Check the Program"

    def execute(self, context):
        program.materials.cache_clear()
        try:
            self.report({"INFO"}, f"{program_path()} is selvedge {program.version(program_path())}")
        except program.Failure as why:
            self.report({"ERROR"}, str(why))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (
    SELVEDGE_OT_bake,
    SELVEDGE_OT_stop,
    SELVEDGE_OT_clear,
    SELVEDGE_OT_go_to_frame,
    SELVEDGE_OT_check_program,
)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister():
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
