"""Cells on a Ray cluster of two nodes of one core on this machine; skipped without the package ray."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading

import pytest
from cells_of_fleet import Work, gone, wait_until
from shots_of_fleet import write_shots

import selvedge
from selvedge import fleet

ray = pytest.importorskip("ray", reason="the package ray cannot be imported")
from ray.cluster_utils import Cluster  # noqa: E402

os.environ["RAY_USAGE_STATS_ENABLED"] = "0"  # a test tells nobody of itself
NODE = {"num_cpus": 1, "object_store_memory": 100_000_000}
# A node that does not answer is given up after 3 s rather than 25.
QUICK = {"health_check_initial_delay_ms": 1000, "health_check_period_ms": 1000, "health_check_failure_threshold": 3}


@pytest.fixture
def cluster():
    """Of a head and one more node, which its second item kills."""
    made = Cluster(initialize_head=True, head_node_args={**NODE, "_system_config": QUICK, "include_dashboard": False})
    second = made.add_node(**NODE)
    yield made, second
    ray.shutdown()
    made.shutdown()


def run(work, cluster, **options):
    options = {"program": work.program, "progress": False, "address": cluster.address, **options}
    return fleet.run(work.file, work.out, "ray", **options)


def held_from(count, first):
    return [{"name": f"c{k:02}", "cost": count - k, "held": k >= first} for k in range(count)]


def folders_of_nodes():
    return set(pathlib.Path(tempfile.gettempdir()).glob("selvedge-fleet-*"))


LEFT_BEFORE = folders_of_nodes()  # by a run that was killed


def left_on_nodes():
    return folders_of_nodes() - LEFT_BEFORE


def parent_of(process):
    after_name = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2]
    return int(after_name.split()[1])


@pytest.mark.parametrize("shared", [False, True])
def test_a_worker_and_a_node_are_killed_in_the_middle(tmp_path, cluster, shared):
    made, second = cluster
    work = Work(tmp_path, held_from(40, 20))
    results = []
    thread = threading.Thread(target=lambda: results.append(run(work, made, shared=shared)), daemon=True)
    thread.start()

    def tries_of_held():
        return [entry for entry in work.tries() if entry[0] >= "c20"]

    wait_until(lambda: len(tries_of_held()) == 2, "a held cell on each node")
    killed = {parent_of(worker): (name, cell, worker) for name, cell, worker, _ in tries_of_held()}
    raylet = second.all_processes["raylet"][0].process.pid
    assert len(killed) == 2 and raylet in killed
    _, cell, on_second = killed[raylet]
    ((_, _, on_head),) = [entry for node, entry in killed.items() if node != raylet]
    os.kill(on_head, signal.SIGKILL)
    wait_until(lambda: len(tries_of_held()) == 3, "a try after the worker's death")
    os.kill(raylet, signal.SIGKILL)
    os.kill(on_second, signal.SIGKILL)
    wait_until(lambda: gone(cell), "the end of a cell without its worker")
    work.release()
    thread.join()
    names = sorted(f"c{k:02}" for k in range(40))
    assert sorted(results[0].done) == names == work.rows() and not results[0].failed and not results[0].missing
    assert all(len(work.tries(name)) > 1 for name, *_ in killed.values())
    local = tmp_path / "local"
    fleet.run(work.file, local, program=work.program, progress=False)
    assert work.results() == work.results(local) and len(work.results()) == 80
    assert not left_on_nodes()


def halted_cell(raylet):
    """Halts a cell of the program that runs on a node: its process, the worker that waits for it, and its name."""
    halted = []

    def halt_one():
        for process in (int(entry.name) for entry in pathlib.Path("/proc").glob("[0-9]*")):
            try:
                words = pathlib.Path(f"/proc/{process}/cmdline").read_text().split("\0")
                if words[1:2] == ["cell"] and parent_of(worker := parent_of(process)) == raylet:
                    os.kill(process, signal.SIGSTOP)
                    halted.append((process, worker, words[3]))
                    return True
            except OSError:  # it has ended
                continue
        return False

    wait_until(halt_one, "a cell on a node")
    return halted[0]


def test_a_worker_and_a_node_are_killed_in_the_middle_of_cells_of_the_program(tmp_path, cluster):
    program = os.environ.get("SELVEDGE_PROGRAM")
    if not program:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    made, second = cluster
    file, out, results = write_shots(tmp_path, 40), tmp_path / "out", []
    options = {"program": program, "progress": False}

    def by_ray():
        results.append(fleet.run(file, out, "ray", address=made.address, **options))

    thread = threading.Thread(target=by_ray, daemon=True)
    thread.start()
    wait_until(lambda: len(list(out.glob("cells/c*"))) >= 10, "ten results")
    raylets = [node.all_processes["raylet"][0].process.pid for node in (made.head_node, second)]
    halted = [halted_cell(raylet) for raylet in raylets]
    assert not any((out / "cells" / name).exists() for *_, name in halted)
    os.kill(halted[0][1], signal.SIGKILL)
    os.kill(raylets[1], signal.SIGKILL)
    os.kill(halted[1][1], signal.SIGKILL)
    for process, *_ in halted:
        wait_until(lambda: gone(process), "the end of a halted cell")
    thread.join()
    names = sorted(f"c{k:03}" for k in range(40))
    assert sorted(results[0].done) == names and not results[0].failed and not results[0].missing
    listed = [line.split()[0] for line in results[0].gathered.splitlines()]
    assert sorted(name for name in listed if name in names) == names

    local = tmp_path / "local"
    assert sorted(fleet.run(file, local, **options).done) == names

    def positions(folder):
        cells = (json.loads((folder / "cells" / name / "cell.json").read_text()) for name in names)
        return [(cell["key"], cell["positions_hash"]) for cell in cells]

    assert positions(out) == positions(local) and len({of for _, of in positions(local)}) == 40


def test_the_same_run_again_does_nothing_anew_and_a_refused_cell_is_named(tmp_path, cluster):
    made, _ = cluster
    odd = [{"name": "bad", "status": 2}, {"name": "torn", "status": 1}, {"name": "unlucky", "deaths": 1}]
    work = Work(tmp_path, [*({"name": f"c{k}"} for k in range(4)), *odd])
    first, results = run(work, made), work.results()
    assert sorted(first.done) == ["c0", "c1", "c2", "c3", "unlucky"] and list(first.failed) == ["torn"]
    assert first.missing == {"bad": "bad: has a bad number"} and len(work.tries("unlucky")) == 2
    tries = len(work.tries())
    again = run(work, made)
    assert sorted(again.done) == sorted(first.done) and again.missing == first.missing and work.results() == results
    assert len(work.tries()) == tries + 1 == 9  # the refused one has no result
    assert not left_on_nodes()


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_leaves_no_child_and_the_cluster(tmp_path, cluster, how):
    made, _ = cluster
    work = Work(tmp_path, [{"name": "quick", "cost": 9}, *({"name": f"c{k}", "held": True} for k in range(4))])
    command = [sys.executable, "-m", "selvedge.fleet", work.file, "--out", work.out, "--program", work.program]
    command += ["--engine", "ray", "--address", made.address]
    command = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    wait_until(lambda: len(work.tries()) == 3 and "quick" in os.listdir(work.out / "cells"), "two held cells")
    os.kill(command.pid, how)
    _, said = command.communicate(timeout=300)
    assert command.returncode == 1 and "the same command goes on" in said
    for _, process, *_ in work.tries():
        wait_until(lambda: gone(process), "the end of a child")
    assert os.listdir(work.out / "cells") == ["quick"] and len(work.tries()) == 3 and work.interrupted() == 2
    work.release()
    assert len(run(work, made).done) == 5 and len(work.tries("quick")) == 1


def test_no_cluster_at_an_address(tmp_path):
    work = Work(tmp_path, [{"name": "c"}])
    with pytest.raises(selvedge.Error, match="no cluster at 127.0.0.1:9"):
        fleet.run(work.file, work.out, "ray", program=work.program, address="127.0.0.1:9", progress=False)
