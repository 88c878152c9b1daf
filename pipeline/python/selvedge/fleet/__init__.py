"""Many cells on many cores or machines, by the program `selvedge`, which lists, does and gathers them."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import time
from collections import Counter, deque

from .cell_process import CellEnd, result_folder
from .listing import Error, Listing, call, find_program, list_cells
from .local_engine import LocalEngine
from .progress import Progress

__all__ = ["FleetResult", "run"]


@dataclasses.dataclass(frozen=True)
class FleetResult:
    """The results of a run over the cells of a file. Names are in the order in which cells ended."""

    done: list[str]  # cells with a result
    failed: dict[str, str]  # cells whose result has a failed row; what the program printed
    missing: dict[str, str]  # cells without a result, and why
    seconds: float  # by the clock, from the listing to the end of gathering
    gathered: str  # what `selvedge gather` printed


def run(
    file: str | os.PathLike[str],
    out: str | os.PathLike[str],
    engine: str = "local",
    *,
    program: str | os.PathLike[str] | None = None,
    workers: int | None = None,
    retries: int = 2,
    address: str | None = None,
    shared: bool = False,
    progress: bool = True,
) -> FleetResult:
    """Does all cells of a file into a folder and gathers them, the longest first, each with one thread.

    engine: "local", processes of this machine, or "ray", tasks of a Ray cluster. program: `selvedge`; None: the one
    beside the package in a build folder, or on PATH. workers: cells at a time; None: one a core. retries: how often a
    cell is tried again whose process, worker or node died. address: of the Ray cluster; None: as Ray finds one, or
    starts one here. shared: the file, all that cells need, and `out` have the same paths on every node; otherwise files
    travel.

    Results of this program and these settings are kept. Raises Error if the file, the program, the folder or an argument
    is bad; a cell that is refused is in `missing` with its message. Ctrl-C interrupts the cells, leaves nothing running
    and raises KeyboardInterrupt; the same call then continues."""
    begun = time.monotonic()
    _check(engine, workers, retries)
    listing = list_cells(find_program(program), file)
    folder = pathlib.Path(out).absolute()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as why:
        raise Error(f"{folder}: cannot make this folder ({why.strerror})\n  cure: give another out") from why
    said = Progress(listing.cells, {c.name for c in listing.cells if result_folder(folder, c.name).is_dir()}, progress)
    ends = _do_all(listing, _engine(engine, listing, str(folder), workers, address, shared), retries, said)
    by_state = {state: {e.name: e.message for e in ends if e.state == state} for state in ("done", "failed")}
    missing = {e.name: e.message for e in ends if e.state in ("refused", "lost")}
    gathered = call(listing.program, "gather", listing.file, "--out", str(folder)) if len(missing) < len(ends) else ""
    return FleetResult(list(by_state["done"]), by_state["failed"], missing, time.monotonic() - begun, gathered)


def _check(engine: str, workers: int | None, retries: int) -> None:
    if engine not in ("local", "ray"):
        raise Error(f'engine: is {engine!r}\n  cure: give "local" or "ray"')
    if workers is not None and workers < 1:
        raise Error(f"workers: is {workers}\n  cure: give 1 or more")
    if retries < 0:
        raise Error(f"retries: is {retries}\n  cure: give 0 or more")


def _engine(engine: str, listing: Listing, out: str, workers: int | None, address: str | None, shared: bool):
    if engine == "local":
        return LocalEngine(listing, out, workers)
    from .ray_engine import RayEngine

    return RayEngine(listing, out, workers, address, shared)


def _do_all(listing: Listing, engine, retries: int, said: Progress) -> list[CellEnd]:
    """How each cell ended at last."""
    waiting, running, tries, ends = deque(listing.cells), {}, Counter(), []
    try:
        while waiting or running:
            while waiting and len(running) < engine.at_once:
                cell = waiting.popleft()
                running[cell.name] = cell
                engine.start(cell)
            if end := engine.wait(0.5):
                cell = running.pop(end.name)
                again = end.state == "lost" and tries[cell.name] < retries
                if again:
                    tries[cell.name] += 1
                    waiting.appendleft(cell)
                else:
                    ends.append(end)
                said.ended(cell.name, "again" if again else end.state)
            said.show()
    except BaseException:
        engine.stop()
        raise
    finally:
        engine.close()
        said.show(last=True)
    return ends
