"""glTF and point caches as Blender reads them; skipped without Blender or the program (SELVEDGE_PROGRAM)."""

import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest
from ply import read_ply

BLENDER = shutil.which("blender")
PROGRAM = os.environ.get("SELVEDGE_PROGRAM")
SCRIPT = pathlib.Path(__file__).parent / "blender_frames.py"
FRAMES, FPS = 11, 24

SCENE = f"""
cloths: [{{name: sheet, rectangle: {{size: [0.4, 0.4], edge: 5 cm}}, translate: [0, 0.3, 0]}}]
obstacles: [{{name: ball, sphere: {{radius: 0.1}}}}]
run: {{frames: {FRAMES - 1}, fps: {FPS}}}
"""


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """What Blender shows of a run at every frame, by format and name, and the run's positions as PLY has them."""
    if not BLENDER:
        pytest.skip("blender is not installed")
    if not PROGRAM:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    folder = tmp_path_factory.mktemp("blender")
    (folder / "scene.yaml").write_text(SCENE)
    run = folder / "out" / "run.h5"
    for command in (
        [PROGRAM, "simulate", folder / "scene.yaml", "--out", folder / "out", "--no-view"],
        [PROGRAM, "export", run, "--format", "glb", "--out", folder, "--obstacles"],
        [PROGRAM, "export", run, "--format", "pc2", "--out", folder],
        [PROGRAM, "export", run, "--format", "ply", "--out", folder / "ply", "--obstacles"],
        [BLENDER, "--background", "--factory-startup", "--python-exit-code", "3", "--python", SCRIPT, "--", folder]
        + [str(FRAMES), str(FPS)],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    return np.load(folder / "blender.npz"), folder / "ply"


def ours(folder, name):
    return np.array([read_ply(folder / f"{name}_{frame:05}.ply") for frame in range(FRAMES)])


def test_gltf_within_its_quantisation(shown):
    theirs, folder = shown
    x = ours(folder, "cloth")
    box = (x.max(axis=(0, 1)) - x.min(axis=(0, 1))).max()
    off = np.abs(theirs["glb sheet"] - x).max()
    print(f"glTF in Blender: off by {off:.1e} m, {off / box:.1e} of the box")
    assert off < 2e-5 * box
    assert np.ptp(x, axis=0).max() > 0.1  # it moves


def test_point_cache(shown):
    theirs, folder = shown
    off = np.abs(theirs["pc2 cloth"] - ours(folder, "cloth")).max()
    print(f"PC2 in Blender: off by {off:.1e} m")
    assert off < 1e-5
