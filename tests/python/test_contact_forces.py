"""Contact forces of runs and of stepped scenes as arrays."""

import numpy as np
import pytest

import selvedge

DENSITY, SIDE, GRAVITY = 0.2, 0.5, 9.81
WEIGHT = DENSITY * SIDE**2 * GRAVITY
SCENE = f"""
cloths: [{{name: sheet, rectangle: {{size: [{SIDE}, {SIDE}], edge: 8 cm}}, translate: [0, 0.002, 0],
          material: {{density: {DENSITY}}}}}]
obstacles: [{{name: floor, plane: {{size: 2}}}}]
run: {{frames: 12, fps: 30}}
"""
ON = ["run.contact_forces=true"]


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """One scene with contact forces, one without."""
    folder = tmp_path_factory.mktemp("contact_forces")
    (folder / "scene.yaml").write_text(SCENE)
    for name, overrides in (("with", ON), ("without", [])):
        selvedge.simulate(selvedge.Scene(folder / "scene.yaml", overrides), out=folder / name)
    return folder


def test_the_forces_on_a_sheet_at_rest_are_its_weight(runs):
    run = selvedge.read_trajectory(runs / "with")
    forces = run["contact_forces"]
    frames, vertices, _ = run["x"].shape
    assert forces["normal"].shape == forces["friction"].shape == (frames, vertices, 3)
    assert forces["pressure"].shape == (frames, vertices)
    assert {array.dtype for array in forces.values()} == {np.dtype(np.float32)}
    assert all(np.isnan(array[0]).all() and np.isfinite(array[1:]).all() for array in forces.values())
    assert forces["normal"][-1].sum(axis=0) == pytest.approx([0, WEIGHT, 0], abs=0.01 * WEIGHT)
    assert np.abs(forces["friction"][-1].sum(axis=0)).max() < 0.01 * WEIGHT
    assert forces["pressure"][-1].mean() == pytest.approx(DENSITY * GRAVITY, rel=0.05)


def test_positions_have_the_same_bits_without_them(runs):
    with_them, without = (selvedge.read_trajectory(runs / name) for name in ("with", "without"))
    assert (with_them["x"] == without["x"]).all() and without["contact_forces"] is None


def test_they_are_mapped_into_files_as_positions_are(runs, tmp_path):
    whole = selvedge.read_trajectory(runs / "with")["contact_forces"]
    some = selvedge.read_trajectory(runs / "with", slice(1, None, 3), tmp_path / "x.npy")["contact_forces"]
    assert set(some) == {"normal", "friction", "pressure"}
    for name, array in some.items():
        assert isinstance(array, np.memmap) and (array == whole[name][1::3]).all()
        array.flush()
        assert (np.load(tmp_path / f"x_contact_{name}.npy") == array).all()


def test_those_of_a_stepped_scene_are_those_of_its_run(runs):
    scene = selvedge.Scene(runs / "scene.yaml", ON)
    assert scene.contact_forces is None
    recorded = selvedge.read_trajectory(runs / "with")["contact_forces"]
    for frame in range(1, 4):
        assert scene.step()
        for name, array in scene.contact_forces.items():
            assert (array.astype(np.float32) == recorded[name][frame]).all()
    scene.save(runs / "state.h5")
    scene.restore(runs / "state.h5")
    assert scene.contact_forces is None and scene.step() and scene.contact_forces is not None


def test_a_scene_from_arrays_has_them_where_they_are_asked_for():
    def scene(**options):
        made = selvedge.Scene(**options)
        made.add_cloth([[0, 0.002, 0], [0, 0.002, 0.2], [0.2, 0.002, 0]], [[0, 1, 2]], density=DENSITY)
        made.add_obstacle([[-1, 0, -1], [-1, 0, 1], [1, 0, -1], [1, 0, 1]], [[0, 1, 2], [2, 1, 3]])
        return made

    asked = scene(contact_forces=True)
    assert selvedge.simulate(asked, 10) == 10
    assert asked.contact_forces["normal"].sum(axis=0)[1] == pytest.approx(DENSITY * 0.02 * GRAVITY, rel=0.01)
    with pytest.raises(selvedge.Error, match="not asked for"):
        scene().contact_forces

    class Still(selvedge.Stepper):
        def step(self, start, drive, dt):
            return start.x

    with pytest.raises(selvedge.Error, match="not known of steps that Python makes"):
        selvedge.Scene(stepper=Still, contact_forces=True)
