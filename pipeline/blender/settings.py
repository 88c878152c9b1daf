# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user chooses, and what a bake has come to; both are kept with the garment's object."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import program

QUALITIES = [
    ("DRAFT", "Draft", "For a first look"),
    ("PREVIEW", "Preview", "Half to seven tenths of the time of Standard"),
    ("STANDARD", "Standard", "As the program does by itself"),
    ("FINE", "Fine", "More accurate, and slower"),
]
RESTS = [
    ("MODELLED", "As modelled", "Without modifiers and shape keys: the cloth is under stress where these stretch it"),
    ("START", "As in the first frame", "The cloth begins without stress"),
]


class SelvedgePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", description="The program selvedge: its name on the path, or its place", default="selvedge"
    )

    def draw(self, context):
        row = self.layout.row()
        row.prop(self, "program")
        row.operator("selvedge.check_program", text="Check")


def program_path():
    """The program by the preferences of the add-on, or by its name where it has none."""
    own = bpy.context.preferences.addons.get(__package__)
    name = own.preferences.program.strip() if own and own.preferences else ""
    return bpy.path.abspath(name) if name else "selvedge"


def material_names(self, context, typed):
    return [name for name in program.materials(program_path()) if typed.lower() in name]


class SelvedgeWarning(bpy.types.PropertyGroup):
    text: StringProperty()


class SelvedgeBadFrames(bpy.types.PropertyGroup):
    """Frames one after another with intersecting pairs."""

    first: IntProperty()
    last: IntProperty()
    pairs: IntProperty()  # in the worst of them


class SelvedgeSettings(bpy.types.PropertyGroup):
    body: PointerProperty(
        name="Body",
        description="The mesh that wears the garment, as it moves in the scene",
        type=bpy.types.Object,
        poll=lambda self, thing: thing.type == "MESH" and thing != self.id_data,
    )
    obstacles: PointerProperty(
        name="Others", description="Further meshes that the cloth must not go through", type=bpy.types.Collection
    )
    together: PointerProperty(
        name="Bake with",
        description="Further garments that are baked at once with this one, each of its own material, pins and rest "
        "shape. All else is chosen here",
        type=bpy.types.Collection,
    )
    material: StringProperty(
        name="Material",
        description="A material of the program",
        default="cotton",
        search=material_names,
        search_options={"SUGGESTION"},
    )
    pins: StringProperty(
        name="Pins", description="Vertices with a weight of 0.5 or more in this group go where Blender puts them"
    )
    rest: EnumProperty(name="Rest shape", description="The shape in which the cloth has no stress", items=RESTS)
    scene_range: BoolProperty(name="Scene frames", description="Bake the scene's frame range", default=True)
    frame_start: IntProperty(name="Start", description="First frame; the garment begins as it is there", default=1)
    frame_end: IntProperty(name="End", description="Last frame", default=250)
    quality: EnumProperty(name="Quality", description="From fast to accurate", items=QUALITIES, default="STANDARD")
    thickness: FloatProperty(
        name="Thickness",
        description="Distance that layers keep from each other and from bodies, in metres",
        default=0.002,
        min=1e-5,
        soft_max=0.02,
        precision=4,
    )
    friction: FloatProperty(
        name="Friction", description="Of cloth on bodies", default=0.3, min=0, soft_max=2, precision=2
    )
    overrides: StringProperty(
        name="More keys",
        description="Other keys of the program's scene file with their values, apart by semicolons, such as "
        "wind.velocity=[0, 0, 2]; cloths.0.material.density=150 g/m2",
    )
    folder: StringProperty(
        name="Folder",
        description="Where bakes are kept, each in a folder with the name of its garment",
        default="//selvedge",
        subtype="DIR_PATH",
    )
    baked_with: PointerProperty(type=bpy.types.Object)  # whose bake this one was part of; none: its own
    message: StringProperty()  # what became of the last bake
    error: StringProperty()  # what was wrong, and in a second line the cure
    clean: BoolProperty()
    warnings: CollectionProperty(type=SelvedgeWarning)
    bad: CollectionProperty(type=SelvedgeBadFrames)


class SelvedgeJob(bpy.types.PropertyGroup):
    """The bake at work, for the panel; kept with the window manager, which no file brings along."""

    garment: StringProperty()  # empty: none is at work
    text: StringProperty()
    fraction: FloatProperty(min=0, max=1, subtype="FACTOR")
    stop: BoolProperty()


CLASSES = (SelvedgePreferences, SelvedgeWarning, SelvedgeBadFrames, SelvedgeSettings, SelvedgeJob)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Object.selvedge = PointerProperty(type=SelvedgeSettings)
    bpy.types.WindowManager.selvedge = PointerProperty(type=SelvedgeJob)


def unregister():
    del bpy.types.WindowManager.selvedge
    del bpy.types.Object.selvedge
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
