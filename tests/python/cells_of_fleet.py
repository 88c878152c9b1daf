"""What the tests of selvedge.fleet share: a work file for the program that stands in, and what its tries have left."""

import json
import os
import pathlib
import sys
import time

import pytest


class Work:
    """A folder with a work file, a program and the marks of its tries."""

    def __init__(self, folder, cells):
        self.folder, self.out = folder, folder / "out"
        self.file = folder / "work" / "cells.json"
        self.marks = folder / "marks"
        self.marks.mkdir()
        (folder / "meshes").mkdir()
        (folder / "meshes" / "a.txt").write_text("a mesh")
        self.file.parent.mkdir()
        self.file.write_text(json.dumps({"marks": str(self.marks), "needs": ["../meshes/a.txt"], "cells": cells}))
        self.program = folder / "selvedge"
        text = pathlib.Path(__file__).with_name("cells_program.py").read_text()
        self.program.write_text(f"#!{sys.executable}\n{text}")
        self.program.chmod(0o755)

    def tries(self, name="*"):
        """(name, process, its parent, OMP_NUM_THREADS) of every try, in the order of their beginnings."""
        marks = sorted(self.marks.glob(f"{name}.try.*[0-9]"), key=lambda mark: int(mark.suffix[1:]))
        return [(mark.name.split(".")[0], *json.loads(mark.read_text())) for mark in marks]

    def interrupted(self):
        return len(list(self.marks.glob("*.interrupted")))

    def release(self):
        (self.marks / "release").touch()

    def results(self, out=None):
        """Every file of every result, with its bytes."""
        cells = (out or self.out) / "cells"
        return {str(f.relative_to(cells)): f.read_bytes() for f in cells.rglob("*") if f.is_file()}

    def rows(self):
        return [line.split(",")[0] for line in (self.out / "table.csv").read_text().splitlines()]


def wait_until(condition, what, seconds=300):
    """A bound on what hangs, not on what is slow."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            pytest.fail(f"{what}: not after {seconds} s")
        time.sleep(0.02)


def gone(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return True
    return False
