"""USD text as usd-core reads it; skipped without that package or the program (SELVEDGE_PROGRAM)."""

import os
import subprocess

import numpy as np
import pytest
from ply import read_ply

Usd = pytest.importorskip("pxr.Usd")
UsdGeom = pytest.importorskip("pxr.UsdGeom")
PROGRAM = os.environ.get("SELVEDGE_PROGRAM")

SCENE = """
cloths: [{name: sheet, rectangle: {size: [0.4, 0.4], edge: 5 cm}, translate: [0, 0.3, 0]}]
obstacles: [{name: ball, sphere: {radius: 0.1}}]
run: {frames: 10, fps: 24}
"""


@pytest.mark.skipif(not PROGRAM, reason="SELVEDGE_PROGRAM is not set")
def test_usd_core_reads_every_frame(tmp_path):
    (tmp_path / "scene.yaml").write_text(SCENE)
    run = tmp_path / "out" / "run.h5"
    for command in (
        ["simulate", tmp_path / "scene.yaml", "--out", tmp_path / "out", "--no-view"],
        ["export", run, "--format", "usda", "--out", tmp_path, "--obstacles"],
        ["export", run, "--format", "ply", "--out", tmp_path / "ply"],
    ):
        subprocess.run([PROGRAM, *command], check=True, capture_output=True)
    stage = Usd.Stage.Open(str(tmp_path / "run.usda"))
    assert UsdGeom.GetStageUpAxis(stage) == "Y" and UsdGeom.GetStageMetersPerUnit(stage) == 1
    assert stage.GetTimeCodesPerSecond() == 24 and (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, 10)
    meshes = {prim.GetName(): UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)}
    assert set(meshes) == {"sheet", "obstacle_0_ball"}
    sheet = meshes["sheet"]
    assert UsdGeom.Mesh.ValidateTopology(
        sheet.GetFaceVertexIndicesAttr().Get(), sheet.GetFaceVertexCountsAttr().Get(), len(sheet.GetPointsAttr().Get(0))
    )[0]
    for frame in range(11):
        theirs = np.array(sheet.GetPointsAttr().Get(frame))
        ours = read_ply(tmp_path / "ply" / f"cloth_{frame:05}.ply")
        assert np.abs(theirs - ours).max() < 1e-5
