"""Overrides of a scene file: a list of texts, or a dict."""

import numpy as np
import pytest

import selvedge


@pytest.fixture
def scene(tmp_path):
    file = tmp_path / "scene.yaml"
    file.write_text("run: {frames: 3, fps: 30}\ncloths: [{name: sheet, rectangle: {size: [0.2, 0.2], edge: 0.1}}]\n")
    return file


@pytest.mark.parametrize(
    "overrides",
    [
        ["run.frames=7", "run.fps=60", "cloths.0.name=a b"],
        ("run.frames=7", "run.fps=60", "cloths.0.name=a b"),
        {"run.frames": 7, "run.fps": 60.0, "cloths.0.name": "a b"},
        {"run": {"frames": np.int64(7), "fps": np.float32(60)}, "cloths": {0: {"name": "a b"}}},
        {"run.frames": "7", "run.fps": 60, "cloths.0.name": "a b", "cloths.0.rectangle.size": np.array([0.3, 0.2])},
    ],
)
def test_texts_and_dicts_say_the_same(scene, overrides):
    read = selvedge.Scene(scene, overrides)
    assert (read.frames, read.fps, read.cloths[0][0]) == (7, 60, "a b")
    selvedge.plan(scene, overrides)


@pytest.mark.parametrize(
    "overrides, problem",
    [
        ("run.frames=7", "overrides: is one text"),
        (7, "overrides: is no list"),
        ([7], "overrides: holds what is no text"),
        ({"run.frames": object()}, "overrides, run.frames: holds what a scene file cannot say"),
        ({"run.frame": 7}, "`frame` is not a key of `run`"),
    ],
)
def test_other_overrides_are_refused_with_the_form(scene, overrides, problem):
    for call in (selvedge.Scene, selvedge.plan):
        with pytest.raises(selvedge.Error, match=problem):
            call(scene, overrides)
    if "not a key" not in problem:
        with pytest.raises(selvedge.Error, match=problem):
            selvedge.train(scene, overrides=overrides)
