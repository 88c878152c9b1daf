"""A sheet and a body of boxes in Blender, and the add-on installed from its zip; for scripts that Blender runs."""

import importlib

import bpy
import numpy as np

FIRST, LAST = 10, 40
CORNERS = [(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def addon():
    return next(one for one in bpy.context.preferences.addons if one.module.endswith("selvedge_cloth"))


def install(archive, program):
    """The add-on's module `bake`."""
    if bpy.app.version >= (4, 2, 0):
        bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    else:
        bpy.ops.preferences.addon_install(filepath=archive)
        bpy.ops.preferences.addon_enable(module="selvedge_cloth")
    addon().preferences.program = program
    return importlib.import_module(addon().module + ".bake")


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


def sheet(side=17, name="sheet", height=0.42):
    """Quads of a square, placed, turned and scaled by the object; it moves aside, which the cloth must not feel."""
    ticks = np.linspace(-1, 1, side)
    x = [(a, b, 0) for a in ticks for b in ticks]
    faces = [(i, i + side, i + side + 1, i + 1) for i in range(side * (side - 1)) if i % side < side - 1]
    thing = added(name, x, faces)
    thing.rotation_euler, thing.scale = (0, 0, 0.5), (0.25, 0.2, 3)
    for frame, place in ((FIRST, 0), (LAST, 0.3)):
        thing.location = (place, 0, height)
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
