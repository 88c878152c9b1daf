"""Functions of a worker of a Ray cluster. The driver sends them along, so that a node needs Ray alone."""

from __future__ import annotations

import hashlib
import os
import pathlib
import shutil
import tempfile
import uuid
from typing import Any, Callable, Mapping, NamedTuple

from .cell_process import CellEnd, result_folder, start_cell, wait_for_cell


class Task(NamedTuple):
    run: str  # an unpredictable name for the folder of this run on a node
    program: str  # where it is on the driver's machine
    program_hash: str  # of its bytes: SHA-256
    program_files: Any  # reference to {path: bytes}, the program last; for nodes that have another one
    key: str  # the program's own hash
    file: str  # of cells; absolute where the folder is shared, else relative to the folder of inputs
    shared: str  # the folder of results, where every node sees it; else empty


def do_cell(task: Task, name: str, inputs: Mapping[str, Any], known: bytes | None):
    """Does a cell. `inputs`: references to the bytes of the files that it needs, by their paths in the folder of
    inputs; `known`: the cell.json of a result that is there already, which the program judges. Returns CellEnd as a
    plain tuple, and the files of the result by their paths in it: None where they are in the shared folder, or where
    the known result stands."""
    node = node_folder(task.run)
    program = _program_on_node(task, node)
    if task.shared:
        return tuple(_do(program, task.key, task.file, name, task.shared)), None
    for path, reference in inputs.items():
        _put_on_node(node / "inputs" / path, lambda reference=reference: _fetch(reference))
    out = pathlib.Path(tempfile.mkdtemp(dir=node))
    try:
        result = result_folder(out, name)
        if known is not None:
            write_files(result, {"cell.json": known})
        end = _do(program, task.key, str(node / "inputs" / task.file), name, str(out))
        made = read_files(result) if end.state in ("done", "failed") else None
        return tuple(end), None if made == {"cell.json": known} else made
    finally:
        shutil.rmtree(out, ignore_errors=True)


def clean_node(run: str) -> None:
    """Removes what a run has left on a node."""
    shutil.rmtree(node_folder(run), ignore_errors=True)


def node_folder(run: str) -> pathlib.Path:
    folder = pathlib.Path(tempfile.gettempdir()) / f"selvedge-fleet-{run}"
    folder.mkdir(mode=0o700, exist_ok=True)
    return folder


def read_files(folder: pathlib.Path) -> dict[str, bytes]:
    """All files below a folder, by their paths in it."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def write_files(folder: pathlib.Path, files: Mapping[str, bytes]) -> None:
    for path, content in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)


def hash_of_file(path: str) -> str:
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def _do(program: str, key: str, file: str, name: str, out: str) -> CellEnd:
    return wait_for_cell(start_cell(program, key, file, name, out), name, out)


def _program_on_node(task: Task, node: pathlib.Path) -> str:
    """The node's own program where its bytes are the driver's, else one that travels there once."""
    chosen = node / "program" / "selvedge"
    if not chosen.exists():
        for own in (task.program, shutil.which("selvedge")):
            if own and os.access(own, os.X_OK) and hash_of_file(own) == task.program_hash:
                return _link(own, chosen)
        for path, content in _fetch(task.program_files).items():
            _put_on_node(node / "program" / path, lambda content=content: content)
    return str(chosen)


def _link(own: str, place: pathlib.Path) -> str:
    place.parent.mkdir(exist_ok=True)
    link = place.with_name(uuid.uuid4().hex)
    link.symlink_to(own)
    link.replace(place)
    return str(place)


def _put_on_node(place: pathlib.Path, content: Callable[[], bytes]) -> None:
    """Writes a file once, whole: other workers of the node may be about to do the same."""
    if place.exists():
        return
    place.parent.mkdir(parents=True, exist_ok=True)
    growing = place.with_name(uuid.uuid4().hex)
    growing.write_bytes(content())
    growing.chmod(0o700)
    growing.replace(place)


def _fetch(reference: Any) -> Any:
    import ray

    return ray.get(reference)
