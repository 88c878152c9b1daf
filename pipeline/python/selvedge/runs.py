"""Runs: made, exported, shown."""

from __future__ import annotations

import html
import operator
import os
import pathlib
from collections.abc import Callable, Iterable
from typing import SupportsIndex

import numpy as np

from ._selvedge import Error, Scene, export_run, page_of
from .progress import progress_bar

Path = str | os.PathLike[str]


def simulate(
    scene: Scene,
    frames: int | None = None,
    callback: Callable[[Scene], bool | None] | None = None,
    *,
    out: Path | None = None,
    progress: bool | None = None,
) -> int:
    """Steps to that frame (the scene file's by default), or until a step is rejected or the callback, which is called
    with the scene after every frame, returns False. out: a folder in which run.h5 gets the present state and every
    frame after it, for read_trajectory, export and view; results of an earlier run there are removed. progress: a bar
    of tqdm; None: if tqdm is installed, in a notebook or on a terminal. Returns the frame that was reached."""
    frames = scene.frames if frames is None else _whole_number("simulate: frames", frames)
    if out is not None:
        scene._record(out)
    try:
        with progress_bar("frame", progress) as show:
            first = scene.frame
            while scene.frame < frames and scene.step():
                if show is not None:
                    show(scene.frame - first, frames - first)
                said = None if callback is None else callback(scene)
                if isinstance(said, bool | np.bool_) and not said:
                    break
    finally:
        if out is not None:
            scene._end_recording()
    return scene.frame


def export(
    run: Path, format: str = "obj", out: Path = "export", *, obstacles: bool = False, progress: bool | None = None
) -> list[pathlib.Path]:
    """Writes a run (a trajectory, or the folder of one) for other programs, into the folder out. format: obj, ply,
    pc2, mdd, glb, usda or xdmf (docs/export.md); obstacles: also the obstacles; progress: as for simulate. Returns the
    files in order."""
    with progress_bar("frame", progress) as show:
        return export_run(run, format, out, obstacles, show)


class Page:
    """A page that plays runs. A notebook shows it in a frame; `save` writes it for a browser."""

    def __init__(self, text: str, runs: list[str]) -> None:
        self.text = text  # HTML, which needs no other file and no network
        self.runs = runs

    def save(self, file: Path) -> pathlib.Path:
        """Writes the page, and returns where it is."""
        path = pathlib.Path(file)
        try:
            path.write_text(self.text, encoding="utf-8")
        except OSError as why:
            raise Error(f"{path}: cannot write ({why.strerror})\n  cure: give a file that may be written") from None
        return path

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.text)}" '
            'style="width: 100%; height: 640px; border: 0" allowfullscreen></iframe>'
        )

    def __repr__(self) -> str:
        return f"<selvedge.Page of {', '.join(self.runs)}: {len(self.text) / 1e6:.1f} MB>"


def view(runs: Path | Iterable[Path], *, limit: int = 60_000_000) -> Page:
    """The page that plays a run, or several side by side (trajectories, or folders of runs). limit: of its geometry, in
    bytes: runs above their share of it are drawn at every k-th frame."""
    try:
        all_runs = [os.fspath(run) for run in ([runs] if isinstance(runs, (str, os.PathLike)) else runs)]
    except TypeError:
        raise Error(f"view: runs is {runs!r}\n  cure: give a run, or a list of runs") from None
    return Page(page_of(all_runs, _whole_number("view: limit", limit)), all_runs)


def _whole_number(name: str, value: SupportsIndex) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        raise Error(f"{name} is {value!r}\n  cure: give a whole number") from None
    if not 0 <= number < 2**63:
        raise Error(f"{name} is {number}\n  cure: give 0 or more, below 2**63")
    return number
