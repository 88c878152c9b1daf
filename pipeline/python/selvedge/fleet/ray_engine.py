"""Cells on a cluster, by Ray 2, which is imported when this engine is chosen."""

from __future__ import annotations

import os
import pathlib
import secrets
import shutil
import socket
import uuid
from typing import Any

from . import cell_process, ray_worker
from .cell_process import GRACE, LONGEST_MESSAGE, CellEnd, result_folder
from .listing import Cell, Error, Listing


class RayEngine:
    """Does each cell as a task of one core. A task is never retried by Ray: `run` counts the tries of every engine."""

    def __init__(self, listing: Listing, out: str, workers: int | None, address: str | None, shared: bool) -> None:
        self._ray = ray = _library()
        for module in (cell_process, ray_worker):
            ray.cloudpickle.register_pickle_by_value(module)
        self.at_once = workers or len(listing.cells)
        self._out = pathlib.Path(out)
        self._shared = shared
        self._top = _common_folder(listing)
        self._file = listing.file
        self._inputs: dict[str, Any] = {}
        self._running: dict[Any, str] = {}
        self._run_name = secrets.token_hex(8)
        self._started = _connect(ray, address)
        self._task = ray.put(self._task_of(listing))
        self._do_cell = ray.remote(num_cpus=1, max_retries=0)(ray_worker.do_cell)

    def start(self, cell: Cell) -> None:
        known = result_folder(self._out, cell.name) / "cell.json"
        told = known.read_bytes() if not self._shared and known.is_file() else None
        reference = self._do_cell.remote(self._task, cell.name, self._inputs_of(cell), told)
        self._running[reference] = cell.name

    def wait(self, seconds: float) -> CellEnd | None:
        """The end of a cell that has ended, with its result in its place, or None after so long."""
        ready, _ = self._ray.wait(list(self._running), timeout=seconds)
        if not ready:
            return None
        name = self._running[ready[0]]
        try:
            end, files = self._ray.get(ready[0])
        except self._ray.exceptions.RayError as why:  # the worker or its node is gone, or the node's disk is full
            end, files = CellEnd(name, "lost", str(why).strip()[-LONGEST_MESSAGE:]), None
        if files is not None:
            keep_result(self._out, name, files)
        del self._running[ready[0]]
        return CellEnd(*end)

    def stop(self) -> None:
        """Interrupts all cells; none runs afterwards."""
        running = list(self._running)
        for force in (False, True):
            for reference in running:
                self._ray.cancel(reference, force=force)
            _, running = self._ray.wait(running, num_returns=len(running), timeout=GRACE) if running else ([], [])

    def close(self) -> None:
        """Removes what the run has left on the nodes, and ends the cluster where this engine has started it."""
        on_node = self._ray.util.scheduling_strategies.NodeAffinitySchedulingStrategy
        clean = self._ray.remote(num_cpus=0, max_retries=0)(ray_worker.clean_node)
        cleaned = [
            clean.options(scheduling_strategy=on_node(node["NodeID"], soft=False)).remote(self._run_name)
            for node in self._ray.nodes()
            if node["Alive"]
        ]
        self._ray.wait(cleaned, num_returns=len(cleaned), timeout=GRACE)
        if self._started:
            self._ray.shutdown()

    def _task_of(self, listing: Listing) -> ray_worker.Task:
        return ray_worker.Task(
            run=self._run_name,
            program=listing.program,
            program_hash=ray_worker.hash_of_file(listing.program),
            program_files=self._ray.put(_program_files(pathlib.Path(listing.program))),
            key=listing.key,
            file=listing.file if self._shared else os.path.relpath(listing.file, self._top),
            shared=str(self._out) if self._shared else "",
        )

    def _inputs_of(self, cell: Cell) -> dict[str, Any]:
        """References to the files that a cell needs, each of which goes into the object store once."""
        if self._shared:
            return {}
        files = [file for need in (self._file, *cell.needs) for file in _files_at(pathlib.Path(need))]
        for file in files:
            if file not in self._inputs:
                self._inputs[file] = self._ray.put(pathlib.Path(file).read_bytes())
        return {os.path.relpath(file, self._top): self._inputs[file] for file in files}


def keep_result(out: pathlib.Path, name: str, files: dict[str, bytes]) -> None:
    """Puts a result in its place, whole; an older one of another key is replaced."""
    place = result_folder(out, name)
    place.parent.mkdir(parents=True, exist_ok=True)
    growing, older = (place.with_name(f".{name}.{uuid.uuid4().hex}") for _ in range(2))
    try:
        ray_worker.write_files(growing, files)
        if place.exists():
            place.rename(older)
        growing.rename(place)
    finally:
        for left in (growing, older):
            shutil.rmtree(left, ignore_errors=True)


def _library():
    try:
        import ray
        import ray.cloudpickle
        import ray.exceptions
        import ray.util.scheduling_strategies
    except ImportError as why:
        raise Error(f"engine ray: Ray cannot be imported ({why}); pip install selvedge-cloth[fleet]") from why
    return ray


def _connect(ray, address: str | None) -> bool:
    """Whether a connection was made here: to that cluster, or as Ray finds or starts one without an address."""
    if ray.is_initialized():
        if address is not None:
            raise Error(f"address: is {address}, and this process has a connection already; call ray.shutdown() first")
        return False
    _expect_listener(address)
    try:
        ray.init(address=address, log_to_driver=False, logging_level="ERROR")
    except (ConnectionError, ValueError, RuntimeError) as why:
        raise Error(f"engine ray: no cluster at {address or 'this machine'} ({why})") from why
    return True


def _expect_listener(address: str | None) -> None:
    """Ends at once for an address without a listener, which Ray tries to reach for minutes."""
    host, colon, port = (address or "").rpartition(":")
    if colon and port.isdigit() and "/" not in host:
        try:
            socket.create_connection((host.strip("[]"), int(port)), timeout=GRACE).close()
        except OSError as why:
            raise Error(f"engine ray: no cluster at {address} ({why})") from why


def _common_folder(listing: Listing) -> str:
    """The deepest folder that holds all inputs."""
    inputs = [listing.file, *(need for cell in listing.cells for need in cell.needs)]
    return os.path.commonpath([os.path.dirname(path) for path in inputs])


def _files_at(path: pathlib.Path) -> list[str]:
    if path.is_dir():
        return [str(file) for file in sorted(path.rglob("*")) if file.is_file()]
    return [str(path)]


def _program_files(program: pathlib.Path) -> dict[str, bytes]:
    """The program, after what it finds by name wherever it is: materials, bodies, outfits (`configs` beside it)."""
    folder = program.resolve().parent
    for configs in (folder / "../share/selvedge/configs", folder / "configs", folder / "../../configs"):
        if configs.is_dir():
            scenes = sorted(configs.rglob("*.yaml"))
            files = {f"configs/{file.relative_to(configs)}": file.read_bytes() for file in scenes}
            return {**files, "selvedge": program.read_bytes()}
    return {"selvedge": program.read_bytes()}
