"""Steppers written in Python."""

import gc
import json
import pathlib
import threading
import weakref

import numpy as np
import pytest
from interrupting import interrupted_when

import selvedge

SCENE = """
cloths:
  - name: sheet
    rectangle: {size: [0.4, 0.4], edge: 10 cm}
    translate: [0, 0.3, 0]
    pins: [{vertices: [0]}]
obstacles:
  - name: floor
    plane: {size: [2, 2], edge: 0.5}
run: {frames: 5, fps: 30}
"""

COMPARISON = """
scenes: [{name: fall, file: scene.yaml, states: 0}]
repeats: 1
settings:
  - {name: thrown, stepper: thrown}
  - {name: conventional, stepper: conventional}
"""


class Thrown(selvedge.Stepper):
    """Every vertex falls by itself."""

    def step(self, start, drive, dt):
        v = start.v + dt * np.array(drive.acceleration)
        return start.x + dt * v, v


@pytest.fixture
def scene_file(tmp_path):
    (tmp_path / "scene.yaml").write_text(SCENE)
    return tmp_path / "scene.yaml"


def square(height=0.0, size=1.0):
    corners = [[0, height, 0], [0, height, size], [size, height, 0], [size, height, size]]
    return np.array(corners), [[0, 1, 2], [2, 1, 3]]


def test_it_steps_a_scene_of_arrays_and_is_told_what_is_there():
    seen = []

    class Watcher(Thrown):
        def __init__(self, scene):
            super().__init__(scene)
            seen.append(scene)

        def step(self, start, drive, dt):
            seen.append((start.frame, start.obstacles, drive.obstacles, dt))
            return super().step(start, drive, dt)

    scene = selvedge.Scene(stepper=Watcher)
    scene.add_cloth(*square(1), name="sheet", density=0.3)
    scene.add_obstacle(*square(-1, 3))
    assert scene.step() and scene.clean
    dt = 1 / 30
    assert scene.x[:, 1] == pytest.approx(1 - 9.81 * dt * dt)
    assert scene.v[:, 1] == pytest.approx(-9.81 * dt)
    arrays, (frame, before, wanted, step) = seen
    assert arrays.masses == pytest.approx([0.05, 0.1, 0.1, 0.05]) and arrays.cloths == [("sheet", 0, 4)]
    assert arrays.rest.shape == (4, 3) and arrays.triangles.tolist() == [[0, 1, 2], [2, 1, 3]]
    assert frame == 0 and step == dt and (before[0] == wanted[0]).all() and len(arrays.obstacles[0]) == 2


def test_its_states_are_audited():
    scene = selvedge.Scene(stepper=Thrown)
    scene.add_cloth(*square(0.05))
    scene.add_obstacle(np.array([[-1, 0, -1], [-1, 0, 2], [2, 0, -1], [2, 0.06, 2]]), [[0, 1, 2], [2, 1, 3]])
    reached = selvedge.simulate(scene, 20, lambda s: s.clean)
    assert 0 < reached < 20 and not scene.clean and scene.pairs > 0


def test_positions_alone_give_velocities_and_pins_stay_pinned(scene_file):
    class Lifted(selvedge.Stepper):
        def step(self, start, drive, dt):
            assert drive.pins == pytest.approx(start.x[self.scene.pins])
            return start.x + [0, 0.01, 0]

    scene = selvedge.Scene(scene_file, ["run.stepper=lifted"], kinds={"lifted": Lifted})
    before = scene.x.copy()
    assert selvedge.simulate(scene) == 5
    assert (scene.x[0] == before[0]).all()
    assert scene.x[1:, 1] == pytest.approx(before[1:, 1] + 0.05)
    assert scene.v[1:, 1] == pytest.approx(0.3) and (scene.v[0] == 0).all()


@pytest.mark.parametrize("made", [None, lambda x: x * np.nan, lambda x: x + 1e9])
def test_nothing_and_what_is_not_finite_reject_a_step(made):
    class Fails(selvedge.Stepper):
        def step(self, start, drive, dt):
            return made and made(start.x)

    scene = selvedge.Scene(stepper=Fails)
    scene.add_cloth(*square())
    assert not scene.step() and scene.frame == 0 and (scene.x == square()[0]).all()


def test_mistakes_in_a_stepper_say_what_and_where():
    def scene_of(result):
        class Wrong(selvedge.Stepper):
            def step(self, start, drive, dt):
                return result(start.x)

        scene = selvedge.Scene(stepper=Wrong)
        scene.add_cloth(*square())
        return scene

    with pytest.raises(selvedge.Error, match=r"`python`, x: has 3 rows"):
        scene_of(lambda x: x[:3]).step()
    with pytest.raises(selvedge.Error, match=r"`python`, v: has the shape \(4,\)"):
        scene_of(lambda x: (x, x[:, 0])).step()
    with pytest.raises(ZeroDivisionError):
        scene_of(lambda x: 1 / 0).step()
    for wrong, message in [(("glue",), "`glue` is no force"), ("wind", "is no tuple")]:
        scene = selvedge.Scene(stepper=type("Wrong", (Thrown,), {"ignores": wrong}))
        scene.add_cloth(*square())
        with pytest.raises(selvedge.Error, match=message):
            scene.step()
    with pytest.raises(selvedge.Error, match="no subclass"):
        selvedge.Scene(stepper=dict)
    with pytest.raises(selvedge.Error, match="no subclass"):
        selvedge.Scene(stepper=Thrown(None))


@pytest.mark.parametrize("need", ["needs_worn", "needs_obstacles"])
def test_what_it_needs_of_a_scene_of_arrays_is_asked_for(need):
    scene = selvedge.Scene(stepper=type("Needy", (Thrown,), {need: True}))
    scene.add_cloth(*square())
    with pytest.raises(selvedge.Error, match="does not take this scene: it needs"):
        scene.step()


def test_forces_that_it_ignores_have_no_energy(scene_file, tmp_path):
    class Blind(Thrown):
        ignores = ("membrane",)

    comparison = COMPARISON.replace("conventional", "blind").replace("states: 0", "states: 1, horizon: 2")
    (tmp_path / "comparison.yaml").write_text(comparison)
    kinds = {"thrown": Thrown, "blind": Blind}
    with pytest.raises(selvedge.Error, match="kinds: has the name 3"):
        selvedge.compare(tmp_path / "comparison.yaml", kinds={3: Thrown}, out=tmp_path / "out")
    result = selvedge.compare(tmp_path / "comparison.yaml", kinds=kinds, out=tmp_path / "out")
    decay = {row["setting"]: row["decay"] for row in result["rows"]}
    assert decay["blind"] is None and decay["thrown"] is not None


def test_it_runs_in_a_comparison(scene_file, tmp_path):
    (tmp_path / "comparison.yaml").write_text(COMPARISON)
    result = selvedge.compare(tmp_path / "comparison.yaml", kinds={"thrown": Thrown}, out=tmp_path / "out")
    rows = {row["setting"]: row for row in result["rows"]}
    assert list(rows) == ["thrown", "conventional"]
    assert all(not row["trouble"] and row["finished"] == 1 and row["ms"] > 0 for row in rows.values()), rows
    assert "thrown" in result["table"] and (tmp_path / "out" / "compare.html").exists()
    with pytest.raises(selvedge.Error, match="conventional"):
        selvedge.compare(tmp_path / "comparison.yaml", kinds={"conventional": Thrown}, out=tmp_path / "out")
    # A name that no kind has is left out and said.
    rows = selvedge.compare(tmp_path / "comparison.yaml", out=tmp_path / "other")["rows"]
    assert "no stepper `thrown`" in rows[0]["trouble"]


def test_a_class_that_refers_to_its_scene_goes_with_it():
    class Refers(Thrown):
        pass

    Refers.scene_of_it = scene = selvedge.Scene(stepper=Refers)
    scene.add_cloth(*square())
    assert scene.step()
    left = weakref.ref(Refers)
    del Refers, scene
    gc.collect()
    assert left() is None


def test_one_thread_at_a_time_works_on_a_scene():
    refused = []

    class Nested(Thrown):
        def step(self, start, drive, dt):
            def meddle():
                for work in (scene.step, lambda: scene.move_obstacle(0, square(-1)[0]), lambda: selvedge.step([scene])):
                    with pytest.raises(selvedge.Error, match="is being stepped"):
                        work()
                    refused.append(work)

            meddle()
            other = threading.Thread(target=meddle)
            other.start()
            other.join()
            return super().step(start, drive, dt)

    scene = selvedge.Scene(stepper=Nested)
    scene.add_cloth(*square())
    scene.add_obstacle(*square(-1))
    assert scene.step() and scene.step() and scene.frame == 2 and len(refused) == 12
    scene.move_obstacle(0, square(-1)[0])


def test_a_comparison_lets_other_threads_go_on_says_lines_and_ends_with_ctrl_c(scene_file, tmp_path):
    lines = []
    (tmp_path / "comparison.yaml").write_text(COMPARISON)
    selvedge.compare(tmp_path / "comparison.yaml", kinds={"thrown": Thrown}, out=tmp_path / "out", log=lines.append)
    assert any("thrown" in line for line in lines) and not any("\n" in line for line in lines)

    # Minutes of work without a line of Python: only another thread can see that it has begun.
    long = COMPARISON.split("settings")[0] + "settings: [{name: long, set: [run.frames=99999]}]\n"
    (tmp_path / "comparison.yaml").write_text(long)
    begun = lambda: list((tmp_path / "long").glob("cells/.fall.*/run.lock"))
    with pytest.raises(KeyboardInterrupt), interrupted_when(begun):
        selvedge.compare(tmp_path / "comparison.yaml", out=tmp_path / "long", log=None)
    assert not (tmp_path / "long" / "cells" / "fall").exists()

    def fail(line):
        raise ZeroDivisionError

    (tmp_path / "comparison.yaml").write_text(COMPARISON)
    with pytest.raises(ZeroDivisionError):
        selvedge.compare(tmp_path / "comparison.yaml", kinds={"thrown": Thrown}, out=tmp_path / "failed", log=fail)


def test_results_are_kept_for_this_extension_and_not_for_every_one_of_the_interpreter(scene_file, tmp_path):
    (tmp_path / "comparison.yaml").write_text(COMPARISON)
    selvedge.compare(tmp_path / "comparison.yaml", kinds={"thrown": Thrown}, out=tmp_path / "out", log=None)
    extension = 0xCBF29CE484222325  # Fowler, Noll and Vo's hash, variant 1a
    for byte in pathlib.Path(selvedge._selvedge.__file__).read_bytes():
        extension = (extension ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    record = json.loads((tmp_path / "out" / "cells" / "fall" / "cell.json").read_text())
    assert record["program"] == f"{extension:016x}"
