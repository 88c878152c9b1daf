"""Cloth simulation with audited contact: scenes from numpy arrays or scene files. Metres, seconds, kilograms; Y is up."""

from __future__ import annotations

import operator
from typing import Callable

from ._selvedge import (
    Error,
    Scene,
    check,
    compare,
    contours,
    distance,
    read_cache,
    read_surfaces,
    read_trajectory,
    untangle,
)
from .alembic import AlembicMesh, export_alembic, read_alembic, write_alembic
from .steppers import SceneArrays, StepDrive, Stepper, StepStart

__all__ = [
    "AlembicMesh",
    "Error",
    "Scene",
    "SceneArrays",
    "StepDrive",
    "StepStart",
    "Stepper",
    "check",
    "compare",
    "contours",
    "distance",
    "export_alembic",
    "read_alembic",
    "read_cache",
    "read_surfaces",
    "read_trajectory",
    "simulate",
    "untangle",
    "write_alembic",
]


def simulate(scene: Scene, frames: int | None = None, callback: Callable[[Scene], bool | None] | None = None) -> int:
    """Steps to that frame (the scene file's by default), or until a step is rejected or the callback, which is called
    with the scene after every frame, returns False. Returns the frame that was reached."""
    try:
        frames = scene.frames if frames is None else operator.index(frames)
    except TypeError:
        raise Error(f"simulate: frames is {frames!r}\n  cure: give a whole number") from None
    if frames < 0:
        raise Error(f"simulate: frames is {frames}\n  cure: give 0 or more")
    while scene.frame < frames and scene.step():
        if callback is not None and callback(scene) is False:
            break
    return scene.frame
