"""The add-on for Blender, for its tests: its folder, and its modules that do without Blender."""

import importlib
import os
import pathlib
import sys
import types

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "pipeline" / "blender"
NAME = "selvedge_cloth"


def part(name):
    """A module of the add-on. The package itself imports Blender, and is left out."""
    if NAME not in sys.modules:
        sys.modules[NAME] = types.ModuleType(NAME)
        sys.modules[NAME].__path__ = [str(FOLDER)]
    return importlib.import_module(f"{NAME}.{name}")


def environment(folder):
    """Of a Blender whose settings and add-ons lie below the folder, and that draws without a graphics card."""
    own = {name: str(folder / "user" / name) for name in ("BLENDER_USER_SCRIPTS", "BLENDER_USER_CONFIG")}
    return dict(os.environ, LIBGL_ALWAYS_SOFTWARE="1", BLENDER_USER_RESOURCES=str(folder / "user"), **own)
