"""The Python package. A run is compared with the bits of the program that SELVEDGE_PROGRAM names, if it names one."""

import gc
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import selvedge


def sheet(n, size=1.0, height=0.0):
    u = np.linspace(0, size, n)
    x = np.array([[a, height, b] for b in u for a in u])
    quads = [(j * n + i, j * n + i + 1, j * n + n + i, j * n + n + i + 1) for j in range(n - 1) for i in range(n - 1)]
    triangles = [t for a, b, c, d in quads for t in ((a, c, b), (b, c, d))]
    return x, np.array(triangles)


def falling():
    scene = selvedge.Scene()
    scene.add_cloth(*sheet(8, 0.5, 0.3), name="sheet")
    x, triangles = sheet(2, 4.0)
    scene.add_obstacle(x - [2, 0, 2], triangles, name="floor")
    return scene


def test_a_sheet_falls_on_a_floor_and_stays_clean():
    scene = falling()
    frames = []
    assert selvedge.simulate(scene, 40, lambda s: frames.append(s.frame)) == 40
    assert frames == list(range(1, 41))
    assert scene.clean and scene.pairs == 0
    assert 0 < scene.x[:, 1].min() < scene.x[:, 1].max() < 0.02
    assert scene.time == pytest.approx(40 / 30)


def test_the_report_of_a_step_says_all_that_there_is():
    scene = falling()
    assert scene.report == {}
    assert scene.step()
    report = scene.report
    assert report["status"] == "accepted" and report["reason"] == "none" and report["by"] == "conventional"
    assert report["solves"] > 0 and report["solve_seconds"] > 0 and report["iterations"] == 0  # it falls freely
    for name in ("untangling", "pushed_out"):
        assert report[name] == 0
    for name in ("out_of_newton", "out_of_untangling", "out_of_response", "out_of_proofs"):
        assert report[name] is False
    assert not any(report[name] for name in ("not_converged", "penetrating", "energy_gain"))
    assert report["unsolved"] >= 0 and report["pairs_after"] == scene.pairs


def test_positions_are_views_that_follow_the_steps():
    scene = falling()
    x = scene.x
    before = x.copy()
    scene.step()
    assert x is not scene.x and np.shares_memory(x, scene.x)
    assert (x != before).any() and (x == scene.x).all()
    x[:, 0] += 1
    assert scene.x[0, 0] == x[0, 0]
    # A view keeps its scene alive.
    del scene
    gc.collect()
    assert np.isfinite(x).all()


def test_the_callback_ends_a_run():
    assert selvedge.simulate(falling(), 40, lambda s: s.frame < 3) == 3


@pytest.mark.parametrize("stop", [False, np.False_])
def test_a_callback_that_returns_false_ends_a_run(stop):
    assert selvedge.simulate(falling(), 10, lambda s: stop if s.frame == 3 else None) == 3


def test_written_positions_are_not_known_to_be_clean(tmp_path):
    def two():
        scene = selvedge.Scene()
        for height in (0.3, 0.31):
            scene.add_cloth(*sheet(6, 0.3, height))
        return scene

    scene = two()
    assert scene.step() and scene.clean and scene.pairs == 0
    crossed = scene.x.copy()
    crossed[36:, 1] = 0.3 + 0.1 * (crossed[36:, 0] - 0.15)
    scene.x = crossed
    assert not scene.clean and scene.pairs == -1
    scene.save(tmp_path / "crossed.h5")
    fresh = two()
    fresh.restore(tmp_path / "crossed.h5")
    assert not fresh.clean
    assert scene.step() and scene.report["pairs_before"] != 0  # it was looked for, and not taken for clean
    scene.x[0, 1] += 0.01  # by the view
    assert not scene.clean and scene.pairs == -1


def test_names_are_free_ones_or_refused():
    scene = selvedge.Scene()
    for height in (0, 1):
        scene.add_cloth(*sheet(2, 1, height))
    scene.add_obstacle(*sheet(2, 1, -1), name="a")
    assert [name for name, _, _ in scene.cloths] == ["cloth", "cloth_1"]
    for add, name, words in [
        (scene.add_cloth, "cloth", "the name `cloth` of another"),
        (scene.add_obstacle, "a", "the name `a` of another"),
        (scene.add_cloth, "", "is empty"),
    ]:
        with pytest.raises(selvedge.Error, match=words):
            add(*sheet(2, 1, 2), name=name)


def test_scenes_of_an_iterable_live_while_they_step():
    assert selvedge.step(falling() for _ in range(8)) == [True] * 8


def test_an_obstacle_moves():
    scene = falling()
    x, _ = sheet(2, 4.0)
    for frame in range(30):
        scene.move_obstacle(0, x - [2, 0.0, 2] + [0, 0.01 * (frame + 1), 0])
        scene.step()
    assert scene.x[:, 1].min() > 0.29 and scene.clean


def test_a_cloth_of_loose_triangles_is_warned_of():
    x, triangles = sheet(4)
    with pytest.warns(UserWarning, match="not welded"):
        selvedge.Scene().add_cloth(x[triangles].reshape(-1, 3), np.arange(triangles.size).reshape(-1, 3), name="soup")


@pytest.mark.parametrize(
    "x, triangles, words",
    [
        (np.zeros((3, 2)), [[0, 1, 2]], ["cloth `c`, x", "(3, 2)"]),
        (np.array([["a"] * 3] * 3), [[0, 1, 2]], ["cloth `c`, x", "<U1"]),
        ([[0, 0, 0], [1, 0, 0], [0, np.nan, 1]], [[0, 1, 2]], ["cloth `c`, x", "row 2"]),
        (np.eye(3), [[0, 1, 3]], ["cloth `c`, triangles", "vertex 3", "row 0"]),
        (np.eye(3), [[0, 1, -1]], ["triangles", "vertex -1"]),
        (np.eye(3), [[0.5, 1, 2]], ["triangles", "float64"]),
        (np.eye(3), [[0, 1, 1]], ["triangle 0", "twice"]),
        (np.eye(3), [0, 1, 2], ["triangles", "(3,)"]),
        (np.eye(3), np.zeros((0, 3), int), ["triangles", "no rows"]),
        (np.ma.array(np.eye(3), mask=np.eye(3) > 0), [[0, 1, 2]], ["cloth `c`, x", "masked"]),
    ],
)
def test_bad_arrays_say_what_and_where(x, triangles, words):
    with pytest.raises(selvedge.Error) as error:
        selvedge.Scene().add_cloth(x, triangles, name="c")
    assert all(word in str(error.value) for word in words), str(error.value)
    assert isinstance(error.value, ValueError)


def test_a_mask_that_hides_nothing_and_a_face_whose_edges_cross():
    x, triangles = sheet(3)
    selvedge.Scene().add_cloth(np.ma.array(x), triangles)
    corners = [[0, 0, 0], [0, 0, 1], [1, 0, 0], [1, 0, 1]]  # not in their order round the square
    with pytest.warns(UserWarning, match="cloth `bow`: 1 pair of neighbouring triangles lies flat on each other"):
        selvedge.Scene().add_cloth(corners, [[0, 1, 2], [0, 2, 3]], name="bow")


@pytest.mark.parametrize(
    "name, value",
    [
        ("density", -3),
        ("density", 0),
        ("density", np.nan),
        ("density", np.inf),
        ("youngs_modulus", -1),
        ("youngs_modulus", 1e300),
        ("poisson", 2),
        ("poisson", 1),
        ("poisson", -0.5),
        ("bending", -1e-9),
        ("bending", np.nan),
    ],
)
def test_numbers_that_no_material_has_are_refused(name, value):
    scene = selvedge.Scene()
    with pytest.raises(selvedge.Error) as error:
        scene.add_cloth(*sheet(3), name="c", **{name: value})
    assert "cloth `c`, material" in str(error.value) and f"{name} is {value:g}" in str(error.value), str(error.value)
    assert "allowed: " in str(error.value)
    with pytest.raises(selvedge.Error, match="no cloth"):
        scene.step()


def test_positions_beyond_what_a_scene_can_show_are_refused():
    x, triangles = sheet(3)
    far = x.copy()
    far[4, 1] = 1e18
    with pytest.raises(selvedge.Error, match="row 4"):
        selvedge.Scene().add_cloth(far, triangles)
    with pytest.raises(selvedge.Error, match="row 4"):
        selvedge.Scene().add_obstacle(far, triangles)
    with pytest.raises(selvedge.Error, match="row 4"):
        selvedge.untangle(far, triangles)
    scene = falling()
    with pytest.raises(selvedge.Error, match="row 0"):
        scene.move_obstacle(0, [[1e30, 0, 0]] * 4)
    scene.x[5, 0] = np.nan
    with pytest.raises(selvedge.Error, match="x.*row 5"):
        scene.step()
    scene.x[5, 0] = 0
    scene.v[6, 2] = 1e200
    with pytest.raises(selvedge.Error, match="v.*row 6"):
        scene.step()


@pytest.mark.parametrize("frames", [-1, 2.5, np.nan, "3"])
def test_frames_are_a_whole_number(frames):
    with pytest.raises(selvedge.Error, match="frames is"):
        selvedge.simulate(falling(), frames)


def test_a_scene_without_cloth_and_a_late_cloth_are_refused():
    with pytest.raises(selvedge.Error, match="no cloth"):
        selvedge.Scene().step()
    scene = falling()
    scene.step()
    with pytest.raises(selvedge.Error, match="before the first step"):
        scene.add_cloth(*sheet(3))


def test_check_and_untangle():
    x, triangles = sheet(9)
    y, _ = sheet(9)
    y = np.stack([y[:, 0] * 0.3 + 0.355, y[:, 2] * 0.3 - 0.2, np.full(len(y), 0.513)], axis=1)  # stands across it
    both = np.vstack([x, y]), np.vstack([triangles, triangles + len(x)])
    assert selvedge.check(x, triangles)["self_pairs"] == 0
    assert selvedge.check(*both)["self_pairs"] > 0
    moved, report = selvedge.untangle(*both)
    assert report["pairs_before"] == selvedge.check(*both)["self_pairs"]
    assert selvedge.check(moved, both[1])["self_pairs"] == report["pairs_after"]


def test_bodies_come_in_any_sequence():
    x, triangles = sheet(9)
    body = (np.stack([x[:, 0] * 0.3 + 0.355, x[:, 2] * 0.3 - 0.2, np.full(len(x), 0.513)], axis=1), triangles)
    alone = selvedge.check(x, triangles, [body])
    assert alone["body_pairs"] > 0
    in_array = np.empty(1, object)
    in_array[0] = body
    for bodies in [(body,), [list(body)], iter([body]), {"only": body}.values(), in_array]:
        assert selvedge.check(x, triangles, bodies) == alone
    assert selvedge.untangle(x, triangles, (body,))[1]["pairs_before"] > 0
    assert len(selvedge.contours(x, triangles, ())) == 0
    for bodies, words in [(5, "bodies: is no list"), (body, "body 0: is no pair")]:
        with pytest.raises(selvedge.Error, match=words):
            selvedge.check(x, triangles, bodies)


def test_what_no_scene_file_can_say_is_refused_in_a_line():
    x, triangles = sheet(4)
    with pytest.raises(selvedge.Error, match="material: holds what a scene file cannot say") as error:
        selvedge.Scene().add_cloth(x, triangles, material={"density": {1}})
    assert "Traceback" not in str(error.value) and len(str(error.value).splitlines()) == 2


def test_pins_are_a_list_or_a_mask():
    x, triangles = sheet(9)
    held = np.isclose(x[:, 0], x[:, 0].min())
    ends = []
    for pins in (np.flatnonzero(held), held, held.tolist(), np.flatnonzero(held).astype(">i4")):
        scene = selvedge.Scene()
        scene.add_cloth(x.astype(">f8"), triangles, pins=pins)
        selvedge.simulate(scene, 2)
        ends.append(scene.x.copy())
        assert (ends[-1][held] == x[held]).all() and (ends[-1] == ends[0]).all()
    for mask in (held[1:], np.stack([held, held])):
        with pytest.raises(selvedge.Error, match="pins: "):
            selvedge.Scene().add_cloth(x, triangles, pins=mask)


def turns_beside(work):
    """How often another thread has its turn while the work is done."""
    turns, done = [], threading.Event()

    def count():
        while not done.wait(0.001):
            turns.append(time.monotonic())

    thread = threading.Thread(target=count)
    thread.start()
    begin = time.monotonic()
    work()
    end = time.monotonic()
    done.set()
    thread.join()
    return sum(begin < turn < end for turn in turns)


def test_other_threads_go_on_beside_long_work():
    x, triangles = sheet(300)
    y = x[:, [0, 2, 1]] * 0.3 + [0.355, -0.2, 0.513]  # stands across it
    body = (y, triangles)
    # Work that holds the lock lets the other thread have one turn or two, before and after.
    assert turns_beside(lambda: selvedge.check(x, triangles, [body])) > 5
    assert turns_beside(lambda: selvedge.distance(y, x, triangles)) > 5
    assert turns_beside(lambda: selvedge.untangle(x, triangles, [body], iterations=1)) > 5


def test_contours():
    x, triangles = sheet(9)
    y = np.array([[0.4, -0.2, 0.513], [0.6, -0.2, 0.507], [0.51, 0.3, 0.511]])  # hangs through the sheet
    both = np.vstack([x, y]), np.vstack([triangles, [[81, 82, 83]]])
    assert selvedge.contours(x, triangles) == []
    as_one, as_two = selvedge.contours(*both), selvedge.contours(x, triangles, [(y, [[0, 1, 2]])])
    for found, sheets in ((as_one, [0, 0]), (as_two, [0, 1])):
        assert len(found) == 1 and not found[0]["closed"]
        assert [side["sheet"] for side in found[0]["sides"]] == sheets
        assert found[0]["points"][:, 1] == pytest.approx(0, abs=1e-12)
        steps = np.linalg.norm(np.diff(found[0]["points"], axis=0), axis=1)
        assert found[0]["length"] == pytest.approx(steps.sum())


def test_distances():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    points = np.array([[0.1, 0.1, 0.05], [0.2, 0.3, -2], [-3, -4, 0]])
    found = selvedge.distance(points, corners, faces)
    assert found["value"] == pytest.approx([-0.05, 2, 5])
    assert found["gradient"][1] == pytest.approx([0, 0, -1]) and found["triangle"][1] == 0
    assert found["closest"][2] == pytest.approx([0, 0, 0])
    with pytest.raises(selvedge.Error, match="points.*row 1"):
        selvedge.distance([[0, 0, 0], [0, np.inf, 0]], corners, faces)


def test_memory_of_a_thousand_steps_does_not_grow():
    scene = selvedge.Scene()
    scene.add_cloth(*sheet(4, 0.2, 0.3))

    def resident():
        with open("/proc/self/statm") as f:
            return int(f.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    for _ in range(100):
        scene.step()
    before = resident()
    for _ in range(1000):
        scene.step()
        scene.x, scene.v
    assert resident() - before < 2e6


SCENE = """
cloths:
  - name: sheet
    rectangle: {size: [0.4, 0.4], edge: 5 cm}
    translate: [0, 0.3, 0]
obstacles:
  - name: ball
    sphere: {radius: 0.1}
run: {frames: 100, fps: 30}
"""


def test_a_run_has_the_bits_of_the_program(tmp_path):
    program = os.environ.get("SELVEDGE_PROGRAM")
    if not program:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    (tmp_path / "scene.yaml").write_text(SCENE)
    subprocess.run([program, "simulate", tmp_path / "scene.yaml", "--out", tmp_path / "out", "--no-view"], check=True,
                   capture_output=True)
    run = selvedge.read_trajectory(tmp_path / "out" / "run.h5")
    scene = selvedge.Scene(tmp_path / "scene.yaml")
    assert scene.frames == 100 and run["fps"] == 30
    positions = [scene.x.astype(np.float32)]
    selvedge.simulate(scene, callback=lambda s: positions.append(s.x.astype(np.float32)))
    assert len(positions) == len(run["x"]) == 101
    assert (np.array(positions) == run["x"]).all()
    assert (scene.triangles == run["triangles"]).all()
    last = run["reports"][-1]
    assert last["time"] == run["time"][-1] and last["status"] == "accepted" and last["self_pairs"] == 0
    assert all(last[name] == value for name, value in scene.report.items() if not name.endswith("_seconds"))


def test_point_caches(tmp_path):
    frames = np.array([[[0.5, 1, -2], [3, 0.25, 0]], [[1, 1, 1], [2, 2, 2]]], dtype="<f2")
    head = b"POINTCACHE2\0" + np.array([1, 2], "<i4").tobytes() + np.array([0, 1], "<f4").tobytes()
    (tmp_path / "a.pc16").write_bytes(head + np.array([2], "<i4").tobytes() + frames.tobytes())
    cache = selvedge.read_cache(tmp_path / "a.pc16")
    assert cache["fps"] == 0 and (np.array(cache["x"]) == frames).all()


def test_absurdly_many_threads_are_taken_back_with_a_warning():
    environment = dict(os.environ, OMP_NUM_THREADS="100000")
    code = "import selvedge; s = selvedge.Scene(); print('imported')"
    run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert run.stdout == "imported\n"
    assert "RuntimeWarning: OMP_NUM_THREADS=100000 is more than" in run.stderr
    refused = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], env=environment, capture_output=True, text=True
    )
    assert refused.returncode == 1 and "RuntimeWarning" in refused.stderr


def test_a_sliver_does_not_hold_a_sheet_in_the_air():
    x, triangles = sheet(6, 0.5, 0.3)
    plain, sliver = selvedge.Scene(), selvedge.Scene()
    plain.add_cloth(x, triangles)
    more = np.vstack([x, (x[0] + x[1]) / 2, [0, 0.9, 0]])  # on the rim; in no triangle
    with pytest.warns(UserWarning, match="1 triangle of zero rest area is left out"):
        sliver.add_cloth(more, np.vstack([triangles, [0, 1, len(x)]]), name="sheet")
    for _ in range(5):
        assert plain.step() and sliver.step()
    assert np.array_equal(sliver.x[: len(x)], plain.x)
    assert np.allclose(sliver.x[len(x)], (plain.x[0] + plain.x[1]) / 2)  # it follows
    assert sliver.x[len(x) + 1, 1] == 0.9
    for shape in ([0, 0, 0], [1, 0, 0]):
        with pytest.raises(selvedge.Error, match="has no triangle with an area"):
            selvedge.Scene().add_cloth(x * shape, triangles)
