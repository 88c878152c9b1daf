"""The add-on in Blender: installed from its zip, bakes a sheet on a body of boxes (blender_addon.py).

Runs in `blender`, in this Python where it has bpy, and in each Python that SELVEDGE_BPY names (colons between them).
Skipped where there is neither, or no program (SELVEDGE_PROGRAM).
"""

import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys

import addon
import numpy as np
import pytest
from ply import read_ply

PROGRAM = os.environ.get("SELVEDGE_PROGRAM")
HERE = pathlib.Path(__file__).parent
FIRST, FRAMES = 10, 30
BLENDER = shutil.which("blender")


def hosts():
    found = [[BLENDER, "--background", "--factory-startup", "--python-exit-code", "3", "--python"]] if BLENDER else []
    found += [[python] for python in os.environ.get("SELVEDGE_BPY", "").split(os.pathsep) if python]
    return found + ([[sys.executable]] if importlib.util.find_spec("bpy") else [])


def host_name(host):
    return pathlib.Path(host[0]).parts[-3] if host else ""


@pytest.fixture(scope="module", params=hosts() or [None], ids=host_name)
def baked(request, tmp_path_factory):
    """What Blender shows, what the add-on says, and the folder of the runs."""
    if not request.param:
        pytest.skip("neither blender nor bpy is installed")
    if not PROGRAM:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    folder = tmp_path_factory.mktemp("addon")
    addon.part("pack").pack(folder / "addon.zip")
    command = [*request.param, HERE / "blender_addon.py", "--", folder / "addon.zip", folder, PROGRAM]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, env=addon.environment(folder))
    assert done.returncode == 0, done.stdout + done.stderr
    said = json.loads((folder / "said.json").read_text())
    print(f"Blender {said['version']}")
    return np.load(folder / "shown.npz"), said, folder


def trajectory(folder, run, name, count):
    """Positions as the program has them, turned to Blender's axes."""
    out = folder / f"ply_{run}"
    export = [PROGRAM, "export", folder / run, "--format", "ply", "--obstacles", "--out", out]
    subprocess.run(list(map(str, export)), check=True, capture_output=True)
    x = np.array([read_ply(out / f"{name}_{k:05}.ply") for k in range(count)], float)
    return np.stack([x[..., 0], -x[..., 2], x[..., 1]], -1)


def test_every_frame_is_that_of_the_trajectory(baked):
    shown, said, folder = baked
    assert said["clean"] and said["whole"]["message"] == "30 of 30 frames, clean"
    off = np.abs(shown["sheet"] - trajectory(folder, "first_run", "cloth", FRAMES + 1)).max()
    body_off = np.abs(shown["boxes"] - trajectory(folder, "first_run", "obstacle_0_boxes", FRAMES + 1)).max()
    print(f"cloth off by {off:.1e} m, body by {body_off:.1e} m")
    assert off < 1e-5 and body_off < 1e-5
    assert np.ptp(shown["boxes"], axis=0).max() > 0.1  # it moves


def test_the_sheet_lies_on_the_boxes(baked):
    """In Blender's own geometry, so that a wrong axis, place or size would show."""
    shown, _, _ = baked
    assert 0 < shown["gaps"].min() < 0.003
    start, end = shown["sheet"][0], shown["sheet"][-1]
    assert np.allclose(start[:, 2], 0.42, atol=1e-6)
    assert end[:, 2].min() < 0.35 < end[:, 2].max()  # it hangs over the edges of the upper box
    assert np.ptp(start, axis=0)[:2] == pytest.approx([0.631, 0.591], abs=2e-3)  # 50 x 40 cm, turned by 0.5 rad


def test_the_mesh_is_as_it_was(baked):
    _, said, _ = baked
    assert said["same mesh"] and said["frame after"] == 17 and said["fractions"] == [0, 1]
    assert said["whole"]["modifiers"] == [["selvedge", "MESH_CACHE"], ["fine", "SUBSURF"]]
    assert said["whole"]["bad"] == [] and said["whole"]["markers"] == []


def test_stopped_and_resumed(baked):
    shown, said, _ = baked
    stopped, frames = said["resume"]["stopped"], shown["stopped"]
    done = int(stopped["message"].split()[0])
    assert 3 <= done < FRAMES and "interrupted" in stopped["message"] and not stopped["clean"]
    assert np.array_equal(frames[: done + 1], shown["sheet"][: done + 1])
    assert any(text.startswith("frame ") for text in said["resume"]["texts"])
    assert said["resume"]["clean"] and said["resume"]["resumed"]["message"] == "30 of 30 frames, clean"
    assert np.array_equal(shown["resumed"], shown["sheet"])


def test_steps_of_three_frames(baked):
    shown, _, folder = baked
    assert np.abs(shown["step"][::3] - trajectory(folder, "step_run", "cloth", FRAMES // 3 + 1)).max() < 1e-5
    between = shown["step"][1] - shown["step"][0]
    assert 0 < np.abs(between).max() < np.abs(shown["step"][3] - shown["step"][0]).max()


def test_pins_go_with_the_object(baked):
    shown, _, _ = baked
    wanted = shown["pins wanted"][:6]
    assert np.ptp(wanted[..., 0], axis=0).min() > 0.005
    assert np.abs(shown["pins"][:6] - wanted).max() < 1e-6


def test_garments_baked_together(baked):
    """Each plays its own cloth of one run."""
    shown, said, folder = baked
    count = said["together"]["frames"]
    for name in ("sheet", "upper"):
        off = np.abs(shown[f"together {name}"] - trajectory(folder, "together_run", name, count)).max()
        assert off < 1e-5
    scene = (folder / "together.yaml").read_text()
    assert scene.count("  - name:") == 3 and 'material: "silk"' in scene and 'material: "cotton"' in scene
    together = said["together"]
    assert together["lower"]["clean"] and together["upper"]["message"] == together["lower"]["message"]
    assert together["upper"]["modifiers"] == [["selvedge", "MESH_CACHE"]] and together["with"] == "sheet"
    assert together["upper alone"]["modifiers"] == [] and together["with after"] == ""


def test_a_tangled_start_is_red(baked):
    _, said, _ = baked
    for found in (said["tangled"], said["operator"]):
        assert not found["clean"] and "intersecting pairs" in found["message"]
        first, last, pairs = found["bad"][0]
        assert first == FIRST <= last and pairs > 0
        assert found["markers"][0] == [FIRST, f"selvedge sheet: {pairs} pairs"]


def test_cleared(baked):
    _, said, _ = baked
    cleared = said["cleared"]
    assert cleared["modifiers"] == [["fine", "SUBSURF"]] and cleared["message"] == ""
    assert cleared["bad"] == cleared["markers"] == said["left"] == []
    assert said["unregistered"]


@pytest.mark.parametrize(
    "fault, words",
    [
        ("unsaved", "that is not saved yet\ncure: save it first"),
        ("material", "unknown material `cottn`\ncure: known: broadcloth, canvas, cotton"),
        ("hidden", "`boxes` is hidden, or is not in this view layer\ncure: show it"),
        ("cloth", "`sheet` is simulated by Blender's modifier Cloth, too\ncure: turn Cloth off"),
        ("faces", "`boxes` has other vertices or faces in frame 12 than in the first one"),
        ("pins", "`sheet` has no vertex group `nothing`"),
        ("override", "`framez` is not a key of `run`\ncure: allowed: frames"),
        ("program", "`no-such-program` cannot be started (No such file or directory)\ncure: install it"),
    ],
)
def test_faults_are_said(baked, fault, words):
    _, said, _ = baked
    found = {**said["faults"], "unsaved": said["unsaved"]}[fault]
    assert found.startswith("Failure: ") and words in found
