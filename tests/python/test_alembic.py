"""Alembic files, written and read; skipped without the package alembic3d."""

import os

import numpy as np
import pytest
import shirt as garment

import selvedge

pytest.importorskip("alembic3d")

PROGRAM = os.environ.get("SELVEDGE_PROGRAM")
FACES = [[0, 1, 2], [2, 1, 3, 4]]  # a triangle and a quadrangle
X = np.random.default_rng(5).uniform(-1, 1, (4, 5, 3))


def test_round_trip(tmp_path):
    selvedge.write_alembic(tmp_path / "run.abc", X, FACES, 25, name="sheet")
    assert [file.name for file in tmp_path.iterdir()] == ["run.abc"]
    (name, mesh), = selvedge.read_alembic(tmp_path / "run.abc").items()
    assert name == "/sheet/sheetShape" and mesh["faces"] == FACES
    assert mesh["fps"] == pytest.approx(25) and mesh["time"] == pytest.approx([0, 0.04, 0.08, 0.12])
    assert len(mesh["x"]) == 4 and all(frame.dtype == np.float32 for frame in mesh["x"])
    assert (np.array(mesh["x"]) == X.astype(np.float32)).all()


def test_one_frame_has_no_rate(tmp_path):
    selvedge.write_alembic(tmp_path / "one.abc", X[:1], FACES, 25)
    (mesh,) = selvedge.read_alembic(tmp_path / "one.abc").values()
    assert mesh["fps"] == 0 and mesh["time"] == [0]


@pytest.mark.parametrize(
    "change, says",
    [
        ({"x": X[0]}, "x, frame 0: has the shape"),
        ({"x": []}, "holds no frame"),
        ({"x": np.where(np.arange(5)[:, None] == 3, np.nan, X)}, "x, frame 0, vertex 3: is not finite"),
        ({"x": [X[0], X[1][:4]]}, "x, frame 1: has the shape"),
        ({"faces": [[0, 1, 5]]}, "face 0: names a vertex outside 0 .. 4"),
        ({"faces": [[0, 1, 2], [0, 1]]}, "face 1: is"),
        ({"faces": [[0.0, 1.0, 2.0]]}, "face 0: is"),
        ({"faces": []}, "holds no face"),
        ({"fps": 0}, "fps: is 0"),
        ({"name": "a/b"}, "name: is 'a/b'"),
    ],
)
def test_arrays_that_do_not_fit(tmp_path, change, says):
    with pytest.raises(selvedge.Error, match=says):
        selvedge.write_alembic(tmp_path / "bad.abc", **{"x": X, "faces": FACES, "fps": 25, **change})
    assert not list(tmp_path.iterdir())


def test_files_that_are_none(tmp_path):
    with pytest.raises(selvedge.Error, match="no such file"):
        selvedge.read_alembic(tmp_path / "absent.abc")
    (tmp_path / "text.abc").write_text("no cache")
    with pytest.raises(selvedge.Error, match="is no Alembic file"):
        selvedge.read_alembic(tmp_path / "text.abc")
    with pytest.raises(selvedge.Error, match="its folder does not exist"):
        selvedge.write_alembic(tmp_path / "no" / "run.abc", X, FACES, 25)


@pytest.mark.skipif(not PROGRAM, reason="SELVEDGE_PROGRAM is not set")
def test_a_whole_run(tmp_path):
    from alembic3d import Abc, AbcGeom

    shirt = garment.simulated(PROGRAM, tmp_path)
    file = tmp_path / "run.abc"
    assert selvedge.export_alembic(tmp_path / "out", file) == ["shirt", "obstacle_0_person"]
    meshes = selvedge.read_alembic(file)
    assert list(meshes) == ["/obstacle_0_person/obstacle_0_personShape", "/shirt/shirtShape"]
    mesh, person = meshes["/shirt/shirtShape"], meshes["/obstacle_0_person/obstacle_0_personShape"]
    assert mesh["faces"] == shirt.faces.tolist() and mesh["fps"] == pytest.approx(garment.FPS)
    assert (np.array(mesh["x"]) == np.array(shirt.frames, dtype=np.float32)).all()
    assert len(person["x"]) == 1  # it stands still
    top = Abc.IArchive(str(file)).getTop()
    uvs = AbcGeom.IPolyMesh(top.getChild("shirt"), "shirtShape").getSchema().getUVsParam().getExpandedValue()
    assert uvs.getScope() == AbcGeom.GeometryScope.kFacevaryingScope
    uv = np.array([tuple(value) for value in uvs.getVals()]).reshape(-1, 3, 2)
    assert np.abs(uv - shirt.uv[shirt.faces[:, ::-1]]).max() < 1e-6
    assert selvedge.export_alembic(tmp_path / "out", file, obstacles=False) == ["shirt"]
