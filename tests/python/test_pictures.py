"""The page of runs looks as it did: pictures of it, in a browser, beside some that were looked at and kept.

Skipped without Chromium, Pillow or the program (SELVEDGE_PROGRAM). Where the page is to look otherwise,
SELVEDGE_KEEP_PICTURES=1 keeps the present picture; look at it before it is committed.
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess

import pytest

Image = pytest.importorskip("PIL.Image")
ImageChops = pytest.importorskip("PIL.ImageChops")
ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = pathlib.Path(__file__).parent / "pictures"
PROGRAM = os.environ.get("SELVEDGE_PROGRAM")
VIEW = "view.html#frame=8&plots=0&camera=30,8&size=700x400"
# Two sheets that cross where they begin: what is marked there does not depend on how a solver parts them.
CROSSING = """
cloths:
  - {name: flat, rectangle: {size: [0.5, 0.5], edge: 4 cm}, translate: [0, 0.3, 0]}
  - {name: upright, rectangle: {size: [0.4, 0.4], edge: 4 cm}, rotate: [90 deg, 0, 20 deg], translate: [0.05, 0.3, 0.03]}
run: {frames: 1, fps: 30}
"""
COARSE = (28, 16)  # cells of the picture, in which a difference shows that a mean over all of it would not
SAME_CELL = 12  # of 255; fonts, rounding and JPEG stay below

SPEC = importlib.util.spec_from_file_location("run_tutorials", ROOT / "docs/tutorials/run.py")
runner = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(runner)


def call(*commands):
    if not shutil.which("chromium"):
        pytest.skip("chromium is not installed")
    if not PROGRAM:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    for command in commands:
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr  # 1: cloth intersects


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The folder of the demo's page: its first frames by the solver, and by a network."""
    folder = tmp_path_factory.mktemp("pictures")
    weights = ROOT / "configs/weights/contourcraft_shown.h5"
    demo = [PROGRAM, "simulate", ROOT / "configs/demo.yaml", "--set", "run.frames=8", "--no-view"]
    call(
        [*demo, "--out", folder / "conventional"],
        [*demo, "--stepper", "learned", "--weights", weights, "--out", folder / "learned"],
        [PROGRAM, "view", folder / "conventional", folder / "learned", "--out", folder / "view.html"],
    )
    return folder


def largest_cell(one, other):
    """The largest difference of a cell of two pictures, in any colour."""
    cells = (picture.resize(COARSE, Image.Resampling.BOX) for picture in (one, other))
    return max(high for _, high in ImageChops.difference(*cells).getextrema())


def check_looks_as_kept(shown, file):
    if os.environ.get("SELVEDGE_KEEP_PICTURES"):
        file.parent.mkdir(exist_ok=True)
        shown.save(file, quality=95, subsampling=0, optimize=True)
    kept = Image.open(file).convert("RGB")
    off, cell = runner.difference(kept, shown), largest_cell(kept, shown)
    print(f"differs by {off:.2f} in the mean, by {cell} in the worst cell")
    assert off < runner.SAME and cell < SAME_CELL


def test_the_page_of_the_demo_looks_as_it_did(page):
    check_looks_as_kept(runner.picture_of(VIEW, page), KEPT / "demo.jpg")


def test_marked_intersections_look_as_they_did(tmp_path):
    (tmp_path / "crossing.yaml").write_text(CROSSING)
    call([PROGRAM, "simulate", tmp_path / "crossing.yaml", "--out", tmp_path / "crossing"])
    view = "crossing/view.html#frame=0&plots=0&camera=30,25&size=700x400"
    check_looks_as_kept(runner.picture_of(view, tmp_path), KEPT / "crossing.jpg")
    unmarked = runner.picture_of(view.replace("plots=0", "plots=0&marks=0"), tmp_path)
    assert largest_cell(Image.open(KEPT / "crossing.jpg").convert("RGB"), unmarked) >= SAME_CELL


def test_the_comparison_sees_what_is_small(page):
    """Another frame; another button that is pressed."""
    shown = runner.picture_of(VIEW, page)
    for change in (("frame=8", "frame=4"), ("plots=0", "plots=0&marks=0")):
        other = runner.picture_of(VIEW.replace(*change), page)
        off, cell = runner.difference(shown, other), largest_cell(shown, other)
        print(f"{change[1]} differs by {off:.2f} in the mean, by {cell} in the worst cell")
        assert off >= runner.SAME or cell >= SAME_CELL
