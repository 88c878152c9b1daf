"""Steppers written in Python: subclass Stepper and give the class to `Scene` or `compare`."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np


@dataclasses.dataclass(frozen=True)
class SceneArrays:
    """The constants of a run. n: vertices of all cloths together, m: their triangles."""

    rest: np.ndarray  # n x 3, rest positions [m]
    triangles: np.ndarray  # m x 3
    masses: np.ndarray  # n [kg]
    pins: np.ndarray  # vertices whose positions the drive gives, ascending
    obstacles: list[np.ndarray]  # triangles of each obstacle, k x 3
    cloths: list[tuple[str, int, int]]  # name, first vertex, end of its vertices


@dataclasses.dataclass(frozen=True)
class StepStart:
    """Where a step begins."""

    time: float  # [s]
    frame: int
    x: np.ndarray  # n x 3 [m]
    v: np.ndarray  # n x 3 [m/s]
    obstacles: list[np.ndarray]  # positions of each obstacle [m]


@dataclasses.dataclass(frozen=True)
class StepDrive:
    """The prescribed part of the step's end."""

    pins: np.ndarray  # positions of the pins, p x 3 [m]
    obstacles: list[np.ndarray]  # [m]
    wind: list[float]  # [m/s]
    acceleration: list[float]  # gravity [m/s2]
    worn: np.ndarray | None  # n x 3: where the body that wears it takes each vertex, NaN where none does [m]


class Stepper:
    """A stepper. An instance is made for each scene; arrays that it is given are copies of its own.

    Its states are audited as those of any other stepper. Pins are put at the positions of the drive, whatever `step`
    returns. It keeps its memory in itself, so that a run of it cannot be resumed.
    """

    needs_worn = False  # a scene must have cloth that a body wears
    needs_obstacles = False
    may_leave_out_cloths = False  # True: a step of some cloths alone gives them the same motion
    # Forces that it does not model, so that a run shows no energy of theirs: "membrane", "bending (curvature)",
    # "bending (hinge)", "springs", "stiffness damping", "mass damping", "wind".
    ignores: tuple[str, ...] = ()

    def __init__(self, scene: SceneArrays) -> None:
        self.scene = scene

    def step(self, start: StepStart, drive: StepDrive, dt: float):
        """Steps by dt [s]. Returns positions x, n x 3 [m], or (x, v) with velocities [m/s]; otherwise these are
        (x - start.x) / dt. None, and numbers that are not finite, reject the step."""
        raise NotImplementedError
