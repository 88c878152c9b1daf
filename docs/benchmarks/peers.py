"""selvedge beside Blender and pyPBD on configs/bench: the same meshes, in turn, on the same threads.

    python docs/benchmarks/peers.py --program build/release/selvedge --threads 1 --out out/peers

Needs numpy and h5py; Blender and pyPBD are run where they are installed. Each run of a peer is written as a trajectory of
ours, and `selvedge check` counts the pairs and the stretch of all. Prints a table in Markdown; times are wall times of a
frame, so that nothing else should run beside.
"""

import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys

import h5py
import numpy as np

HERE = pathlib.Path(__file__).parent
SCENES = [("hang", 40, 60), ("hang", 100, 30), ("drop", 40, 60), ("drop", 100, 60)]
OURS = {"selvedge": [], "selvedge, preview": ["run.quality=preview"]}


def run(command, threads, **more):
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads), **more}
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, env=environment)
    if done.returncode > 1:  # 1: the cloth intersects
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


def ours(arguments, scene, resolution, frames, overrides, folder):
    """Seconds of each frame; leaves folder/run.h5."""
    command = [arguments.program, "simulate", HERE.parents[1] / f"configs/bench/{scene}.yaml", "--out", folder, "--no-view"]
    for override in [f"cloths.sheet.rectangle.resolution={resolution}", f"run.frames={frames}", *overrides]:
        command += ["--set", override]
    run(command, arguments.threads)
    with h5py.File(folder / "run.h5") as file:
        return file["frames/report"]["seconds"][1:]


def twin_of(trajectory, path):
    """What a peer needs of the scene."""
    with h5py.File(trajectory) as file:
        parts = {"x": file["frames/x"][0], "triangles": file["cloth/triangles"][:], "pins": file["cloth/pins"][:]}
        parts["fps"], parts["frames"] = file["fps"][0], len(file["frames/x"]) - 1
        if "obstacles/0" in file:
            parts["ball"], parts["ball_triangles"] = file["obstacles/0/x"][0], file["obstacles/0/triangles"][:]
        np.savez(path, **parts)


def peer(name, arguments, folder):
    """Seconds of each frame; leaves folder/run.h5. None where the peer is not there, or does not fit the scene."""
    scene, result = folder / "twin.npz", folder / f"{name}.npz"
    if name == "Blender":
        if not shutil.which("blender"):
            return None
        run(["blender", "--background", "--factory-startup", "-t", arguments.threads, "--python-exit-code", "3"]
            + ["--python", HERE / "blender_twin.py", "--", scene, result],
            arguments.threads, PATH="/usr/bin:/bin")  # else Debian's takes the first Python in PATH for its own
    else:
        if subprocess.run([sys.executable, "-c", "import pypbd"], capture_output=True).returncode != 0:
            return None
        if "ball" in np.load(scene):
            return None  # it has no contact of cloth with itself, and its ball lets cloth in
        run([sys.executable, HERE / "pypbd_twin.py", scene, result], arguments.threads)
    found = np.load(result)
    shutil.copy(folder / "ours/run.h5", folder / "run.h5")
    with h5py.File(folder / "run.h5", "r+") as file:
        file["frames/x"][:] = found["x"]
    return found["seconds"]


def checked(arguments, trajectory):
    command = [arguments.program, "check", trajectory, "--json"]
    return json.loads(subprocess.run([str(part) for part in command], capture_output=True, text=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=pathlib.Path("build/release/selvedge"))
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--scenes", default="", help="only those whose name and resolution begin like this, as in hang_40")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/peers"))
    arguments = parser.parse_args()
    print("| scene | program | median, mean, worst [ms] | frames with pairs | most pairs | inside | stretch |")
    print("|---|---|---|---|---|---|---|")
    for scene, resolution, frames in SCENES:
        if not f"{scene}_{resolution}".startswith(arguments.scenes):
            continue
        times, checks = {}, {}
        for repeat in range(arguments.repeats):
            for name in [*OURS, "Blender", "pyPBD"]:
                folder = arguments.out / f"{scene}_{resolution}" / name.replace(", ", "_")
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir(parents=True)
                if name in OURS:
                    seconds = ours(arguments, scene, resolution, frames, OURS[name], folder)
                else:
                    shutil.copytree(arguments.out / f"{scene}_{resolution}" / "selvedge", folder / "ours")
                    twin_of(folder / "ours/run.h5", folder / "twin.npz")
                    seconds = peer(name, arguments, folder)
                if seconds is None:
                    continue
                milliseconds = 1e3 * np.asarray(seconds)
                times.setdefault(name, []).append([np.median(milliseconds), milliseconds.mean(), milliseconds.max()])
                if repeat == 0:
                    checks[name] = checked(arguments, folder / "run.h5")
        for name, rows in times.items():
            check, middle = checks[name], [statistics.median(row[k] for row in rows) for k in range(3)]
            pairs = check["intersecting_pairs_by_frame"]
            print(f"| {scene}, N = {resolution}, {frames} frames | {name} | {', '.join(f'{m:.0f}' for m in middle)} | "
                  f"{sum(p > 0 for p in pairs)} | {max(pairs)} | {check['inside_vertices']} | {check['max_stretch']:.2f} |",
                  flush=True)


if __name__ == "__main__":
    main()
