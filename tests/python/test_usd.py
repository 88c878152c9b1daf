"""USD text as usd-core reads it; skipped without that package or the program (SELVEDGE_PROGRAM)."""

import os
import subprocess

import numpy as np
import pytest
import shirt as garment
from ply import read_ply

Usd = pytest.importorskip("pxr.Usd")
UsdGeom = pytest.importorskip("pxr.UsdGeom")
UsdShade = pytest.importorskip("pxr.UsdShade")
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


@pytest.mark.skipif(not PROGRAM, reason="SELVEDGE_PROGRAM is not set")
def test_a_shirt_comes_out_as_its_file_had_it(tmp_path):
    shirt = garment.simulated(PROGRAM, tmp_path)
    garment.run(PROGRAM, "export", tmp_path / "out", "--format", "usda", "--out", tmp_path)
    stage = Usd.Stage.Open(str(tmp_path / "run.usda"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/run/shirt"))
    assert (np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3) == shirt.faces).all()
    assert np.abs(np.array(mesh.GetPointsAttr().Get(0)) - shirt.x).max() < 1e-5
    for frame, x in enumerate(shirt.frames):
        assert np.abs(np.array(mesh.GetPointsAttr().Get(frame)) - x).max() < 1e-6
    assert np.abs(shirt.frames[-1] - shirt.x).max() > 1e-3  # it moves
    primvars = UsdGeom.PrimvarsAPI(mesh)
    st = np.array(primvars.GetPrimvar("st").ComputeFlattened()).reshape(-1, 3, 2)
    assert primvars.GetPrimvar("st").GetInterpolation() == "faceVarying"
    assert np.abs(st - shirt.uv[shirt.faces]).max() < 1e-6
    check_materials(stage, mesh, shirt)
    # Where the file had smooth normals they are: those of the two vertices at a place of the seam are one.
    normals = np.array(primvars.GetPrimvar("normals").ComputeFlattened(garment.FRAMES - 1)).reshape(-1, 3, 3)
    assert np.abs(normals - garment.normals_of(shirt.frames[-1], shirt.faces)[shirt.faces]).max() < 2e-3


def check_materials(stage, mesh, shirt):
    found = UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Imageable(mesh))
    subsets = {subset.GetPrim().GetName(): subset for subset in found}
    assert set(subsets) == {"red_cotton", "blue", "left", "right"}
    sides = np.split(np.arange(len(shirt.faces)), [shirt.left])
    for (material, part), faces in zip((("red_cotton", "left"), ("blue", "right")), sides):
        assert (np.array(subsets[material].GetIndicesAttr().Get()) == faces).all()
        assert (np.array(subsets[part].GetIndicesAttr().Get()) == faces).all()
    bound = {
        name: UsdShade.MaterialBindingAPI(subsets[name].GetPrim()).ComputeBoundMaterial()[0]
        for name in ("red_cotton", "blue")
    }
    assert bound["red_cotton"].GetPrim().GetCustomDataByKey("name") == "red cotton"
    colour = bound["red_cotton"].ComputeSurfaceSource()[0].GetInput("diffuseColor")
    assert np.abs(np.array(colour.Get()) - [0.5, 0.1, 0.1]).max() < 1e-6
    source = bound["blue"].ComputeSurfaceSource()[0].GetInput("diffuseColor").GetConnectedSource()[0]
    assert UsdShade.Shader(source).GetInput("file").Get().path == "cloth.png"
