"""The page of runs looks as it did: a picture of it, in a browser, beside one that was looked at and kept.

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
KEPT = pathlib.Path(__file__).parent / "pictures" / "demo.jpg"
PROGRAM = os.environ.get("SELVEDGE_PROGRAM")
VIEW = "view.html#frame=8&plots=0&camera=30,8&size=700x400"
COARSE = (28, 16)  # cells of the picture, in which a difference shows that a mean over all of it would not
SAME_CELL = 12  # of 255; fonts, rounding and JPEG stay below

SPEC = importlib.util.spec_from_file_location("run_tutorials", ROOT / "docs/tutorials/run.py")
runner = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(runner)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The folder of the demo's page: its first frames by the solver, and by a network."""
    if not shutil.which("chromium"):
        pytest.skip("chromium is not installed")
    if not PROGRAM:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    folder = tmp_path_factory.mktemp("pictures")
    weights = ROOT / "configs/weights/contourcraft_shown.h5"
    demo = [PROGRAM, "simulate", ROOT / "configs/demo.yaml", "--set", "run.frames=8", "--no-view"]
    for options in (
        [*demo, "--out", folder / "conventional"],
        [*demo, "--stepper", "learned", "--weights", weights, "--out", folder / "learned"],
        [PROGRAM, "view", folder / "conventional", folder / "learned", "--out", folder / "view.html"],
    ):
        done = subprocess.run(list(map(str, options)), capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr  # 1: cloth intersects
    return folder


def largest_cell(one, other):
    """The largest difference of a cell of two pictures, in any colour."""
    cells = (picture.resize(COARSE, Image.Resampling.BOX) for picture in (one, other))
    return max(high for _, high in ImageChops.difference(*cells).getextrema())


def test_the_page_of_the_demo_looks_as_it_did(page):
    shown = runner.picture_of(VIEW, page)
    if os.environ.get("SELVEDGE_KEEP_PICTURES"):
        KEPT.parent.mkdir(exist_ok=True)
        shown.save(KEPT, quality=92, optimize=True)
    kept = Image.open(KEPT).convert("RGB")
    off, cell = runner.difference(kept, shown), largest_cell(kept, shown)
    print(f"differs by {off:.2f} in the mean, by {cell} in the worst cell")
    assert off < runner.SAME and cell < SAME_CELL


def test_the_comparison_sees_what_is_small(page):
    """Another frame; another button that is pressed."""
    shown = runner.picture_of(VIEW, page)
    for change in (("frame=8", "frame=4"), ("plots=0", "plots=0&marks=0")):
        other = runner.picture_of(VIEW.replace(*change), page)
        off, cell = runner.difference(shown, other), largest_cell(shown, other)
        print(f"{change[1]} differs by {off:.2f} in the mean, by {cell} in the worst cell")
        assert off >= runner.SAME or cell >= SAME_CELL
