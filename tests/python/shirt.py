"""A T-shirt with a file of its own, dressed and simulated, for the tests of exports.

The file has texture coordinates, normals, two materials, two groups, and a seam along the middle whose vertices are
there twice. Its vertices are shuffled, so that any other order would be seen.
"""

import dataclasses
import subprocess

import numpy as np

BODY = "obstacles: [{name: person, body: {model: mannequin}}]\n"
FRAMES, FPS = 4, 24


@dataclasses.dataclass
class Shirt:
    x: np.ndarray  # of the file's vertices [m]; the shirt starts where the file has it
    uv: np.ndarray  # of each vertex
    faces: np.ndarray  # vertices of each triangle
    left: int  # so many faces, the first ones, have the material `red cotton`, the others `blue`
    frames: list  # positions of the file's vertices in each frame, as export to OBJ has them


def obj_rows(path, word):
    lines = (line.split() for line in path.read_text().splitlines())
    return [words[1:] for words in lines if words and words[0] == word]


def positions(path):
    return np.array(obj_rows(path, "v"), dtype=float)


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def made_mesh(program, folder):
    """Vertices and triangles of a shirt that the program makes."""
    cloth = "cloths: [{name: shirt, garment: {cut: tshirt, edge: 5 cm}}]\n"
    (folder / "made.yaml").write_text(cloth + BODY + "run: {frames: 1}\n")
    run(program, "simulate", folder / "made.yaml", "--out", folder / "made", "--no-view")
    run(program, "export", folder / "made", "--format", "obj", "--out", folder / "made")
    file = folder / "made" / "cloth_00000.obj"
    return positions(file), np.array(obj_rows(file, "f"), dtype=int) - 1


def split_mesh(x, triangles):
    """Splits it where x changes its sign: positions, faces with the left ones first, and how many are left."""
    is_left = x[triangles, 0].mean(axis=1) < 0
    numbers, order, faces = {}, [], []
    for side, own in ((0, triangles[is_left]), (1, triangles[~is_left])):
        for triangle in own:
            face = []
            for v in triangle:
                if (v, side) not in numbers:
                    numbers[v, side] = len(order)
                    order.append(v)
                face.append(numbers[v, side])
            faces.append(face)
    shuffled = np.random.default_rng(3).permutation(len(order))
    place = np.argsort(shuffled)
    return x[np.array(order)[shuffled]], place[np.array(faces)], int(is_left.sum())


def normals_of(x, faces):
    """Smooth, also across the seam."""
    across = np.cross(x[faces[:, 1]] - x[faces[:, 0]], x[faces[:, 2]] - x[faces[:, 0]])
    _, place = np.unique(x.round(9), axis=0, return_inverse=True)
    sums = np.zeros((place.max() + 1, 3))
    np.add.at(sums, place.reshape(-1)[faces], across[:, None, :].repeat(3, axis=1))
    return (sums / np.linalg.norm(sums, axis=1, keepdims=True))[place.reshape(-1)]


def write_obj(folder, x, uv, normals, faces, left):
    (folder / "shirt.mtl").write_text(
        "newmtl red cotton\nKd 0.5 0.1 0.1\nnewmtl blue\nKd 0.1 0.1 0.6\nmap_Kd cloth.png\n"
    )
    lines = ["mtllib shirt.mtl", "o shirt"]
    lines += [f"v {a:.9f} {b:.9f} {c:.9f}" for a, b, c in x] + [f"vt {u:.6f} {v:.6f}" for u, v in uv]
    lines += [f"vn {a:.4f} {b:.4f} {c:.4f}" for a, b, c in normals]
    for k, face in enumerate(faces + 1):
        lines += {0: ["g left", "usemtl red cotton"], left: ["g right", "usemtl blue"]}.get(k, [])
        lines.append("f " + " ".join(f"{v}/{v}/{v}" for v in face))
    (folder / "shirt.obj").write_text("\n".join(lines) + "\n")


def simulated(program, folder):
    """Dresses the shirt and simulates it: folder/out is the run."""
    x, faces, left = split_mesh(*made_mesh(program, folder))
    uv = np.column_stack([x[:, 0] + 0.5, x[:, 1] / 2]).round(6)
    uv[np.unique(faces[left:])] += [0.25, 0]  # the halves lie apart on the texture
    write_obj(folder, x, uv, normals_of(x, faces), faces, left)
    run(program, "dress", folder / "shirt.obj", "--weld", "--out", folder / "shirt.h5")
    (folder / "scene.yaml").write_text(
        "cloths: [{name: shirt, garment: {file: shirt.h5}}]\n" + BODY + f"run: {{frames: {FRAMES - 1}, fps: {FPS}}}\n"
    )
    run(program, "simulate", folder / "scene.yaml", "--out", folder / "out", "--no-view")
    run(program, "export", folder / "out", "--format", "obj", "--out", folder / "obj")
    frames = [positions(folder / "obj" / f"cloth_{frame:05}.obj") for frame in range(FRAMES)]
    return Shirt(x, uv, faces, left, frames)
