"""Scenes in other processes: forks, and what cannot go there."""

import copy
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest

import selvedge

# A parent that steps, with two threads, before it forks; its children step, too.
FORKING = """
import multiprocessing
import numpy as np
import selvedge

def lowest(n):
    u = np.linspace(0, 0.5, n)
    x = np.array([[a, 0.3, b] for b in u for a in u])
    quads = [(j * n + i, j * n + i + 1, j * n + n + i, j * n + n + i + 1) for j in range(n - 1) for i in range(n - 1)]
    scene = selvedge.Scene()
    scene.add_cloth(x, [t for a, b, c, d in quads for t in ((a, c, b), (b, c, d))])
    scene.step()
    return float(scene.x[:, 1].min())

here = lowest(50)
with multiprocessing.get_context("fork").Pool(2) as pool:
    assert pool.map(lowest, [50, 50]) == [here, here]
assert lowest(50) == here
print("done")
"""


def scene_of_one_triangle():
    scene = selvedge.Scene()
    scene.add_cloth([[0, 0, 0], [0, 0, 1], [1, 0, 0]], [[0, 1, 2]])
    return scene


def test_processes_that_are_forked_after_a_step_can_step():
    environment = dict(os.environ, OMP_NUM_THREADS="2", OMP_WAIT_POLICY="passive")
    run = subprocess.run([sys.executable, "-c", FORKING], env=environment, capture_output=True, text=True, timeout=120)
    assert run.returncode == 0 and run.stdout.endswith("done\n"), run.stderr


@pytest.mark.parametrize("way", [pickle.dumps, copy.copy, copy.deepcopy])
def test_a_scene_that_is_to_be_copied_says_what_to_do(way):
    with pytest.raises(selvedge.Error, match="cannot be copied.*\n.*`save` and `restore`"):
        way(scene_of_one_triangle())


def test_positions_and_velocities_can_be_assigned():
    scene = scene_of_one_triangle()
    view = scene.x
    scene.x += 1
    scene.v = np.full((3, 3), 2, np.float32)
    assert (view == scene.x).all() and scene.x[0].tolist() == [1, 1, 1] and (scene.v == 2).all()
    with pytest.raises(selvedge.Error, match="x: has 2 rows, the scene has 3 vertices"):
        scene.x = [[0, 0, 0], [1, 1, 1]]


def test_a_stepper_by_name_is_told_where_names_go():
    with pytest.raises(selvedge.Error, match="neither an instance nor a name"):
        selvedge.Scene(stepper="icm")
