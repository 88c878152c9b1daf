"""Trajectories: what runs have recorded, as arrays."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING, TypedDict

import numpy as np
import numpy.typing as npt

from ._selvedge import Error, trajectory_contents, trajectory_frames

if TYPE_CHECKING:  # the stub alone has it
    from ._selvedge import Report

Floats = npt.NDArray[np.float32]
Path = str | os.PathLike[str]


class RecordedObstacle(TypedDict):
    """An obstacle of a run."""

    name: str
    triangles: npt.NDArray[np.int32]
    x: Floats  # frames x k x 3 [m], to be read only; of an obstacle that never moves a view of one frame


class RecordedForces(TypedDict):
    """What contact exerts on each vertex of a run (docs/files.md#contact-forces); NaN where it is not known."""

    normal: Floats  # frames x n x 3 [N]
    friction: Floats  # frames x n x 3 [N]
    pressure: Floats  # frames x n [Pa]


if TYPE_CHECKING:

    class Trajectory(TypedDict):
        """A run, as read_trajectory describes it."""

        x: Floats
        time: npt.NDArray[np.float64]
        fps: float
        triangles: npt.NDArray[np.int32]
        rest: npt.NDArray[np.float64]
        cloths: list[tuple[str, int, int]]
        pins: npt.NDArray[np.int32]
        contact_forces: RecordedForces | None
        obstacles: list[RecordedObstacle]
        reports: list[Report]

else:

    class Trajectory(dict):
        """A run, as read_trajectory describes it: a dict whose repr says sizes."""

        def __init__(self, *arrays: dict[str, object], **more: object) -> None:
            if arrays and isinstance(arrays[0], str | os.PathLike):
                raise Error(f"{arrays[0]}: a run is read by selvedge.read_trajectory(file)")
            super().__init__(*arrays, **more)

        def __repr__(self) -> str:
            frames, vertices, _ = self["x"].shape
            cloths, triangles, obstacles = (len(self[name]) for name in ("cloths", "triangles", "obstacles"))
            return (
                f"<selvedge.Trajectory: {_counted(frames, 'frame')} at {self['fps']:g} frames a second; "
                f"{_counted(cloths, 'cloth')} of {vertices} vertices, {_counted(triangles, 'triangle')}; "
                f"{_counted(obstacles, 'obstacle')}>"
            )


def read_trajectory(file: Path, frames: slice | None = None, into: Path | None = None) -> Trajectory:
    """A run: its run.h5, or the folder of one; it may still be growing. frames: which, as slice(0, None, 10); None:
    all. into: a file (.npy) that becomes the array x, mapped into memory, for runs that are larger than the memory;
    run.h5 itself cannot be mapped, since it keeps every frame in a place of its own. Contact forces are then mapped
    into files beside it. With x.npy these are x_contact_normal.npy, x_contact_friction.npy and x_contact_pressure.npy.

    Returns x, positions, frames x n x 3 of float32 [m]; time, of each frame [s]; fps; triangles, m x 3; rest, n x 3
    [m]; cloths, of each its name, its first vertex and the end of its vertices; pins, vertices; contact_forces,
    where the run has them (run.contact_forces), else None: normal and friction, frames x n x 3 [N], and pressure,
    frames x n [Pa], of float32, not a number where they are not known; obstacles, of each its name, its triangles and
    x, frames x k x 3 [m]; reports, of each frame a dict by the names of docs/files.md."""
    contents = trajectory_contents(file)
    numbers = _numbers(contents["frame_count"], frames)
    x = _array(into, (len(numbers), len(contents["rest"]), 3))
    bodies = [
        np.empty((len(x) if body["moving"] else min(len(x), 1), body["vertex_count"], 3), dtype=np.float32)
        for body in contents["obstacles"]
    ]
    forces = _forces(into, x.shape) if contents["contact_forces"] else None
    reports = trajectory_frames(
        file,
        numbers,
        x,
        bodies,
        [forces["normal"], forces["friction"], forces["pressure"][:, :, np.newaxis]] if forces else [],
    )
    obstacles: list[RecordedObstacle] = [
        {"name": body["name"], "triangles": body["triangles"], "x": np.broadcast_to(own, (len(x), *own.shape[1:]))}
        for body, own in zip(contents["obstacles"], bodies)
    ]
    return Trajectory(
        x=x,
        time=np.array([report["time"] for report in reports], dtype=np.float64),
        fps=contents["fps"],
        triangles=contents["triangles"],
        rest=contents["rest"],
        cloths=contents["cloths"],
        pins=contents["pins"],
        contact_forces=forces,
        obstacles=obstacles,
        reports=reports,
    )


def _numbers(count: int, frames: slice | None) -> list[int]:
    try:
        if frames is None or isinstance(frames, slice):
            return list(range(count)[slice(None) if frames is None else frames])
    except (TypeError, ValueError):  # not whole numbers, or a step of 0
        pass
    raise Error(f"read_trajectory: frames is {frames!r}\n  cure: give a slice: slice(0, None, 10) is every tenth frame")


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _forces(into: Path | None, shape: tuple[int, ...]) -> RecordedForces:
    frames, vertices, _ = shape

    def array(name: str, *row: int) -> Floats:
        beside = None if into is None else pathlib.Path(into).with_name(f"{pathlib.Path(into).stem}_contact_{name}.npy")
        return _array(beside, (frames, vertices, *row))

    return {"normal": array("normal", 3), "friction": array("friction", 3), "pressure": array("pressure")}


def _array(into: Path | None, shape: tuple[int, ...]) -> Floats:
    if into is None:
        return np.empty(shape, dtype=np.float32)
    if 0 in shape:
        raise Error(f"{os.fspath(into)}: there is nothing to map into memory: {shape[0]} frames of {shape[1]} vertices")
    try:
        return np.lib.format.open_memmap(os.fspath(into), mode="w+", dtype=np.float32, shape=shape)
    except OSError as why:
        raise Error(
            f"{os.fspath(into)}: cannot write ({why.strerror})\n  cure: give a file in a folder that may be written"
        ) from None
