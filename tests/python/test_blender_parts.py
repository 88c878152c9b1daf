"""What the add-on for Blender does without Blender: scene files, point caches, the program's words, the zip."""

import ast
import os
import re
import subprocess
import sys
import time
import zipfile

import addon
import numpy as np
import pytest
from ply import read_ply

audit, pack, point_cache = addon.part("audit"), addon.part("pack"), addon.part("point_cache")
program, scene_file = addon.part("program"), addon.part("scene_file")
PROGRAM = os.environ.get("SELVEDGE_PROGRAM")
QUADS = np.array([0, 1, 4, 3, 1, 2, 5, 4], np.int32)  # corners of two
SIX = np.array([[x, 1, z] for z in (0, 0.1) for x in (0, 0.1, 0.2)])


def test_up_in_blender_is_up_in_the_files():
    assert scene_file.to_file_axes([[1, 2, 3]], 0.01).tolist() == [[0.01, 0.03, -0.02]]
    x = np.random.default_rng(1).normal(size=(2, 5, 3))
    assert np.allclose(scene_file.to_blender_axes(scene_file.to_file_axes(x, 0.1), 0.1), x, rtol=0, atol=1e-15)
    turned = np.array([scene_file.to_file_axes(row, 1) for row in np.eye(3)])
    assert np.linalg.det(turned) == 1  # no mirror


def test_a_mesh_keeps_its_order_and_its_floats():
    x = np.random.default_rng(2).normal(size=(6, 3)).astype(np.float32)
    lines = scene_file.obj_text(x.astype(float), np.array([4, 4]), QUADS).splitlines()
    read = np.array([line.split()[1:] for line in lines[:6]], float).astype(np.float32)
    assert np.array_equal(read, x)
    assert lines[6:] == ["f 1 2 5 4", "f 2 3 6 5"]


def test_a_scene_file():
    scene = scene_file.Scene([], 30, 12.5, sample_fps=25.0)
    scene.cloths = [scene_file.Cloth("a: \"b\"", "garment.obj", "rest.obj"), scene_file.Cloth("c", "garment_1.obj")]
    obstacle = scene_file.Obstacle
    scene.obstacles = [obstacle("still", "body_0.obj"), obstacle("é", "body_1.obj", "body_1.pc2")]
    scene.cloths[0].pins = scene_file.Pins([4, 7])
    scene.cloths[1].material = "silk"
    assert scene_file.scene_text(scene) == (
        'cloths:\n  - name: "a: \\"b\\""\n    mesh: "garment.obj"\n    rest: {from: mesh, file: "rest.obj"}\n'
        '    material: "cotton"\n    pins:\n      - vertices: [4, 7]\n'
        '  - name: "c"\n    mesh: "garment_1.obj"\n    material: "silk"\n'
        'obstacles:\n  - name: "still"\n    mesh: "body_0.obj"\n  - name: "é"\n'
        '    sequence: {cache: "body_1.pc2", mesh: "body_1.obj", fps: 25.0, start: 0 s}\n'
        "gravity: [0.0, -9.81, 0.0]\ncontact: {thickness: 0.002, friction: 0.3}\n"
        "run: {frames: 30, fps: 12.5, quality: standard}\n"
    )


def test_pins_that_move_alike_are_one():
    moved = np.zeros((5, 3, 3))
    moved[1:, 1, 1] = moved[1:, 2, 1] = 0.5
    lines = scene_file.pin_lines(scene_file.Pins([8, 3, 5], moved), 10)
    assert lines[:2] == ["    pins:", "      - vertices: [8]"]
    assert lines[2] == "      - vertices: [3, 5]"
    times = [re.search(r"time: ([\d.]+), translate: \[0.0, ([\d.]+)", line).groups() for line in lines[5:]]
    assert times == [("0.0", "0.0"), ("0.1", "0.5"), ("0.4", "0.5")]


@pytest.mark.skipif(not PROGRAM, reason="SELVEDGE_PROGRAM is not set")
def test_the_program_reads_it(tmp_path):
    """Pins go where they are told, past an obstacle that moves as its cache has it."""
    moved = np.random.default_rng(3).normal(size=(4, 2, 3)) * 0.01
    moved -= moved[0]
    frames = [np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) + [5, k, 0] for k in range(4)]
    tetrahedron = np.array([0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2], np.int32)
    (tmp_path / "garment.obj").write_text(scene_file.obj_text(SIX, np.array([4, 4]), QUADS))
    (tmp_path / "body_0.obj").write_text(scene_file.obj_text(frames[0], np.array([3] * 4), tetrahedron))
    point_cache.write(tmp_path / "body_0.pc2", frames)
    cloth = scene_file.Cloth('é.001 "x": #', "garment.obj", pins=scene_file.Pins([0, 5], moved))
    scene = scene_file.Scene([cloth], 3, 24.0, sample_fps=24.0)
    scene.obstacles = [scene_file.Obstacle("body", "body_0.obj", "body_0.pc2")]
    (tmp_path / "scene.yaml").write_text(scene_file.scene_text(scene))
    run = program.Run(PROGRAM, ["simulate", tmp_path / "scene.yaml", "--out", tmp_path / "run", "--no-view"])
    while run.poll(0.1) is None:
        pass
    assert run.json()["frames"] == 3
    done = [PROGRAM, "export", tmp_path / "run", "--format", "ply", "--obstacles", "--out", tmp_path / "ply"]
    subprocess.run(done, check=True, capture_output=True)
    for k in range(4):
        assert np.allclose(read_ply(tmp_path / "ply" / f"cloth_{k:05}.ply")[[0, 5]], SIX[[0, 5]] + moved[k], atol=1e-6)
        assert np.allclose(read_ply(tmp_path / "ply" / f"obstacle_0_body_{k:05}.ply"), frames[k], atol=1e-6)


def test_a_point_cache(tmp_path):
    x = np.random.default_rng(4).normal(size=(3, 7, 3)).astype(np.float32)
    point_cache.write(tmp_path / "x.pc2", x)
    assert np.array_equal(point_cache.read(tmp_path / "x.pc2"), x)
    assert [file.name for file in tmp_path.iterdir()] == ["x.pc2"]
    whole = (tmp_path / "x.pc2").read_bytes()
    for wrong in (b"", b"POINTCACHE3" + whole[11:], whole[:-1]):
        (tmp_path / "wrong.pc2").write_bytes(wrong)
        with pytest.raises(ValueError, match="wrong.pc2"):
            point_cache.read(tmp_path / "wrong.pc2")
    writer = point_cache.Writer(tmp_path / "y.pc2", 7)
    with pytest.raises(ValueError, match="6 vertices in frame 0"):
        writer.add(x[0, :6])
    writer.drop()
    assert not list(tmp_path.glob("y*"))


@pytest.mark.parametrize(
    "line, shown",
    [
        ("frame 18 of 20, 3.42 frames/s, 1 s left", ("frame", 18, 20, 3.42, "1 s left")),
        ("draping 3 of 45, 0 frames/s, ", ("draping", 3, 45, 0, "")),
        ("frame 4 of 2000, 1e+03 frames/s, 2 h 5 min left", ("frame", 4, 2000, 1000, "2 h 5 min left")),
        ("frames              20 of 20", None),
        ("warning: 3 of 4, 5 frames/s, x", None),
    ],
)
def test_progress(line, shown):
    found = program.read_progress(line)
    assert (found and (found.what, found.at, found.of, found.rate, found.left)) == shown


def test_failures():
    found = program.read_failure("warning: a\nselvedge: s.yaml:1: `x` names\n  cure: known: b, c; did you mean `b`?")
    assert (found.what, found.cure) == ("s.yaml:1: `x` names", "known: b, c; did you mean `b`?")
    assert program.read_failure("selvedge: simulate: needs more memory than there is\n").cure == ""
    assert program.read_failure("frames 3 of 4\n") is None


def own_program(folder, text):
    path = folder / "program"
    path.write_text(f"#!{sys.executable}\nimport signal, sys, time\n{text}")
    path.chmod(0o755)
    return str(path)


def ended(run):
    while run.poll(0.05) is None:
        pass
    return run.process.returncode


def test_what_a_program_says(tmp_path):
    run = program.Run(
        own_program(
            tmp_path,
            "assert sys.argv[1:] == ['simulate', '--json'] and sys.stderr.isatty()\n"
            "sys.stderr.write('warning: it is thin\\n\\rframe 1 of 3, 2 frames/s, 1 s left\\033[K')\n"
            "sys.stderr.write('\\rframe 2 of 3, 2 frames/s, 0 s left\\033[K\\r\\033[Kframes  3 of 3\\n')\n"
            "print('{\"clean\": false}'); sys.exit(1)",
        ),
        ["simulate"],
    )
    assert ended(run) == 1 and run.json() == {"clean": False}
    assert run.warnings == ["it is thin"] and run.progress.at == 2 and run.text == "frames  3 of 3\n"


def test_a_program_that_is_stopped(tmp_path):
    run = program.Run(
        own_program(
            tmp_path,
            "signal.signal(signal.SIGINT, lambda *_: (print('{\"end\": \"interrupted\"}'), sys.exit(1)))\n"
            "sys.stderr.write('frame 1 of 9, 1 frames/s, 8 s left\\n'); sys.stderr.flush()\n"
            "while True: time.sleep(0.01)",
        ),
        [],
    )
    deadline = time.monotonic() + 60
    while not run.progress and time.monotonic() < deadline:
        assert run.poll(0.05) is None
    run.stop()
    assert ended(run) == 1 and run.json() == {"end": "interrupted"}
    run.stop()  # has ended: nothing happens


def test_programs_that_fail(tmp_path):
    with pytest.raises(program.Failure, match="cannot be started"):
        program.Run("no-such-program", [])
    run = program.Run(own_program(tmp_path, "sys.exit('selvedge: a.obj: is empty\\n  cure: write it')"), [])
    ended(run)
    with pytest.raises(program.Failure, match="a.obj: is empty\ncure: write it"):
        run.json()
    run = program.Run(own_program(tmp_path, "import os; sys.stderr.write('terminate\\n'); os.abort()"), [])
    ended(run)
    with pytest.raises(program.Failure, match="status -6; terminate"):
        run.json()
    with pytest.raises(program.Failure, match="is not selvedge: it says `Blender 3.4.1`"):
        program.version(own_program(tmp_path, "print('Blender 3.4.1')"))


@pytest.mark.skipif(not PROGRAM, reason="SELVEDGE_PROGRAM is not set")
def test_what_the_program_has():
    assert re.fullmatch(r"\d+\.\d+\.\d+", program.version(PROGRAM))
    assert {"cotton", "denim", "silk"} <= set(program.materials(PROGRAM))
    assert program.materials("no-such-program") == []


def test_frames_with_pairs():
    report = {
        "intersecting_pairs_by_frame": [0, 2, 5, 0, 0, 1, 0],
        "vertex_sharing_pairs_by_frame": [0, 0, 1, 0, 0, 0, 4],
    }
    bad = audit.bad_frames(report, 10, 3)
    assert bad == {13: 2, 16: 6, 25: 1, 28: 4}
    assert audit.ranges(bad, 3) == [(13, 16, 6), (25, 28, 4)]
    assert audit.ranges({}, 3) == []


def test_the_strip_on_the_timeline():
    place = lambda frame: 10 * frame - 100  # 10 pixels a frame, from frame 10 on
    corners, triangles = audit.strip([(1, 2), (9, 12), (20, 20), (40, 50)], place, 300, 7)
    assert corners[:4] == [(0, 0), (25, 0), (25, 7), (0, 7)]  # begins left of what is shown
    assert corners[4:8] == [(95, 0), (105, 0), (105, 7), (95, 7)]
    assert corners[8] == (295, 0) and max(x for x, _ in corners) == 300 and len(corners) == 12
    assert triangles == [(k + a, k + b, k + c) for k in (0, 4, 8) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    thin, _ = audit.strip([(1000, 1000)], lambda frame: 0.1 * frame, 300, 7)
    assert thin[1][0] - thin[0][0] == 2  # seen all the same
    assert audit.strip([(1, 5)], place, 300, 7) == audit.strip([], place, 300, 7) == ([], [])


def test_the_verdict():
    pairs = ["intersecting_pairs_all_frames", "vertex_sharing_pairs_all_frames"]
    counts = dict.fromkeys([*pairs, "inside_vertices", "passed_through", "jumped", "nonfinite"], 0)
    run = {"frames": 30, "frames_wanted": 30, "end": "finished", "reason": "", "clean": True, **counts}
    assert audit.verdict(run) == "30 of 30 frames, clean" and not audit.has_pairs(run)
    run |= {"clean": False, "intersecting_pairs_all_frames": 7, "inside_vertices": 2}
    assert audit.has_pairs(run)
    assert audit.verdict(run) == (
        "30 of 30 frames; 7 intersecting pairs over all frames; 2 vertices inside bodies in the worst frame"
    )
    run |= {"frames": 4, "end": "rejected", "reason": "too_many_pairs"} | counts
    assert audit.verdict(run) == "4 of 30 frames, rejected: too_many_pairs; no intersecting pairs"


def test_the_zip(tmp_path):
    pack.pack(tmp_path / "a.zip")
    pack.pack(tmp_path / "deep" / "b.zip")
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "deep" / "b.zip").read_bytes()
    entries = zipfile.ZipFile(tmp_path / "a.zip").infolist()
    assert {(one.date_time, one.compress_type, one.external_attr >> 16) for one in entries} == {
        ((1980, 1, 1, 0, 0, 0), zipfile.ZIP_STORED, 0o644)
    }  # and neither today, nor what a library packs, nor the rights of a checkout
    names = [one.filename for one in entries]
    assert names == sorted(names)
    assert "selvedge_cloth/blender_manifest.toml" in names and "selvedge_cloth/__init__.py" in names
    assert "selvedge_cloth/LICENSE" in names and "selvedge_cloth/pack.py" not in names
    for file in addon.FOLDER.glob("*.py"):
        assert file.read_text().startswith("# SPDX-License-Identifier: GPL-3.0-or-later\n"), file


def test_one_version():
    tree = ast.parse((addon.FOLDER / "__init__.py").read_text())
    info = next(node.value for node in tree.body if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info")
    info = ast.literal_eval(info)  # as Blender reads it
    manifest = (addon.FOLDER / "blender_manifest.toml").read_text()
    project = (addon.FOLDER.parents[1] / "pyproject.toml").read_text()
    version = re.search(r'^version = "(.+)"', project, re.M)[1]
    assert f'\nversion = "{version}"\n' in manifest
    assert info["version"] == tuple(map(int, version.split(".")))
    assert info["blender"] == (3, 4, 0) and info["name"] in manifest
