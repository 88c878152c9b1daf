# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as Blender shows them in a frame: garments up to the place of their cache, bodies with all modifiers."""

import contextlib

import bpy
import numpy as np

from .program import Failure

CACHE = "selvedge"  # name of the modifier that plays a baked cloth
# Modifiers that keep the vertices of a mesh. The cache stands behind those of them that come first.
DEFORMING = set(
    "ARMATURE CAST CURVE DISPLACE HOOK LAPLACIANDEFORM LATTICE MESH_CACHE MESH_DEFORM MESH_SEQUENCE_CACHE SHRINKWRAP"
    " SIMPLE_DEFORM SMOOTH CORRECTIVE_SMOOTH LAPLACIANSMOOTH SURFACE_DEFORM WARP WAVE VERTEX_WEIGHT_EDIT"
    " VERTEX_WEIGHT_MIX VERTEX_WEIGHT_PROXIMITY UV_PROJECT UV_WARP NORMAL_EDIT WEIGHTED_NORMAL DATA_TRANSFER"
    " COLLISION SURFACE".split()
)
SIMULATING = {"CLOTH": "Cloth", "SOFT_BODY": "Soft Body"}


def cache_of(garment):
    found = garment.modifiers.get(CACHE)
    return found if found and found.type == "MESH_CACHE" else None


def cache_place(garment):
    """The index that the cache has, or is to have, among the other modifiers of the garment."""
    others = [one for one in garment.modifiers if one != cache_of(garment)]
    return next((k for k, one in enumerate(others) if one.type not in DEFORMING), len(others))


@contextlib.contextmanager
def before_the_caches(names):
    """The garments of these names without their caches and without what stands behind those."""
    with contextlib.ExitStack() as all_of_them:
        for name in names:
            all_of_them.enter_context(before_the_cache(name))
        yield


@contextlib.contextmanager
def before_the_cache(name):
    garment = bpy.data.objects[name]
    cache, place = cache_of(garment), cache_place(garment)
    others = [one for one in garment.modifiers if one != cache]
    hidden = [one.name for one in [*others[place:], *([cache] if cache else [])] if one.show_viewport]
    show_modifiers(name, hidden, False)
    try:
        yield
    finally:
        show_modifiers(name, hidden, True)


def show_modifiers(name, modifiers, shown):
    """By names, as Blender may have made its objects anew meanwhile."""
    garment = bpy.data.objects.get(name)
    for modifier in modifiers:
        if garment and modifier in garment.modifiers:
            garment.modifiers[modifier].show_viewport = shown


def meshes_of(collection):
    return [thing for thing in collection.all_objects if thing.type == "MESH"] if collection else []


def garments_of(garment):
    """The garment and those that are baked together with it, each once."""
    settings = garment.selvedge
    further = [thing for thing in meshes_of(settings.together) if thing != settings.body]
    return list(dict.fromkeys([garment, *further]))


def obstacles_of(garment):
    """The body and the meshes of the collection, each once, without the garments of the bake."""
    settings, garments = garment.selvedge, garments_of(garment)
    found = [settings.body] if settings.body else []
    return list(dict.fromkeys(thing for thing in found + meshes_of(settings.obstacles) if thing not in garments))


def check_usable(garment, scene, view_layer):
    """Raises Failure where a garment or an obstacle cannot be read."""
    view_layer.update()  # objects that a script has just made
    garments = garments_of(garment)
    for thing in [*garments, *obstacles_of(garment)]:
        if thing.name not in view_layer.objects or not thing.visible_get(view_layer=view_layer):
            raise Failure(f"`{thing.name}` is hidden, or is not in this view layer", "show it while you bake")
        if thing.mode == "EDIT":
            raise Failure(f"`{thing.name}` is in Edit Mode", "leave Edit Mode")
    for thing in garments:
        if not thing.data.polygons:
            raise Failure(f"`{thing.name}` has no faces", "select the mesh of a garment")
        for one in thing.modifiers:
            if one.type in SIMULATING and one.show_viewport:
                kind = SIMULATING[one.type]
                raise Failure(f"`{thing.name}` is simulated by Blender's modifier {kind}, too", f"turn {kind} off")


def shown_mesh(thing, depsgraph):
    """World positions n x 3 in Blender's units, corners of each face, vertices of all corners."""
    own = thing.evaluated_get(depsgraph)
    mesh = own.to_mesh()
    try:
        x = np.empty(3 * len(mesh.vertices), np.float32)
        counts = np.empty(len(mesh.polygons), np.int32)
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.vertices.foreach_get("co", x)
        mesh.polygons.foreach_get("loop_total", counts)
        mesh.loops.foreach_get("vertex_index", corners)
    finally:
        own.to_mesh_clear()
    return placed(x.reshape(-1, 3), world_matrix(own)), counts, corners


def world_matrix(thing):
    return np.array(thing.matrix_world, float)


def placed(x, matrix):
    return x.astype(float) @ matrix[:3, :3].T + matrix[:3, 3]


def brought_back(x, matrix):
    """World positions in the axes of an object."""
    if abs(np.linalg.det(matrix[:3, :3])) < 1e-30:
        raise Failure("the garment has a scale of 0", "give it another one")
    return (x - matrix[:3, 3]) @ np.linalg.inv(matrix[:3, :3]).T


def modelled_mesh(garment):
    """Positions as the mesh was modelled, without modifiers and shape keys, in the garment's own axes."""
    x = np.empty(3 * len(garment.data.vertices), np.float32)
    garment.data.vertices.foreach_get("co", x)
    return x.reshape(-1, 3)


def pinned_vertices(garment):
    """Vertices with a weight of half or more in the garment's group of pins."""
    name = garment.selvedge.pins
    if not name:
        return []
    if name not in garment.vertex_groups:
        raise Failure(f"`{garment.name}` has no vertex group `{name}`", "choose another group, or none")
    group = garment.vertex_groups[name].index
    weighted = lambda vertex: any(one.group == group and one.weight >= 0.5 for one in vertex.groups)
    found = [vertex.index for vertex in garment.data.vertices if weighted(vertex)]
    if not found:
        raise Failure(f"no vertex has a weight of 0.5 or more in the group `{name}`", "assign some, or choose none")
    return found
