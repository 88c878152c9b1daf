"""Alembic caches (.abc), by the package alembic3d, which is imported when a file is read or written."""

from __future__ import annotations

import dataclasses
import itertools
import os
import pathlib
import tempfile
from typing import TypedDict

import numpy as np
import numpy.typing as npt

from ._selvedge import Error, read_surfaces


class AlembicMesh(TypedDict):
    """A mesh whose faces stay."""

    fps: float  # samples a second; 0 where there is one sample, or where they are not equally spaced
    time: list[float]  # of each sample [s]
    faces: list[list[int]]  # the vertices of each face, counter-clockwise from its right side
    x: list[npt.NDArray[np.float32]]  # positions of each sample, n x 3, in the file's unit and axes


def _library():
    try:
        from alembic3d import Abc, AbcCoreAbstract, AbcGeom  # pyright: ignore[reportMissingImports]
        from imath import IntArrayFromBuffer, V3fArrayFromBuffer  # pyright: ignore[reportMissingImports]
    except ImportError as why:
        raise Error(f"alembic3d: cannot be imported ({why}); pip install alembic3d") from why
    return Abc, AbcCoreAbstract, AbcGeom, IntArrayFromBuffer, V3fArrayFromBuffer


def read_alembic(file: str | os.PathLike[str]) -> dict[str, AlembicMesh]:
    """The polygon meshes of an Alembic file by their paths in it, such as /sheet/sheetShape. Returns for each what
    AlembicMesh says. Positions are as the mesh has them: transforms above it are not applied. Raises Error for what is
    no Alembic file, and for a mesh whose faces change or name vertices that are not there."""
    Abc, _, AbcGeom, _, _ = _library()
    path = pathlib.Path(file)
    if not path.is_file():
        raise Error(f"{path}: no such file")
    try:
        archive = Abc.IArchive(str(path))
    except Exception as why:
        raise Error(f"{path}: is no Alembic file ({why})") from why
    found = {}
    waiting = [archive.getTop()]
    while waiting:
        thing = waiting.pop()
        for k in range(thing.getNumChildren()):
            header, child = thing.getChildHeader(k), thing.getChild(k)
            if AbcGeom.IPolyMesh.matches(header):
                name = header.getFullName()
                found[name] = _mesh(Abc, AbcGeom, AbcGeom.IPolyMesh(thing, header.getName()), f"{path}, {name}")
            waiting.append(child)
    if not found:
        raise Error(f"{path}: holds no polygon mesh")
    return dict(sorted(found.items()))


def _mesh(Abc, AbcGeom, mesh, where) -> AlembicMesh:
    schema = mesh.getSchema()
    if schema.getTopologyVariance() == AbcGeom.MeshTopologyVariance.kHeterogenousTopology:
        raise Error(f"{where}: its faces change during the file; only faces that stay are read")
    time = [schema.getTimeSampling().getSampleTime(k) for k in range(schema.getNumSamples())]
    if not time:
        raise Error(f"{where}: holds no sample")
    # By time: alembic3d takes a number as a time, also where it is whole. A sample owns what it shows.
    samples = [schema.getValue(Abc.ISampleSelector(t)) for t in time]
    counts = np.array(samples[0].getFaceCounts(), dtype=np.int64)
    corners = np.array(samples[0].getFaceIndices(), dtype=np.int64)
    x = [np.array(sample.getPositions(), dtype=np.float32).reshape(-1, 3) for sample in samples]
    if counts.sum() != len(corners) or (len(corners) and not 0 <= corners.min() <= corners.max() < len(x[0])):
        raise Error(f"{where}: its faces name vertices that are not there")
    faces = [face[::-1].tolist() for face in np.split(corners, np.cumsum(counts)[:-1])]
    gaps = np.diff(time)
    even = len(gaps) > 0 and gaps[0] > 0 and np.allclose(gaps, gaps[0], rtol=1e-6, atol=1e-9)
    return {"fps": 1 / float(np.mean(gaps)) if even else 0.0, "time": time, "faces": faces, "x": x}


def write_alembic(
    file: str | os.PathLike[str], x: npt.ArrayLike, faces: npt.ArrayLike, fps: float, *, name: str = "cloth"
) -> None:
    """Writes one mesh as an Alembic file (Ogawa). x: positions, frames x n x 3 or a list of n x 3 [m], kept as 32-bit
    floats; faces: m x 3, or a list of lists of vertices, counter-clockwise from their right side; fps: frames a second,
    the first at time 0; name: of the mesh. The file takes its name when it is whole. Raises Error for arrays that do
    not fit."""
    if not name or "/" in name:
        raise Error(f"name: is {name!r}; give a name without /")
    frames = _frames(x)
    _write(file, [_Written(name, frames, *_corners(faces, len(frames[0])))], fps)


def export_alembic(run: str | os.PathLike[str], file: str | os.PathLike[str], *, obstacles: bool = True) -> list[str]:
    """Writes a run (its run.h5, or the folder) as one Alembic file: a mesh a cloth, with the vertices, faces and
    texture coordinates of the cloth's own file where it had one, and with obstacles a mesh an obstacle. What never
    moves has one sample. Returns the meshes' names: those of the run, with / and repeated ones replaced. The whole run
    is held in memory. Raises Error for a run without a frame and positions that are not finite."""
    meshes: list[_Written] = []
    surfaces = read_surfaces(run, obstacles)
    for surface in surfaces:
        plain = surface["name"].replace("/", "_") or "_"
        taken = {mesh.name for mesh in meshes}
        names = itertools.chain([plain], (f"{plain}_{k}" for k in itertools.count(1)))
        name = next(one for one in names if one not in taken)
        ends = np.cumsum(surface["counts"])[:-1]
        faces = np.split(surface["corners"], ends)
        try:
            frames = _frames(surface["x"])
        except Error as why:
            raise Error(f"{run}, {surface['name']}: {why}") from None
        mesh = _Written(name, frames, *_corners(faces, len(frames[0])))
        if len(surface["corner_uv"]):
            rows = np.concatenate([face[::-1] for face in np.split(surface["corner_uv"], ends)])
            uv = np.vstack([surface["uv"], np.zeros((1, 2))])  # corners without one: the row of zeros
            mesh.uv, mesh.uv_rows = uv.astype(np.float32), np.where(rows < 0, len(uv) - 1, rows).astype(np.uint32)
        meshes.append(mesh)
    _write(file, meshes, surfaces[0]["fps"])
    return [mesh.name for mesh in meshes]


@dataclasses.dataclass
class _Written:
    """A mesh as Alembic has it: float32 positions, one array a sample, and int32 faces, clockwise."""

    name: str
    frames: list[np.ndarray]
    counts: np.ndarray
    corners: np.ndarray
    uv: np.ndarray | None = None
    uv_rows: np.ndarray | None = None


def _write(file: str | os.PathLike[str], meshes: list[_Written], fps: float) -> None:
    Abc, core, AbcGeom, IntArrayFromBuffer, V3fArrayFromBuffer = _library()
    path = pathlib.Path(file)
    if not (np.isfinite(fps) and fps > 0):
        raise Error(f"fps: is {fps}; give frames a second, above 0")
    if not path.parent.is_dir():
        raise Error(f"{path}: its folder does not exist")
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        growing = pathlib.Path(folder) / path.name
        archive = Abc.OArchive(str(growing))
        sampling = archive.addTimeSampling(core.TimeSampling(1.0 / fps, 0.0))
        for one in meshes:
            above = AbcGeom.OXform(archive.getTop(), one.name)
            mesh = AbcGeom.OPolyMesh(above, one.name + "Shape")
            schema = mesh.getSchema()
            schema.setTimeSampling(sampling)
            corners, counts = IntArrayFromBuffer(one.corners), IntArrayFromBuffer(one.counts)
            for k, frame in enumerate(one.frames):
                positions = V3fArrayFromBuffer(frame)  # a sample points into it
                sample = AbcGeom.OPolyMeshSchemaSample(positions, corners, counts)
                if k == 0 and one.uv is not None and one.uv_rows is not None:
                    sample.setUVs(_uv_sample(AbcGeom, one.uv, one.uv_rows))
                schema.set(sample)
            del schema, mesh, above
        del archive  # the library writes the file's end when the last of them goes
        os.replace(growing, path)


def _uv_sample(AbcGeom, uv: np.ndarray, uv_rows: np.ndarray):
    from imath import UnsignedIntArray, V2fArrayFromBuffer

    rows = UnsignedIntArray(len(uv_rows))
    for k, row in enumerate(uv_rows.tolist()):
        rows[k] = row
    return AbcGeom.OV2fGeomParamSample(V2fArrayFromBuffer(uv), rows, AbcGeom.GeometryScope.kFacevaryingScope)


def _frames(x) -> list[np.ndarray]:
    try:
        frames = [np.ascontiguousarray(frame, dtype=np.float32) for frame in x]
    except (TypeError, ValueError) as why:
        raise Error(f"x: {why}; give frames x n x 3 numbers") from why
    if not frames:
        raise Error("x: holds no frame")
    for k, frame in enumerate(frames):
        if frame.ndim != 2 or frame.shape[1] != 3 or frame.shape != frames[0].shape:
            raise Error(f"x, frame {k}: has the shape {frame.shape}; give n x 3, alike in all frames")
        if not np.isfinite(frame).all():
            raise Error(f"x, frame {k}, vertex {np.argwhere(~np.isfinite(frame))[0][0]}: is not finite")
    return frames


def _corners(faces, vertices) -> tuple[np.ndarray, np.ndarray]:
    """Vertices a face, and the vertices of all faces one after another, clockwise as Alembic has them."""
    counts, corners = [], []
    for k, face in enumerate(faces):
        face = np.asarray(face)
        if face.ndim != 1 or len(face) < 3 or not np.issubdtype(face.dtype, np.integer):
            raise Error(f"faces, face {k}: is {face.tolist()}; give three or more whole numbers")
        if face.min() < 0 or face.max() >= vertices:
            raise Error(f"faces, face {k}: names a vertex outside 0 .. {vertices - 1}")
        counts.append(len(face))
        corners.extend(face[::-1])
    if not counts:
        raise Error("faces: holds no face")
    return np.array(counts, dtype=np.int32), np.array(corners, dtype=np.int32)
