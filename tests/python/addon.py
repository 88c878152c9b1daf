"""The add-on for Blender, for its tests: its folder, and its modules that do without Blender."""

import importlib
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
