"""Figures of weights that ship name the file's hash, so that they part from a page when the file changes."""

import hashlib
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHIPPED = {
    file.name: hashlib.sha256(file.read_bytes()).hexdigest()[:8]
    for file in sorted((ROOT / "configs/weights").glob("*.h5"))
}
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "docs/results").glob("*.md"))]


def rows_of(text):
    """Rows of tables that name a file of weights: (file, what stands behind it)."""
    for line in text.splitlines():
        if line.startswith("|"):
            for name, behind in re.findall(r"`(\w+\.h5)`([^|]*\|?[^|]*)", line):
                if name in SHIPPED:
                    yield line, name, behind


def faults_of(text):
    """Rows whose figures are not of the file that ships. A row may say that its figures are of an earlier day."""
    return [
        line
        for line, name, behind in rows_of(text)
        if not re.match(rf" (\| )?{SHIPPED[name]}\b", behind) and not re.match(r" of \d+ \w+\b", behind)
    ]


@pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(ROOT)) for page in PAGES])
def test_rows_name_the_file_that_ships(page):
    assert faults_of(page.read_text()) == []


def test_every_network_that_ships_has_a_row():
    named = {name for _, name, _ in rows_of((ROOT / "docs/weights.md").read_text())}
    assert named == set(SHIPPED) - {"refu.h5"}  # of the repulsive layer: docs/repulsion.md


def test_a_row_of_another_file_is_found():
    name, digits = next(iter(SHIPPED.items()))
    assert faults_of(f"| `{name}` {digits} | 1 |") == []
    assert faults_of(f"| `{name}` | {digits} | 1 |") == []
    assert faults_of(f"| `{name}` of 26 November | 1 |") == []
    assert len(faults_of(f"| `{name}` 00000000 | 1 |")) == 1
    assert len(faults_of(f"| `{name}` | 1 |")) == 1
