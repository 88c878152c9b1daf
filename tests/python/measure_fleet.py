"""What selvedge.fleet adds to a cell: measure_fleet.py PROGRAM [CELLS] [REPEATS], a table for docs/results/cells.md.

Cells are short shots by the program itself. A run's overhead is its time by the clock, times its workers, less the
times that its cells took by themselves. Bare runs list the cells, call the program on one after another, in as many
threads as there are workers, and gather; each cell is in a session of its own as selvedge.fleet does it, because
schedulers may share out cores by session. Bare runs and others take turns, since the machine may be busier at one time
than at another.
"""

import concurrent.futures
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from shots_of_fleet import write_shots

from selvedge import fleet

# Notes when a cell's process begins and ends.
TIMED = """#!/bin/bash
begun=$EPOCHREALTIME
"{program}" "$@"
status=$?
[ "$1" != cell ] || echo "$begun $EPOCHREALTIME" >>"{times}"
exit $status
"""


class Run:
    """A folder with a work file and a program that notes the times of cells."""

    def __init__(self, folder, count, program):
        folder.mkdir()
        self.file, self.out, self.times = write_shots(folder, count), folder / "out", folder / "times"
        self.program = folder / "selvedge"
        self.program.write_text(TIMED.format(program=program, times=self.times))
        self.program.chmod(0o755)

    def own_seconds(self):
        """Of each cell."""
        times = [line.split() for line in self.times.read_text().splitlines()]
        return [float(end) - float(begun) for begun, end in times]


def bare(run, count, workers):
    """Seconds of all cells, the listing and the gathering, without selvedge.fleet."""
    begun, quiet = time.monotonic(), {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    options = {"check": True, "start_new_session": True, "env": dict(os.environ, OMP_NUM_THREADS="1"), **quiet}
    out = ["--out", run.out]
    subprocess.run([run.program, "cells", run.file, "--json"], **options)
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        for k in range(count):
            pool.submit(subprocess.run, [run.program, "cell", run.file, f"c{k:03}", *out], **options)
    subprocess.run([run.program, "gather", run.file, *out], **options)
    return time.monotonic() - begun


def with_fleet(run, count, workers, engine):
    """Seconds of all cells, the listing and the gathering."""
    result = fleet.run(run.file, run.out, engine, program=run.program, workers=workers, progress=False)
    assert len(result.done) == count
    return result.seconds


def measure(program, name, count, repeats, workers, engine):
    with tempfile.TemporaryDirectory() as folder:
        top = pathlib.Path(folder)
        if engine == "ray":
            with_fleet(Run(top / "warm", 2 * workers, program), 2 * workers, workers, engine)  # workers of Ray start once
        rows = {"bare": [], "with selvedge.fleet": []}
        for k in range(repeats):
            for kind, row in rows.items():
                run = Run(top / f"{kind}{k}", count, program)
                wall = bare(run, count, workers) if kind == "bare" else with_fleet(run, count, workers, engine)
                own = run.own_seconds()
                row.append((wall, statistics.median(own), (wall * workers - sum(own)) / count, os.getloadavg()[0]))
    for kind, row in rows.items():
        wall, own, added, load = (sorted(column) for column in zip(*row))
        text = [f"{statistics.median(wall):.1f} s", f"{1000 * statistics.median(own):.0f} ms"]
        text += [f"{1000 * statistics.median(added):.0f} ms ({1000 * added[0]:.0f} to {1000 * added[-1]:.0f})"]
        print("|", " | ".join([name, kind, *text, f"{load[0]:.0f} to {load[-1]:.0f}"]), "|", flush=True)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    count, repeats = (int(sys.argv[k]) if len(sys.argv) > k else value for k, value in ((2, 200), (3, 3)))
    print("| workers | run | by the clock | a cell itself | overhead a cell: median (least to most) | load |")
    for workers in (1, 2):
        measure(program, f"local, {workers}", count, repeats, workers, "local")
    try:
        import ray
        from ray.cluster_utils import Cluster
    except ImportError:
        return print("Ray cannot be imported")
    node = {"num_cpus": 1, "object_store_memory": 100_000_000}
    cluster = Cluster(initialize_head=True, head_node_args={**node, "include_dashboard": False})
    cluster.add_node(**node)
    ray.init(address=cluster.address, log_to_driver=False, logging_level="ERROR")
    measure(program, "Ray, two nodes of one core", count, repeats, 2, "ray")
    ray.shutdown()
    cluster.shutdown()


if __name__ == "__main__":
    main()
