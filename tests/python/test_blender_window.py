"""The add-on's buttons in a Blender with a window, on a display that nobody sees (Xvfb): blender_window.py.

Skipped where Blender, xvfb-run or the program (SELVEDGE_PROGRAM) is absent.
"""

import json
import os
import pathlib
import shutil
import subprocess
import time

import addon
import pytest

PROGRAM = os.environ.get("SELVEDGE_PROGRAM")
HERE = pathlib.Path(__file__).parent
FRAMES = 600
QUIT_WITHIN = 60  # seconds in which the program has to end after Blender, on a busy machine


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """What the script saw, and its folder."""
    for name in ("blender", "xvfb-run"):
        if not shutil.which(name):
            pytest.skip(f"{name} is not installed")
    if not PROGRAM:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    folder = tmp_path_factory.mktemp("window")
    addon.part("pack").pack(folder / "addon.zip")
    small = ["--window-geometry", 0, 0, 640, 400]  # drawn by the processor
    blender = ["blender", *small, "--factory-startup", "--python-exit-code", "3", "--python"]
    display = ["xvfb-run", "-a", "-s", "-screen 0 640x400x24"]
    command = [*display, *blender, HERE / "blender_window.py", "--", folder / "addon.zip", folder, PROGRAM]
    done = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, env=addon.environment(folder), timeout=500
    )
    assert done.returncode == 0 and (folder / "seen.json").is_file(), done.stdout + done.stderr
    return json.loads((folder / "seen.json").read_text()), folder


def test_progress_and_stop(seen):
    found, _ = seen
    assert found["pressed"] == ["RUNNING_MODAL"] and found["body"] and not found["twice"]
    assert found["progress"].startswith("frame ") and 0 < found["fraction"] < 1
    stopped = found["stopped"]
    assert 0 < int(stopped["message"].split()[0]) < FRAMES and "interrupted" in stopped["message"]
    assert stopped["modifiers"] == [["selvedge", "MESH_CACHE"]] and not stopped["error"]


def test_resume(seen):
    found, _ = seen
    assert found["resumed"]["message"] == f"{FRAMES} of {FRAMES} frames, clean" and found["resumed"]["clean"]


def test_frames_with_pairs_are_a_red_strip_on_the_timeline(seen):
    found, _ = seen
    print(f"red columns: {found['before']} without frames with pairs, {found['strip']} with 21 of them")
    assert found["before"] == 0 and found["strip"] > 20


def test_a_fault_is_shown(seen):
    found, _ = seen
    what, cure = found["fault"]["error"].split("\n")
    assert "unknown material `cottn`" in what and "did you mean `cotton`?" in cure


def test_the_program_ends_with_blender(seen):
    _, folder = seen
    summary, deadline = folder / "selvedge" / "sheet" / "run" / "summary.json", time.monotonic() + QUIT_WITHIN
    while not summary.is_file() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert json.loads(summary.read_text())["end"] == "interrupted"
