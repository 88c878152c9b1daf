# What the extension has, for type checkers, editors and the reference that `make docs` makes. Tests hold names, arguments
# and docstrings to the extension; docstrings say shapes and units.
import os
import pathlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypedDict, overload

import numpy as np
import numpy.typing as npt

from .steppers import Stepper

Path = str | os.PathLike[str]
Bodies = Iterable[tuple[npt.ArrayLike, npt.ArrayLike]]
Numbers = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]
Material = str | Mapping[str, Any]
Overrides = Sequence[str] | Mapping[str, Any]
Report = dict[str, bool | int | float | str | list[int]]

Log = Callable[[str], object] | None

__version__: str

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

class SceneObstacle(TypedDict):
    name: str
    x: Numbers
    triangles: Indices

class ContentsObstacle(TypedDict):
    name: str
    triangles: Indices
    vertex_count: int
    moving: bool

class ContactForces(TypedDict):
    normal: Numbers
    friction: Numbers
    pressure: Numbers

class Contents(TypedDict):
    frame_count: int
    contact_forces: bool
    fps: float
    triangles: Indices
    rest: Numbers
    pins: Indices
    cloths: list[tuple[str, int, int]]
    obstacles: list[ContentsObstacle]

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
        self, file: Path, overrides: Overrides = ..., kinds: Mapping[str, type[Stepper]] = ...
    ) -> None:
        """A scene file (YAML). overrides: a list of texts key=value with dotted keys, or a dict of them. kinds: names
        that run.stepper may have beside the known ones, each with its subclass of Stepper."""
    @overload
    def __init__(self, *, stepper: type[Stepper] | None = None, contact_forces: bool = False) -> None:
        """A scene without anything, at 30 frames a second, under gravity. stepper: a subclass of Stepper; None: the
        conventional one. contact_forces: whether steps find them."""
    def add_cloth(
        self,
        x: npt.ArrayLike,
        triangles: npt.ArrayLike,
        *,
        name: str | None = ...,
        density: float | None = ...,
        youngs_modulus: float | None = ...,
        poisson: float | None = ...,
        bending: float | None = ...,
        material: Material | None = ...,
        pins: npt.ArrayLike | None = ...,
    ) -> int:
        """Appends a cloth and returns its number. x: rest positions, n x 3 [m]; triangles: m x 3, whole numbers of 0 ..
        n - 1; density [kg/m2], 0.2; youngs_modulus: times thickness [N/m], 1000; poisson [1], 0.3; bending [N m], 1e-5;
        material, in place of these: a name, or a dict with the keys of `material` in scene files; pins: vertices that
        stay where they are."""
    def add_garment(
        self,
        x: npt.ArrayLike,
        triangles: npt.ArrayLike,
        *,
        name: str | None = ...,
        on: str | None = ...,
        material: Material | None = ...,
        fit: str = ...,
        pins: npt.ArrayLike | None = ...,
        **keys: Any,
    ) -> int:
        """Appends a cloth that a body wears, and returns its number. x: where the body wears it in its zero pose, n x 3
        [m], which is its rest shape; triangles: m x 3; on: the body's name (the only one); material: a name, or a dict
        with the keys of `material` in scene files; fit: how it takes weights from the body, `loose` or `tight`; pins:
        vertices that stay with the body (the waists of pieces that would fall). keys: further keys of `cloths` in scene
        files, such as start={"from": "draped"}."""
    def add_body(
        self,
        x: npt.ArrayLike,
        triangles: npt.ArrayLike,
        joints: npt.ArrayLike,
        weights: npt.ArrayLike,
        parents: npt.ArrayLike,
        *,
        poses: npt.ArrayLike | None = ...,
        translations: npt.ArrayLike | None = ...,
        fps: float = ...,
        joint_names: Sequence[str] | None = ...,
        name: str | None = ...,
        room: float | str | None = ...,
        **keys: Any,
    ) -> int:
        """Appends an obstacle that is a skinned body, and returns its number. In its zero pose: x, n x 3 [m];
        triangles, m x 3, counter-clockwise seen from outside; joints, j x 3 [m]; weights, n x j, rows sum to 1;
        parents, of each joint, before it, -1 for the first. Its motion: poses, frames x j x 3, axis times angle
        relative to the parent [rad]; translations, frames x 3 [m]; fps. Without poses it stands in the zero pose.
        room: the gap that soft tissue keeps open between parts of the body [m], 0: none. keys: further keys of
        `obstacles` in scene files, such as translate."""
    def add_obstacle(self, x: npt.ArrayLike, triangles: npt.ArrayLike, *, name: str | None = ...) -> int:
        """Appends an obstacle and returns its number. x: positions, n x 3 [m]; triangles: m x 3, counter-clockwise seen
        from outside."""
    def move_obstacle(self, number: int, x: npt.ArrayLike) -> None:
        """x: where every vertex of an obstacle is to be at the end of the next step, n x 3 [m]."""
    def step(self) -> bool:
        """Steps one frame of 1 / fps [s]. False: the step was rejected, and everything is as it was. Ctrl-C ends it,
        and everything is as it was."""
    def save(self, file: Path) -> None:
        """Writes the present state in full precision (HDF5), for restore."""
    def restore(self, file: Path) -> None:
        """Goes back to a state that save wrote of this scene, or of one that was made of the same arrays or files. The
        next steps have the same bits."""
    def _record(self, folder: Path) -> None:
        """Records the present state and every frame after it."""
    def _end_recording(self) -> None:
        """Closes the file of a recording."""
    @property
    def x(self) -> Numbers:
        """Positions of all cloths on end, n x 3 [m]: a view without a copy, which shows the present state after every
        step. What is written to it changes the state."""
    @x.setter
    def x(self, array: npt.ArrayLike) -> None: ...
    @property
    def v(self) -> Numbers:
        """Velocities, n x 3 [m/s]: a view without a copy."""
    @v.setter
    def v(self, array: npt.ArrayLike) -> None: ...
    @property
    def triangles(self) -> Indices:
        """m x 3, of all cloths: a copy."""
    @property
    def rest(self) -> Numbers:
        """Rest positions of all cloths, n x 3 [m]: a copy."""
    @property
    def cloths(self) -> list[tuple[str, int, int]]:
        """Of each cloth: its name, its first vertex and the end of its vertices."""
    @property
    def obstacles(self) -> list[SceneObstacle]:
        """Of each obstacle: its name, where it is now, x, n x 3 [m], and its triangles, m x 3: copies."""
    @property
    def time(self) -> float:
        """Of the present state [s]."""
    @property
    def frame(self) -> int:
        """Steps made so far."""
    @property
    def clean(self) -> bool:
        """Known to be free of intersections. False after positions were written, until the next step."""
    @property
    def pairs(self) -> int:
        """Intersecting pairs of triangles after the last step; -1: not known, as after positions were written."""
    @property
    def report(self) -> Report:
        """What came of the last step, accepted or rejected, by the names of docs/files.md; empty before one."""
    @property
    def contact_forces(self) -> ContactForces | None:
        """What contact exerts on each vertex in the present state (docs/files.md#contact-forces), where that was asked
        for: normal and friction, n x 3 [N], and pressure, n [Pa], copies. None: not known, as before the first
        step."""
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
def read_surfaces(run: Path, obstacles: bool = ...) -> list[AnimatedSurface]:
    """The cloths of a run (its run.h5 or folder), each by itself, and its obstacles, as exports have them: by the
    vertices and faces of the cloth's own file. A list of dicts: name; cloth, whether it is one; fps; counts, the
    corners of each face; corners, their vertices, one face after another; uv, k x 2; corner_uv, the row of uv of each
    corner, -1 for none, or empty; x, a list of n x 3 [m], one a frame, or one where the surface never moves."""
def read_cache(file: Path) -> Cache:
    """A point cache, .pc2, .pc16 (half floats, as CLOTH3D has them) or .mdd: fps, 0 where it does not say; at, when
    each sample is, in frames of that rate; x, a list of n x 3 in the file's unit, one a sample."""
def plan(file: Path, overrides: Overrides = ..., kinds: Mapping[str, type[Stepper]] = ...) -> dict[str, Any]:
    """What a scene file needs, what is left out, and why: what `selvedge plan --json` prints, a dict. overrides and
    kinds as for Scene."""
def fit(
    run: Path,
    *,
    scene: Path | None = ...,
    body: str = ...,
    regions: Path | None = ...,
    frame: int | None = ...,
    reach: float | None = ...,
    out: Path | None = ...,
) -> dict[str, Any]:
    """How garments fit in a frame of a run (a trajectory, or the folder of a run): what `selvedge fit --json` prints, a
    dict, and of every vertex gap [m], strain, pressure [Pa] and row (of the table; -1: none). scene: the file that the
    run was made of (config.yaml beside it); body: an obstacle's name (the first body); regions: a file of the body's
    vertices by name (its joints); frame: the last; reach: what is nearer touches the skin [m] (twice the contact
    thickness); out: a page to write."""
def dataset(
    config: Path, out: Path | None = ..., overrides: Overrides = ..., log: Log = ...
) -> dict[str, Any]:
    """Makes drapes at rest to train a network on, as the command does, in the folder out (out/data/NAME). log: called
    with a line for each path; None: silent. Ctrl-C keeps the paths that are done; the same call goes on. Returns what
    `selvedge dataset --json` prints, a dict."""
def train(
    config: Path, out: Path | None = ..., overrides: Overrides = ..., resume: bool = ..., log: Log = ...
) -> dict[str, Any]:
    """Trains a network, as the command does, in the folder out (out/training/NAME). resume: from the folder's
    checkpoint. log: called with a line now and then; None: silent. Ctrl-C ends it at a checkpoint. Returns what
    `selvedge train --json` prints, a dict."""
def compare(
    file: Path,
    kinds: Mapping[str, type[Stepper]] = ...,
    out: Path = ...,
    overrides: Overrides = ...,
    short: bool = ...,
    log: Log = ...,
) -> dict[str, Any]:
    """Runs a comparison file (YAML), whose settings may name steppers of kinds, name to subclass of Stepper. What is
    finished is kept in the folder out, by the file's settings: empty it when a class has changed. log: called with a
    line as each part ends; None: silent. Ctrl-C keeps the parts that are done. Returns what compare.json holds, and
    table, a text."""
def step(scenes: Iterable[Scene]) -> list[bool]:
    """Steps every scene of a list by one frame, a thread a scene, on the threads that there are (OMP_NUM_THREADS), with
    the same bits as one by one. Returns what Scene.step returns, a list. Where a scene raises an error, the others are
    stepped all the same."""
def export_run(
    run: Path, format: str, out: Path, obstacles: bool, progress: Callable[[int, int], object] | None
) -> list[pathlib.Path]:
    """What selvedge.export calls. progress: called with the frames that were read and their number; or None."""
def page_of(runs: Sequence[Path], limit: int) -> str:
    """The page that selvedge.view shows, as HTML."""
def trajectory_contents(file: Path) -> Contents:
    """What selvedge.read_trajectory says of a run before its frames are read."""
def trajectory_frames(
    file: Path,
    numbers: Sequence[int],
    x: npt.NDArray[np.float32],
    obstacles: Sequence[npt.NDArray[np.float32]],
    forces: Sequence[npt.NDArray[np.float32]],
) -> list[Report]:
    """Reads frames of a run into arrays, frames x vertices x 3 of float32: of all cloths, and of each obstacle, where
    one frame is enough of a still one. forces: empty, or the arrays of normal forces, of friction and, frames x
    vertices x 1, of pressure. Returns the frames' reports."""
