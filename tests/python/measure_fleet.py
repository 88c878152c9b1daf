"""What selvedge.fleet adds to a cell: measure_fleet.py [CELLS] [REPEATS], a table for docs/results/cells.md.

Cells are those of the program that stands in, which takes as long as a start of Python. A run is compared with a bare
one of the same cells: as many threads as workers, each of which calls the program on one cell after another, in a
session of its own as selvedge.fleet does, because schedulers may share out cores by session.
"""

import concurrent.futures
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from cells_of_fleet import Work

from selvedge import fleet


def work_of(folder, count):
    folder.mkdir()
    return Work(folder, [{"name": f"c{k:03}"} for k in range(count)])


def bare(folder, count, workers):
    """Seconds of all cells without selvedge.fleet."""
    work = work_of(folder, count)
    begun = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        for k in range(count):
            command = [work.program, "cell", work.file, f"c{k:03}", "--out", work.out]
            pool.submit(subprocess.run, command, check=True, start_new_session=True)
    return time.monotonic() - begun


def with_fleet(folder, count, workers, engine):
    """Seconds by the clock, and of this process on its processor."""
    work = work_of(folder, count)
    begun = time.process_time()
    result = fleet.run(work.file, work.out, engine, program=work.program, workers=workers, progress=False)
    assert len(result.done) == count
    return result.seconds, time.process_time() - begun


def measure(name, count, repeats, workers, engine):
    """Prints medians; bare and other runs take turns, since the machine may be busier at one time than at another."""
    with tempfile.TemporaryDirectory() as folder:
        top = pathlib.Path(folder)
        if engine == "ray":
            with_fleet(top / "warm", 2 * workers, workers, engine)  # workers of Ray start once
        pairs = [
            (bare(top / f"bare{k}", count, workers), *with_fleet(top / f"fleet{k}", count, workers, engine))
            for k in range(repeats)
        ]
    added = sorted((seconds - alone) * workers / count * 1000 for alone, seconds, _ in pairs)
    alone, seconds, own = (statistics.median(times) for times in zip(*pairs))
    by_clock = f"{statistics.median(added):.0f} ms ({added[0]:.0f} to {added[-1]:.0f})"
    print(f"| {name} | {alone:.1f} s | {seconds:.1f} s | {by_clock} | {own / count * 1000:.1f} ms |", flush=True)


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    repeats = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    print("| workers | bare | with selvedge.fleet | added to a cell: median (least to most) | of the driver's core |")
    for workers in (1, 2):
        measure(f"local, {workers}", count, repeats, workers, "local")
    try:
        import ray
        from ray.cluster_utils import Cluster
    except ImportError:
        return print("Ray cannot be imported")
    node = {"num_cpus": 1, "object_store_memory": 100_000_000}
    cluster = Cluster(initialize_head=True, head_node_args={**node, "include_dashboard": False})
    cluster.add_node(**node)
    ray.init(address=cluster.address, log_to_driver=False, logging_level="ERROR")
    measure("Ray, two nodes of one core", count, repeats, 2, "ray")
    ray.shutdown()
    cluster.shutdown()


if __name__ == "__main__":
    main()
