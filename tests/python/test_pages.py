"""The Python of README.md and docs/python.md: every block runs as it stands there, by itself (`python -c`), beside the
files that it names."""

import os
import pathlib
import subprocess

import numpy as np
import pytest

import selvedge

RUN, BODY, SCENES, ALEMBIC, STEPPER = range(1, 6)  # the blocks of docs/python.md after the first
ROOT = pathlib.Path(__file__).resolve().parents[2]

FILES = {
    "scene.yaml": """
cloths:
  - {name: sheet, rectangle: {size: [0.4, 0.4], edge: 10 cm}, translate: [0, 0.3, 0]}
run: {frames: 3, fps: 30}
""",
    "comparison.yaml": """
scenes: [{name: fall, file: scene.yaml, states: 0}]
repeats: 1
settings:
  - {name: falling, stepper: falling}
""",
}


def blocks(page):
    return [text.split("```")[0] for text in (ROOT / page).read_text().split("```python\n")[1:]]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_block(page, number):
    """What the names of a block have come to."""
    names = {}
    exec(compile(blocks(page)[number], f"{page}, Python block {number + 1}", "exec"), names)
    return names


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_a_sheet_on_a_floor(page, folder, capsys):
    run_block(page, 0)
    last = capsys.readouterr().out.strip().splitlines()[-1].split()
    assert float(last[0]) == pytest.approx(2) and float(last[1]) > 0 and last[2] == "True"


def test_a_run_goes_out_as_alembic(folder):
    pytest.importorskip("alembic3d")
    program = os.environ.get("SELVEDGE_PROGRAM")
    if not program:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    command = [program, "simulate", "scene.yaml", "--out", "out/walk", "--no-view"]
    subprocess.run(command, check=True, capture_output=True)
    run_block("docs/python.md", ALEMBIC)
    run = selvedge.read_trajectory("out/walk")
    meshes = selvedge.read_alembic("walk.abc")
    (mesh,) = [mesh for mesh in meshes.values() if np.shape(mesh["x"]) == run["x"].shape]
    assert mesh["fps"] == pytest.approx(30) and (np.array(mesh["x"]) == run["x"]).all()


def test_a_stepper_in_python(folder):
    names = run_block("docs/python.md", STEPPER)
    assert names["scene"].step() and names["scene"].v[:, 1] == pytest.approx(-9.81 / 30)
    (row,) = names["rows"]
    assert row["setting"] == "falling" and not row["trouble"] and row["finished"] == 1


def test_a_run_is_recorded_read_exported_and_shown(folder, capsys):
    try:
        run_block("docs/python.md", RUN)
    except selvedge.Error as error:
        if "three" not in str(error):
            raise
        pytest.skip("three.js is not there")
    assert "4 frames" in capsys.readouterr().out and (folder / "out/fall/run.glb").exists()
    assert (folder / "fall.html").read_text(encoding="utf-8").startswith("<!")


def test_a_sleeve_on_a_limb(folder, capsys):
    scene = run_block("docs/python.md", BODY)["scene"]
    assert scene.frame == 15 and scene.clean and "270 vertices" in capsys.readouterr().out


def test_scenes_side_by_side(folder):
    names = run_block("docs/python.md", SCENES)
    assert names["accepted"] == 3 * [3 * [True]]
    heights = [scene.x[:, 1].min() for scene in names["scenes"]]
    assert heights == sorted(heights, reverse=True) and len(set(heights)) == 3


def test_no_block_is_left_out():
    assert len(blocks("README.md")) == 1 and len(blocks("docs/python.md")) == 6  # a new block needs a test of its own
