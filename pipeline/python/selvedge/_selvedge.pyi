# What the extension has, for type checkers, editors and the reference that `make docs` makes. Tests hold names, arguments
# and docstrings to the extension; docstrings say shapes and units.
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

class Error(ValueError):
    """What is wrong, where, and how to cure it: of arrays, numbers and files that are refused."""

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

class AnimatedSurface(TypedDict):
    name: str
    cloth: bool
    fps: float
    counts: Indices
    corners: Indices
    uv: Numbers
    corner_uv: Indices
    x: list[Numbers]

class Cache(TypedDict):
    fps: float
    at: list[float]
    x: list[Numbers]

class Scene:
    """Cloths and obstacles with their state, stepped by the conventional stepper or as a file says."""

    @overload
    def __init__(
        self, file: Path, overrides: Sequence[str] = ..., kinds: Mapping[str, type[Stepper]] = ...
    ) -> None:
        """A scene file (YAML). overrides: key=value with dotted keys. kinds: names that run.stepper may have beside the
        known ones, each with its subclass of Stepper."""
    @overload
    def __init__(self, *, stepper: type[Stepper] | None = None) -> None:
        """A scene without anything, at 30 frames a second, under gravity. stepper: a subclass of Stepper; None: the
        conventional one."""
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
    ) -> int:
        """Appends a cloth and returns its number. x: rest positions, n x 3 [m]; triangles: m x 3, whole numbers of 0 ..
        n - 1; density [kg/m2]; youngs_modulus: times thickness [N/m]; poisson [1]; bending [N m]."""
    def add_obstacle(self, x: npt.ArrayLike, triangles: npt.ArrayLike, *, name: str = ...) -> int:
        """Appends an obstacle and returns its number. x: positions, n x 3 [m]; triangles: m x 3, counter-clockwise seen
        from outside."""
    def move_obstacle(self, number: int, x: npt.ArrayLike) -> None:
        """x: where every vertex of an obstacle is to be at the end of the next step, n x 3 [m]."""
    def step(self) -> bool:
        """Steps one frame of 1 / fps [s]. False: the step was rejected, and everything is as it was."""
    @property
    def x(self) -> Numbers:
        """Positions of all cloths on end, n x 3 [m]: a view without a copy, which shows the present state after every
        step. What is written to it changes the state."""
    @property
    def v(self) -> Numbers:
        """Velocities, n x 3 [m/s]: a view without a copy."""
    @property
    def triangles(self) -> Indices:
        """m x 3, of all cloths: a copy."""
    @property
    def time(self) -> float:
        """Of the present state [s]."""
    @property
    def frame(self) -> int:
        """Steps made so far."""
    @property
    def clean(self) -> bool:
        """Known to be free of intersections."""
    @property
    def pairs(self) -> int:
        """Intersecting pairs of triangles after the last step; -1: not known."""
    @property
    def report(self) -> Report:
        """What came of the last step, accepted or rejected, by the names of docs/files.md; empty before one."""
    @property
    def fps(self) -> float:
        """Frames a second."""
    @property
    def frames(self) -> int:
        """That the scene file asks for; 0 of a scene from arrays."""

def check(x: npt.ArrayLike, triangles: npt.ArrayLike, bodies: Bodies = ...) -> CheckCounts:
    """Audits a cloth, with itself and with bodies that stand still. x: positions, n x 3 [m]; triangles: m x 3; bodies:
    list of (x, triangles). Returns counts: self_pairs (triangles that share no vertex and intersect), vertex_pairs
    (that share one and cross), body_pairs, inside_vertices (of the cloth, in closed bodies)."""
def contours(x: npt.ArrayLike, triangles: npt.ArrayLike, bodies: Bodies = ...) -> list[Contour]:
    """The curves along which a cloth crosses itself or bodies, arguments as for check. Returns for each: points, k x 3
    [m]; closed; length [m]; sides, two of sheet (0: the cloth, k: body k - 1), triangles (one a segment) and inside
    (vertices of the smaller part that the curve cuts off)."""
def distance(points: npt.ArrayLike, x: npt.ArrayLike, triangles: npt.ArrayLike) -> Distances:
    """Signed distances of points, p x 3 [m], from a surface. Returns value, p [m], below 0 inside; gradient, p x 3, of
    unit length; closest, p x 3 [m]; triangle, p."""
def untangle(
    x: npt.ArrayLike, triangles: npt.ArrayLike, bodies: Bodies = ..., iterations: int = ...
) -> tuple[Numbers, UntangleReport]:
    """Parts a cloth from itself and from bodies, arguments as for check. Returns positions, n x 3 [m], and a report:
    pairs_before, pairs_after, iterations."""
def read_trajectory(file: Path) -> Trajectory:
    """A run's run.h5: triangles, m x 3; fps; time, a list [s]; x, a list of n x 3 [m], one a frame; reports, a list of
    dicts, one a frame, by the names of docs/files.md."""
def read_surfaces(run: Path, obstacles: bool = ...) -> list[AnimatedSurface]:
    """The cloths of a run (its run.h5 or folder), each by itself, and its obstacles, as exports have them: by the
    vertices and faces of the cloth's own file. A list of dicts: name; cloth, whether it is one; fps; counts, the
    corners of each face; corners, their vertices, one face after another; uv, k x 2; corner_uv, the row of uv of each
    corner, -1 for none, or empty; x, a list of n x 3 [m], one a frame, or one where the surface never moves."""
def read_cache(file: Path) -> Cache:
    """A point cache, .pc2, .pc16 (half floats, as CLOTH3D has them) or .mdd: fps, 0 where it does not say; at, when
    each sample is, in frames of that rate; x, a list of n x 3 in the file's unit, one a sample."""
def compare(
    file: Path,
    kinds: Mapping[str, type[Stepper]] = ...,
    out: Path = ...,
    overrides: Sequence[str] = ...,
    short: bool = ...,
) -> dict[str, Any]:
    """Runs a comparison file (YAML), whose settings may name steppers of kinds, name to subclass of Stepper. What is
    finished is kept in the folder out, by the file's settings: empty it when a class has changed. Returns what
    compare.json holds, and table, a text."""
