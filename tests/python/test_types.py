"""Type checkers find nothing in the package, in its stub and in the pages' Python. Skipped where pyright is absent."""

import importlib.util
import json
import pathlib
import subprocess
import sys

import pytest

import selvedge

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = pathlib.Path(selvedge.__file__).parent
OPTIONAL = ("ray", "alembic3d", "tqdm")  # where they are absent, pyright cannot find what the package imports of them

# What a stub must say, and what it must refuse.
USE = """
import numpy as np
import selvedge

scene = selvedge.Scene()
number: int = scene.add_cloth(np.zeros((3, 3)), [[0, 1, 2]], material={"density": 0.2})
names: list[str] = [obstacle["name"] for obstacle in scene.obstacles]
heights = selvedge.read_trajectory("out/run")["x"][:, :, 1]
accepted: list[bool] = selvedge.step([scene])
version: str = selvedge.__version__
"""
MISUSE = """
import selvedge

scene = selvedge.Scene()
scene.add_cloth([[0, 0, 0]], [[0, 0, 0]], densty=1.0)
selvedge.simulate("scene.yaml")
"""


def complaints(*paths):
    """Files and lines of what pyright calls errors."""
    command = [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable]
    run = subprocess.run([*command, *map(str, paths)], capture_output=True, text=True, cwd=PACKAGE.parent)
    if not run.stdout.startswith("{"):
        pytest.skip(f"pyright does not run: {(run.stdout + run.stderr)[-200:]}")
    found = json.loads(run.stdout)["generalDiagnostics"]
    absent = tuple(f'Import "{name}' for name in OPTIONAL if importlib.util.find_spec(name) is None)
    errors = [one for one in found if one["severity"] == "error" and not one["message"].startswith(absent)]
    return [(pathlib.Path(one["file"]).name, one["range"]["start"]["line"] + 1) for one in errors]


@pytest.fixture(autouse=True)
def pyright():
    if importlib.util.find_spec("pyright") is None:
        pytest.skip("pyright is not there")


def test_the_package_and_its_stub(tmp_path):
    assert complaints(PACKAGE) == []


def test_pages_and_uses(tmp_path):
    (tmp_path / "use.py").write_text(USE)
    (tmp_path / "misuse.py").write_text(MISUSE)
    for page in ("README.md", "docs/python.md"):
        for k, text in enumerate((ROOT / page).read_text().split("```python\n")[1:]):
            (tmp_path / f"{pathlib.Path(page).stem}_{k}.py").write_text(text.split("```")[0])
    assert complaints(*sorted(tmp_path.glob("*.py"))) == [("misuse.py", 5), ("misuse.py", 6)]
