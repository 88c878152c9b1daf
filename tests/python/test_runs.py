"""Runs from Python: recorded, read, exported, shown; states kept; scenes side by side; what the commands do."""

import os
import pathlib
import subprocess

import numpy as np
import pytest
from interrupting import interrupted_when

import selvedge

ROOT = pathlib.Path(__file__).resolve().parents[2]

SCENE = """
cloths:
  - name: sheet
    rectangle: {size: [0.4, 0.4], edge: 5 cm}
    translate: [0, 0.12, 0]
obstacles:
  - name: ball
    sphere: {radius: 0.1}
  - name: floor
    plane: {size: [2, 2], edge: 0.5}
    translate: [0, -0.1, 0]
    motion: {keyframes: [{time: 0}, {time: 1, translate: [0, 0.01, 0]}]}
run: {frames: 8, fps: 30}
"""


@pytest.fixture
def scene_file(tmp_path):
    (tmp_path / "scene.yaml").write_text(SCENE)
    return tmp_path / "scene.yaml"


@pytest.fixture
def run(scene_file, tmp_path):
    selvedge.simulate(selvedge.Scene(scene_file), out=tmp_path / "run")
    return tmp_path / "run"


def falling(height=0.3, n=6):
    u = np.linspace(0, 0.5, n)
    x = np.array([[a, height, b] for b in u for a in u])
    quads = [(j * n + i, j * n + i + 1, j * n + n + i, j * n + n + i + 1) for j in range(n - 1) for i in range(n - 1)]
    scene = selvedge.Scene()
    scene.add_cloth(x, [t for a, b, c, d in quads for t in ((a, c, b), (b, c, d))], name="sheet")
    scene.add_obstacle([[-1, 0, -1], [-1, 0, 1], [1, 0, -1], [1, 0, 1]], [[0, 1, 2], [2, 1, 3]], name="floor")
    return scene


@pytest.mark.parametrize("frames", [3, -1, [0, 2], np.arange(3), slice(0, None, 0), slice("a", None), "all"])
def test_frames_of_a_trajectory_are_a_slice(frames, run):
    with pytest.raises(selvedge.Error, match="read_trajectory: frames is (.|\n)*give a slice"):
        selvedge.read_trajectory(run, frames=frames)
    assert len(selvedge.read_trajectory(run, slice(-2, None))["x"]) == 2


def test_errors_name_arguments_and_no_flags(run, scene_file, tmp_path):
    cases = [
        (lambda: selvedge.fit(run, frame=99), "`frame`: frame 99"),
        (lambda: selvedge.fit(run), "`scene`|`body`"),
        (lambda: selvedge.export(run, "fbx", tmp_path / "x"), "`format`: unknown format"),
        (lambda: selvedge.plan(scene_file, ["run.frames"]), "`overrides` run.frames.*\n.*example `overrides` run"),
        (lambda: selvedge.Scene(scene_file).restore(tmp_path / "none.h5"), "is not there\n.*`save`"),
        (lambda: falling().restore(run / "run.h5"), "restore a state that `save` wrote"),
    ]
    for call, words in cases:
        with pytest.raises(selvedge.Error, match=words) as refused:
            call()
        assert "--" not in str(refused.value)


def test_a_run_is_one_array_with_what_was_in_the_scene(scene_file, tmp_path):
    scene = selvedge.Scene(scene_file)
    seen, obstacles = [scene.x.copy()], [scene.obstacles]

    def keep(s):
        seen.append(s.x.copy())
        obstacles.append(s.obstacles)

    assert selvedge.simulate(scene, callback=keep, out=tmp_path / "run") == 8
    run = selvedge.read_trajectory(tmp_path / "run")
    assert run["x"].shape == (9, len(scene.rest), 3) and run["x"].dtype == np.float32
    assert (run["x"] == np.array(seen, np.float32)).all()
    assert run["time"] == pytest.approx(np.arange(9) / 30) and run["fps"] == 30
    assert (run["rest"] == scene.rest).all() and (run["triangles"] == scene.triangles).all()
    assert run["cloths"] == scene.cloths == [("sheet", 0, len(scene.rest))] and len(run["pins"]) == 0
    for k, name in enumerate(["ball", "floor"]):
        assert run["obstacles"][k]["name"] == obstacles[0][k]["name"] == name
        assert (run["obstacles"][k]["triangles"] == obstacles[0][k]["triangles"]).all()
        assert (run["obstacles"][k]["x"] == np.array([now[k]["x"] for now in obstacles], np.float32)).all()
    assert [report["solves"] > 0 for report in run["reports"]] == [False] + 8 * [True]
    assert repr(run) == (
        f"<selvedge.Trajectory: 9 frames at 30 frames a second; 1 cloth of {len(scene.rest)} vertices, "
        f"{len(scene.triangles)} triangles; 2 obstacles>"
    )
    assert selvedge.Trajectory(run).keys() == run.keys()
    with pytest.raises(selvedge.Error, match="run: a run is read by selvedge.read_trajectory"):
        selvedge.Trajectory(tmp_path / "run")


def test_a_recording_takes_the_place_of_an_earlier_run(run, scene_file, tmp_path):
    for name in ("summary.json", "view.html", "checkpoint.h5"):
        (run / name).write_text("of an earlier run")
    (run / "notes.txt").write_text("of the user")
    scene = selvedge.Scene(scene_file)

    def look(scene):
        assert sorted(os.listdir(run)) == ["notes.txt", "run.h5", "run.lock"]
        with pytest.raises(selvedge.Error, match="another run writes into this folder"):
            selvedge.simulate(selvedge.Scene(scene_file), 1, out=run)
        with pytest.raises(selvedge.Error, match="recorded already"):
            selvedge.simulate(scene, 8, out=tmp_path / "second")

    assert selvedge.simulate(scene, 2, look, out=run) == 2
    assert sorted(os.listdir(run)) == ["notes.txt", "run.h5"]
    assert len(selvedge.read_trajectory(run)["x"]) == 3
    (tmp_path / "file").write_text("")
    with pytest.raises(selvedge.Error, match="cannot make this folder"):
        selvedge.simulate(scene, 3, out=tmp_path / "file" / "run")


def test_some_frames_and_an_array_in_a_file(run, tmp_path):
    whole = selvedge.read_trajectory(run / "run.h5")
    some = selvedge.read_trajectory(run, slice(2, None, 3), tmp_path / "x.npy")
    assert isinstance(some["x"], np.memmap) and some["x"].shape[0] == 3
    assert (some["x"] == whole["x"][2::3]).all() and (some["time"] == whole["time"][2::3]).all()
    assert (some["obstacles"][1]["x"] == whole["obstacles"][1]["x"][2::3]).all()
    assert some["obstacles"][0]["x"].shape == whole["obstacles"][0]["x"][2::3].shape
    some["x"].flush()
    assert (np.load(tmp_path / "x.npy", mmap_mode="r") == some["x"]).all()
    with pytest.raises(selvedge.Error, match="x.npy: cannot write (.|\n)*cure: give a file in a folder"):
        selvedge.read_trajectory(run, into=tmp_path / "absent" / "x.npy")
    assert not (tmp_path / "absent").exists()
    with pytest.raises(selvedge.Error, match="nothing to map"):
        selvedge.read_trajectory(run, slice(0, 0), tmp_path / "none.npy")
    assert selvedge.read_trajectory(run, slice(0, 0))["x"].shape == (0, *whole["x"].shape[1:])


def test_a_recorded_run_is_that_of_the_program(run, scene_file, tmp_path):
    program = os.environ.get("SELVEDGE_PROGRAM")
    if not program:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    command = [program, "simulate", scene_file, "--out", tmp_path / "other", "--no-view"]
    subprocess.run(command, check=True, capture_output=True)
    ours, theirs = selvedge.read_trajectory(run), selvedge.read_trajectory(tmp_path / "other")
    assert (ours["x"] == theirs["x"]).all()
    for a, b in zip(ours["reports"], theirs["reports"]):
        assert {k: v for k, v in a.items() if "seconds" not in k} == {k: v for k, v in b.items() if "seconds" not in k}


def test_export_writes_files_and_says_how_far_it_is(run, tmp_path, capsys):
    files = selvedge.export(run, "obj", tmp_path / "meshes", obstacles=True)
    assert len(files) == 19 and all(file.exists() for file in files)
    assert capsys.readouterr().err == ""  # nobody looks
    (glb,) = selvedge.export(run, "glb", tmp_path / "meshes", progress=False)
    assert glb.read_bytes()[:4] == b"glTF"
    with pytest.raises(selvedge.Error, match="unknown format `fbx`"):
        selvedge.export(run, "fbx", tmp_path / "meshes")


def test_what_a_progress_raises_ends_an_export(run, tmp_path):
    def fail(done, all):
        raise KeyError(f"{done} of {all}")

    with pytest.raises(KeyError, match="1 of 9"):
        selvedge._selvedge.export_run(run, "obj", tmp_path / "none", False, fail)
    assert len(selvedge.export(run, "obj", tmp_path / "meshes")) > 0


def test_progress_is_a_bar_of_tqdm(run, tmp_path, capsys):
    pytest.importorskip("tqdm")
    selvedge.export(run, "obj", tmp_path / "meshes", progress=True)
    assert "9/9" in capsys.readouterr().err
    selvedge.simulate(falling(), 2, progress=True)
    assert "2/2" in capsys.readouterr().err


def test_a_notebook_shows_the_page_in_a_frame(run, tmp_path):
    try:
        page = selvedge.view(run)
    except selvedge.Error as error:
        if "three" not in str(error):
            raise
        pytest.skip("three.js is not there")
    shown = page._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "<script" not in shown and shown.count('"') == 4
    assert page.save(tmp_path / "page.html").read_text(encoding="utf-8") == page.text
    assert "MB" in repr(page) and "run" in repr(page)
    assert selvedge.view((run, run), limit=np.int64(0)).runs == [os.fspath(run)] * 2
    refused = [(run, -1, "limit is -1"), (run, 1.5, "limit is 1.5"), (7, 0, "runs is 7"), ([7], 0, "runs is")]
    for runs, limit, words in refused:
        with pytest.raises(selvedge.Error, match=f"view: {words}(.|\n)*cure: give"):
            selvedge.view(runs, limit=limit)
    with pytest.raises(selvedge.Error, match="absent.*cannot write"):
        selvedge.view(run).save(tmp_path / "absent" / "page.html")


def test_reprs_say_sizes():
    assert repr(falling()) == (
        "<selvedge.Scene: 1 cloth of 36 vertices, 50 triangles; 1 obstacle of 4 vertices; frame 0, 0 s>"
    )
    assert repr(selvedge.Scene()) == (
        "<selvedge.Scene: 0 cloths of 0 vertices, 0 triangles; 0 obstacles of 0 vertices; frame 0, 0 s>"
    )


def test_the_version_is_that_of_the_project():
    project = ROOT / "pyproject.toml"
    if not project.exists():
        pytest.skip("pyproject.toml is not beside the tests")
    assert f'\nversion = "{selvedge.__version__}"\n' in project.read_text()


def test_obstacles_say_where_they_are_before_and_after_a_step():
    scene = falling()
    (floor,) = scene.obstacles
    assert floor["name"] == "floor" and floor["x"].shape == (4, 3) and floor["triangles"].shape == (2, 3)
    scene.move_obstacle(0, floor["x"] + [0, 0.01, 0])
    assert scene.step()
    assert scene.obstacles[0]["x"] == pytest.approx(floor["x"] + [0, 0.01, 0])


def test_an_obstacle_that_is_refused_leaves_nothing():
    scene = falling()
    with pytest.raises(selvedge.Error, match="vertex 9"):
        scene.add_obstacle([[0, 0, 0], [1, 0, 0], [0, 0, 1]], [[0, 1, 9]], name="bad")
    far = {"translate": [999999.5, 0, 0]}  # a vertex lies beyond 1000 km
    with pytest.raises(selvedge.Error, match="in row 1"):
        scene.add_body([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [[0, 0, 0]], [[1]] * 3, [-1], **far)
    assert [one["name"] for one in scene.obstacles] == ["floor"]
    scene.add_obstacle([[5, 0, 0], [6, 0, 0], [5, 0, 1]], [[0, 1, 2]], name="good")
    assert scene.step() and [one["name"] for one in scene.obstacles] == ["floor", "good"]


def test_a_saved_state_goes_on_with_the_same_bits(tmp_path, scene_file):
    for make in (falling, lambda: selvedge.Scene(scene_file)):
        scene = make()
        selvedge.simulate(scene, 5)
        scene.save(tmp_path / "state.h5")
        view = scene.x
        selvedge.simulate(scene, 8)
        after = scene.x.copy()
        scene.restore(tmp_path / "state.h5")
        assert scene.frame == 5 and scene.report == {} and np.shares_memory(view, scene.x)
        selvedge.simulate(scene, 8)
        assert (scene.x == after).all()
        other = make()
        other.restore(tmp_path / "state.h5")
        selvedge.simulate(other, 8)
        assert (other.x == after).all()
    with pytest.raises(selvedge.Error, match="another scene"):
        selvedge.Scene(scene_file, ["cloths.0.material.density=0.3"]).restore(tmp_path / "state.h5")
    with pytest.raises(selvedge.Error, match="vertices"):
        falling(n=5).restore(tmp_path / "state.h5")


def test_scenes_side_by_side_have_the_bits_of_scenes_one_by_one():
    heights = [0.02, 0.05, 0.3, 0.1, 0.01]
    alone, beside = [falling(h) for h in heights], [falling(h) for h in heights]
    for _ in range(6):
        assert selvedge.step(beside) == [scene.step() for scene in alone] == 5 * [True]
    for a, b in zip(alone, beside):
        assert (a.x == b.x).all() and (a.v == b.v).all() and a.frame == b.frame == 6
    assert selvedge.step([]) == selvedge.step(()) == []
    assert selvedge.step(scene for scene in alone[:2]) == selvedge.step(tuple(beside[:2])) == 2 * [True]
    assert (alone[1].x == beside[1].x).all()
    with pytest.raises(selvedge.Error, match="step, scenes: is no list"):
        selvedge.step(alone[0])
    with pytest.raises(selvedge.Error, match="twice"):
        selvedge.step([alone[0], alone[0]])
    with pytest.raises(selvedge.Error, match="scene 1: is no Scene"):
        selvedge.step([alone[0], 3])


def test_a_scene_that_cannot_be_stepped_leaves_the_others_alone():
    good, bad = falling(), falling()
    bad.x[0, 0] = np.nan
    with pytest.raises(selvedge.Error, match="row 0"):
        selvedge.step([bad, good])
    assert good.frame == 1 and bad.frame == 0

    class Fails(selvedge.Stepper):
        def step(self, start, drive, dt):
            raise ZeroDivisionError

    scenes = [selvedge.Scene(stepper=Fails) for _ in range(3)]
    for scene in scenes:
        scene.add_cloth([[0, 0, 0], [1, 0, 0], [0, 0, 1]], [[0, 1, 2]])
    with pytest.raises(ZeroDivisionError):
        selvedge.step(scenes)


def test_a_plan_says_what_is_left_out(scene_file):
    plan = selvedge.plan(scene_file)
    assert plan and "wind" in str(plan)
    with pytest.raises(selvedge.Error, match="frame"):
        selvedge.plan(scene_file, ["run.framess=3"])


def test_the_fit_has_a_number_a_vertex(run, scene_file, tmp_path):
    fit = selvedge.fit(run, scene=scene_file, body="ball", frame=3)
    n = selvedge.read_trajectory(run)["x"].shape[1]
    assert fit["frame"] == 3 and all(fit[name].shape == (n,) for name in ("gap", "strain", "pressure", "row"))
    wrongs = [({"frame": -1}, "frame"), ({"body": "bal"}, "bal")]
    wrongs += [({"reach": reach}, "reach") for reach in (0.0, np.inf, np.nan)]
    for wrong, words in wrongs:
        with pytest.raises(selvedge.Error, match=words):
            selvedge.fit(run, scene=scene_file, **wrong)


def test_drapes_are_made_and_trained_on_and_ctrl_c_ends_a_training(tmp_path):
    root = ROOT / "configs"
    if not (root / "data" / "drape_tiny.yaml").exists():
        pytest.skip("configs/data is not there")
    lines = []
    data = selvedge.dataset(root / "data" / "drape_tiny.yaml", tmp_path / "data", log=lines.append)
    assert data["finished"] and len(lines) >= 4 and not any("\n" in line for line in lines)

    training, given = root / "training" / "refu_tiny.yaml", [f"drapes={tmp_path / 'data'}"]
    # It would go on for hours: Ctrl-C comes while the work is in C++.
    long = [*given, "backbone.stage.steps=100000000"]

    begun = (tmp_path / "long" / "config.yaml").exists
    with pytest.raises(KeyboardInterrupt), interrupted_when(begun):
        selvedge.train(training, tmp_path / "long", long, log=None)
    assert list((tmp_path / "long").glob("*.h5"))  # the checkpoint of its first stage

    def fail(line):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        selvedge.train(training, tmp_path / "failed", given, log=fail)
    with pytest.raises(selvedge.Error, match="folder"):
        selvedge.dataset(root / "data" / "drape_tiny.yaml", tmp_path / "data", ["seed=5"], log=None)
