"""The list of the cells of a file, as the program prints it."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
from typing import NamedTuple

try:
    from .._selvedge import Error as Error
except ImportError:  # the extension is not built, and nothing here needs it
    Error = ValueError


class Cell(NamedTuple):
    name: str
    needs: tuple[str, ...]  # absolute paths
    cost: float  # rough [s]


class Listing(NamedTuple):
    program: str  # path
    key: str  # the program's hash
    file: str  # absolute path
    cells: list[Cell]  # the longest first


def find_program(program: str | os.PathLike[str] | None) -> str:
    """The program that was given, or the one beside the package in a build folder, or the one on PATH."""
    beside = pathlib.Path(__file__).resolve().parents[3] / "selvedge"
    asked = [program] if program is not None else [beside, "selvedge"]
    for candidate in asked:
        if found := shutil.which(candidate):
            return os.path.abspath(found)
    raise Error(f"{asked[-1]}: no such program\n  cure: put selvedge on PATH, or give program=")


def call(program: str, *arguments: str) -> str:
    """The output of the program. Raises Error, with its message, if its input is bad."""
    ended = subprocess.run([program, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if ended.returncode not in (0, 1):
        why = ended.stderr.strip() or f"ended with status {ended.returncode}"
        raise Error(f"selvedge {arguments[0]}: {why}")
    return ended.stdout


def list_cells(program: str, file: str | os.PathLike[str]) -> Listing:
    """The cells of a file, by falling cost, in the file's order where costs are equal."""
    listed = json.loads(call(program, "cells", os.fspath(file), "--json"))
    cells = [Cell(c["name"], tuple(map(os.path.abspath, c["needs"])), float(c["cost"])) for c in listed["cells"]]
    return Listing(program, listed["program"], os.path.abspath(file), sorted(cells, key=lambda c: -c.cost))
