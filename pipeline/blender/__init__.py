# SPDX-License-Identifier: GPL-3.0-or-later
"""Selvedge as an external cloth solver in Blender (docs/blender.md)."""

from . import operators, panel, settings, timeline

# For Blender before 4.2; later ones read blender_manifest.toml.
bl_info = {
    "name": "Selvedge Cloth",
    "author": "selvedge maintainers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar > Selvedge",
    "description": "Bakes cloth by the program selvedge, which checks every frame for intersections",
    "category": "Physics",
}
PARTS = (settings, operators, panel, timeline)


def register():
    for part in PARTS:
        part.register()


def unregister():
    for part in reversed(PARTS):
        part.unregister()
