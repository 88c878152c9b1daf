# What the extension has, for type checkers and editors; tests hold it to the extension. Docstrings say shapes and units.
import os
from collections.abc import Mapping, Sequence
from typing import Any, TypedDict, overload

import numpy as np
import numpy.typing as npt

from .steppers import Stepper

Path = str | os.PathLike[str]
Bodies = list[tuple[npt.ArrayLike, npt.ArrayLike]]
Numbers = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]
Report = dict[str, bool | int | float | str | list[int]]

class Error(ValueError): ...

class CheckCounts(TypedDict):
    self_pairs: int
    vertex_pairs: int
    body_pairs: int
    inside_vertices: int

class ContourSide(TypedDict):
    sheet: int
    triangles: Indices
    inside: Indices

class Contour(TypedDict):
    points: Numbers
    closed: bool
    length: float
    sides: list[ContourSide]

class Distances(TypedDict):
    value: Numbers
    gradient: Numbers
    closest: Numbers
    triangle: Indices

class UntangleReport(TypedDict):
    pairs_before: int
    pairs_after: int
    iterations: int

class Trajectory(TypedDict):
    triangles: Indices
    fps: float
    time: list[float]
    x: list[Numbers]
    reports: list[Report]

class Cache(TypedDict):
    fps: float
    at: list[float]
    x: list[Numbers]

class Scene:
    @overload
    def __init__(
        self, file: Path, overrides: Sequence[str] = ..., kinds: Mapping[str, type[Stepper]] = ...
    ) -> None: ...
    @overload
    def __init__(self, *, stepper: type[Stepper] | None = None) -> None: ...
    def add_cloth(
        self,
        x: npt.ArrayLike,
        triangles: npt.ArrayLike,
        *,
        name: str = ...,
        density: float = ...,
        youngs_modulus: float = ...,
        poisson: float = ...,
        bending: float = ...,
    ) -> int: ...
    def add_obstacle(self, x: npt.ArrayLike, triangles: npt.ArrayLike, *, name: str = ...) -> int: ...
    def move_obstacle(self, number: int, x: npt.ArrayLike) -> None: ...
    def step(self) -> bool: ...
    @property
    def x(self) -> Numbers: ...
    @property
    def v(self) -> Numbers: ...
    @property
    def triangles(self) -> Indices: ...
    @property
    def time(self) -> float: ...
    @property
    def frame(self) -> int: ...
    @property
    def clean(self) -> bool: ...
    @property
    def pairs(self) -> int: ...
    @property
    def report(self) -> Report: ...
    @property
    def fps(self) -> float: ...
    @property
    def frames(self) -> int: ...

def check(x: npt.ArrayLike, triangles: npt.ArrayLike, bodies: Bodies = ...) -> CheckCounts: ...
def contours(x: npt.ArrayLike, triangles: npt.ArrayLike, bodies: Bodies = ...) -> list[Contour]: ...
def distance(points: npt.ArrayLike, x: npt.ArrayLike, triangles: npt.ArrayLike) -> Distances: ...
def untangle(
    x: npt.ArrayLike, triangles: npt.ArrayLike, bodies: Bodies = ..., iterations: int = ...
) -> tuple[Numbers, UntangleReport]: ...
def read_trajectory(file: Path) -> Trajectory: ...
def read_cache(file: Path) -> Cache: ...
def compare(
    file: Path,
    kinds: Mapping[str, type[Stepper]] = ...,
    out: Path = ...,
    overrides: Sequence[str] = ...,
    short: bool = ...,
) -> dict[str, Any]: ...
