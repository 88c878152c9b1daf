"""Simulated workers against sums that are easy to check, and the table of docs/scale.md against the program."""

import pathlib
import subprocess
import sys

import makespan

HERE = pathlib.Path(__file__).resolve().parent


def test_cells_of_known_times():
    assert makespan.makespan([3, 3, 2, 2, 2], 2) == 7 and makespan.makespan([2, 2, 2, 3, 3], 2) == 7
    assert makespan.makespan([1, 1, 1, 3], 2) == 4 and makespan.makespan([3, 1, 1, 1], 2) == 3
    assert makespan.ideal([3, 1, 1, 1], 2) == 3 and makespan.ideal([3, 3, 3], 2) == 4.5
    assert makespan.makespan([5, 4], 8) == 5 == makespan.ideal([5, 4], 8)


def test_the_table_of_the_page():
    said = subprocess.run([sys.executable, HERE / "makespan.py"], capture_output=True, text=True, check=True).stdout
    page = (HERE.parents[1] / "docs" / "results" / "cells.md").read_text()
    for order, span, over in (line.strip("| ").split(" | ") for line in said.splitlines()[2:]):
        assert f"| {span} | {over} |" in page, order
