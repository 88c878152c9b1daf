"""Makes docs/blender/panel.jpg again: picture.py PROGRAM. Needs Blender, xvfb-run and Pillow.

The program dresses its mannequin; body and T-shirt go into Blender as meshes; the add-on bakes the T-shirt there, in a
window on a display that nobody sees (window.py), and a picture is taken of it. Files lie in out/blender.
"""

import os
import pathlib
import subprocess
import sys

from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
OUT = ROOT / "out" / "blender"
FRAMES = 45
PERSON = "obstacles: [{name: person, body: {model: mannequin, clip: walk, blend_in: 1 s}}]\n"
SCENES = {
    "shirt": PERSON + "cloths: [{name: shirt, garment: {cut: tshirt, on: person, edge: 25 mm}}]\nrun: {frames: 1}\n",
    "walk": PERSON + f"cloths: [{{rectangle: {{size: 1 cm}}, translate: [9, 9, 9]}}]\nrun: {{frames: {FRAMES}}}\n",
}


def prepared(program, name):
    """Point caches and meshes of a scene, as commands."""
    scene, run = OUT / f"{name}.yaml", OUT / name
    scene.write_text(SCENES[name])
    return [
        [program, "simulate", scene, "--out", run, "--no-view"],
        [program, "export", run, "--format", "pc2", "--obstacles", "--out", run],
    ]


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    OUT.mkdir(parents=True, exist_ok=True)
    archive, shot = OUT / "selvedge_cloth.zip", OUT / "window.png"
    user = {name: str(OUT / "user") for name in ("BLENDER_USER_SCRIPTS", "BLENDER_USER_CONFIG")}
    user["XDG_CACHE_HOME"] = str(OUT / "cache")  # else a warning tells of trainings on this machine
    blender = ["blender", "--window-geometry", "0", "0", "1280", "800", "--factory-startup", "--enable-event-simulate"]
    for command in (
        *prepared(program, "shirt"),
        *prepared(program, "walk"),
        [sys.executable, ROOT / "pipeline/blender/pack.py", archive],
        ["xvfb-run", "-a", "-s", "-screen 0 1280x800x24", *blender, "--python-exit-code", "3"]
        + ["--python", HERE / "window.py", "--", archive, OUT, program, shot],
    ):
        subprocess.run(list(map(str, command)), check=True, env=dict(os.environ, LIBGL_ALWAYS_SOFTWARE="1", **user))
    picture = Image.open(shot).convert("RGB")
    picture.save(HERE / "panel.jpg", quality=82)


main()
