"""Cells on this machine's cores, and what a node of a cluster does, by a program that stands in."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import uuid

import pytest
from cells_of_fleet import Work, gone, wait_until

import selvedge
from selvedge import fleet
from selvedge.fleet import listing, ray_worker
from selvedge.fleet.progress import Progress
from selvedge.fleet.ray_engine import keep_result

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(work, **options):
    return fleet.run(work.file, work.out, program=work.program, progress=False, **options)


def test_all_cells_are_done_by_falling_cost_and_gathered(tmp_path):
    work = Work(tmp_path, [{"name": f"c{cost}", "cost": cost} for cost in (2, 5, 1, 4, 3)])
    result = run(work, workers=1)
    assert [name for name, *_ in work.tries()] == ["c5", "c4", "c3", "c2", "c1"] == result.done
    assert not result.failed and not result.missing and result.seconds > 0
    assert work.rows() == ["c1", "c2", "c3", "c4", "c5"]
    assert result.gathered == (work.out / "table.csv").read_text()
    assert {threads for *_, threads in work.tries()} == {"1"}


def test_as_many_cells_run_at_a_time_as_asked(tmp_path):
    work = Work(tmp_path, [{"name": f"c{k}", "held": True} for k in range(5)])
    thread = threading.Thread(target=run, args=(work,), kwargs={"workers": 3})
    thread.start()
    wait_until(lambda: len(work.tries()) >= 3, "three cells")
    assert len(work.tries()) == 3
    work.release()
    thread.join()
    assert len(work.rows()) == 5 == len(work.tries())


def test_the_same_run_again_does_nothing_anew(tmp_path):
    work = Work(tmp_path, [{"name": f"c{k}"} for k in range(4)])
    first, made = run(work), work.results()
    again = run(work)
    assert len(work.tries()) == 4 and sorted(again.done) == sorted(first.done) and work.results() == made


def test_a_killed_cell_is_tried_again(tmp_path):
    work = Work(tmp_path, [{"name": "calm"}, {"name": "unlucky", "deaths": 2}, {"name": "doomed", "deaths": 9}])
    result = run(work, retries=2)
    assert sorted(result.done) == ["calm", "unlucky"] and work.rows() == ["calm", "unlucky"]
    assert len(work.tries("unlucky")) == 3 == len(work.tries("doomed")) and len(work.tries("calm")) == 1
    assert result.missing == {"doomed": "killed by signal 9"}


def test_a_failed_row_is_a_result_and_bad_input_is_named_once(tmp_path):
    work = Work(tmp_path, [{"name": "torn", "status": 1}, {"name": "bad", "status": 2}, {"name": "good"}])
    result = run(work)
    assert result.done == ["good"] and list(result.failed) == ["torn"] and work.rows() == ["good", "torn"]
    assert result.missing == {"bad": "bad: has a bad number"}
    assert len(work.tries("bad")) == 1 == len(work.tries("torn"))


def test_a_program_that_is_changed_meanwhile_is_refused(tmp_path):
    work = Work(tmp_path, [{"name": "first", "cost": 2, "held": True}, {"name": "second"}])
    results = []
    thread = threading.Thread(target=lambda: results.append(run(work, workers=1)))
    thread.start()
    wait_until(work.tries, "the first cell")
    work.program.write_text(work.program.read_text() + "\n")
    work.release()
    thread.join()
    assert results[0].done == ["first"] and "this program is" in results[0].missing["second"]


@pytest.mark.parametrize(
    "options, says",
    [
        ({"engine": "slurm"}, "engine: is 'slurm'"),
        ({"workers": 0}, "workers: is 0"),
        ({"retries": -1}, "retries: is -1"),
        ({"program": "no-such-program"}, "no-such-program: no such program"),
        ({"file": "absent.json"}, "selvedge cells: absent.json: no such file"),
        ({"out": __file__}, "cannot make this folder"),
    ],
)
def test_bad_arguments(tmp_path, options, says):
    work = Work(tmp_path, [{"name": "c"}])
    with pytest.raises(selvedge.Error, match=says):
        fleet.run(**{"file": work.file, "out": work.out, "program": work.program, "progress": False, **options})
    assert not work.tries()


def test_progress_is_one_line_and_what_is_kept_takes_no_time(capsys):
    cells = [listing.Cell(name, (), cost) for name, cost in (("kept", 1000), ("a", 1), ("b", 3), ("c", 4))]
    said = Progress(cells, {"kept"}, shown=True)
    said.ended("kept", "done")
    assert said.line(100.9) == "1 of 4 cells, 0:01:40 so far"
    said.ended("a", "again")
    said.ended("a", "failed")
    said.ended("b", "done")
    assert said.line(100.9) == "3 of 4 cells, 1 failed, 1 lost and tried again, 0:01:40 so far, about 0:01:40 to go"
    said.show()
    said.show(last=True)
    assert capsys.readouterr().err.startswith("3 of 4 cells, 1 failed, 1 lost and tried again, 0:0")


def start_command(work, *options):
    command = [sys.executable, "-m", "selvedge.fleet", work.file, "--out", work.out, "--program", work.program]
    return subprocess.Popen([*command, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_child_outlives_the_command(tmp_path, how):
    cells = [{"name": "quick", "cost": 9}, *({"name": f"c{k}", "held": True} for k in range(4))]
    work = Work(tmp_path, cells)
    command = start_command(work, "--workers", "2")
    wait_until(lambda: len(work.tries()) == 3, "two held cells")
    os.kill(command.pid, how)
    _, said = command.communicate(timeout=300)
    for _, process, *_ in work.tries():
        wait_until(lambda: gone(process), "the end of a child")
    assert len(work.tries()) == 3 and os.listdir(work.out / "cells") == ["quick"]
    assert work.interrupted() == (0 if how == signal.SIGKILL else 2)
    if how != signal.SIGKILL:
        assert command.returncode == 1 and "the same command goes on" in said
    work.release()
    command = start_command(work)
    printed, _ = command.communicate(timeout=300)
    assert command.returncode == 0 and len(printed.splitlines()) == 5 and len(work.tries("quick")) == 1


def test_the_command_says_what_is_missing(tmp_path):
    work = Work(tmp_path, [{"name": "bad", "status": 2}, {"name": "good"}, {"name": "torn", "status": 1}])
    command = start_command(work)
    printed, said = command.communicate(timeout=300)
    assert command.returncode == 1 and [line.split(",")[0] for line in printed.splitlines()] == ["good", "torn"]
    assert "bad: missing: bad: has a bad number" in said and "torn: failed: its row failed" in said
    assert "3 of 3 cells, 2 failed" in said
    work.file.unlink()
    command = start_command(work, "--quiet")
    _, said = command.communicate(timeout=300)
    assert command.returncode == 2 and said.startswith("error: selvedge cells: ") and said.endswith("no such file\n")


def task_of(work, program, program_files=None, file="work/cells.json", shared=""):
    key = subprocess.run([work.program, "cells", work.file, "--json"], capture_output=True, text=True).stdout
    key = json.loads(key)["program"]
    return ray_worker.Task(uuid.uuid4().hex, str(program), "of other bytes", program_files, key, file, shared)


@pytest.fixture
def node(tmp_path, monkeypatch):
    """A node without the program, whose object store is what tasks name."""
    folder = tmp_path / "node"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    monkeypatch.setattr(ray_worker, "_fetch", lambda reference: reference)
    return folder


def test_a_node_gets_the_program_and_the_inputs_once_and_is_cleaned(tmp_path, node):
    work = Work(tmp_path, [{"name": "a"}, {"name": "b"}])
    task = task_of(work, work.program, {"configs/silk.yaml": b"silk", "selvedge": work.program.read_bytes()})
    inputs = {"work/cells.json": work.file.read_bytes(), "meshes/a.txt": b"a mesh"}
    end, files = ray_worker.do_cell(task, "a", inputs, None)
    assert end == ("a", "done", "") and sorted(files) == ["cell.json", "frames/x.bin"]
    program = ray_worker.node_folder(task.run) / "program" / "selvedge"
    assert program.read_bytes() == work.program.read_bytes() and not program.is_symlink()
    assert (program.parent / "configs" / "silk.yaml").read_bytes() == b"silk"
    nothing_to_fetch = dict.fromkeys(inputs)
    end, _ = ray_worker.do_cell(task._replace(program_files=None), "b", nothing_to_fetch, None)
    assert end == ("b", "done", "")
    ray_worker.clean_node(task.run)
    assert not list(node.iterdir())


def test_a_node_uses_its_own_program_where_the_bytes_are_the_same(tmp_path, node):
    work = Work(tmp_path, [{"name": "a"}])
    same = ray_worker.hash_of_file(str(work.program))
    task = task_of(work, work.program, None)._replace(program_hash=same)
    inputs = {"work/cells.json": work.file.read_bytes(), "meshes/a.txt": b"a mesh"}
    end, _ = ray_worker.do_cell(task, "a", inputs, None)
    assert end == ("a", "done", "")
    assert (ray_worker.node_folder(task.run) / "program" / "selvedge").resolve() == work.program


def test_a_known_result_stays_where_it_fits_and_is_replaced_where_not(tmp_path, node):
    work = Work(tmp_path, [{"name": "a"}])
    task = task_of(work, work.program, {"selvedge": work.program.read_bytes()})
    inputs = {"work/cells.json": work.file.read_bytes(), "meshes/a.txt": b"a mesh"}
    _, files = ray_worker.do_cell(task, "a", inputs, None)
    assert ray_worker.do_cell(task, "a", inputs, files["cell.json"]) == (("a", "done", ""), None)
    assert len(work.tries()) == 1
    assert ray_worker.do_cell(task, "a", inputs, b"{}") == (("a", "done", ""), files)
    old = {"cell.json": b"{}", "gone.bin": b""}
    for known in (old, files):
        keep_result(work.out, "a", known)
        assert ray_worker.read_files(work.out / "cells" / "a") == known
    assert os.listdir(work.out / "cells") == ["a"]


SHOTS = {
    "scenes/sheet.yaml": """
cloths:
  - {name: sheet, rectangle: {size: [0.4, 0.4], edge: 10 cm}, translate: [0, 0.3, 0]}
run: {frames: 3, fps: 30}
""",
    "work/shots.yaml": """
cells: shots
pages: false
shots:
  - {name: low, scene: ../scenes/sheet.yaml}
  - {name: high, scene: ../scenes/sheet.yaml, set: ["cloths.sheet.translate=[0, 1, 0]"]}
""",
}


def test_shots_by_the_program_itself_here_and_on_a_node_have_the_same_positions(tmp_path, node):
    program = os.environ.get("SELVEDGE_PROGRAM")
    if not program:
        pytest.skip("SELVEDGE_PROGRAM is not set")
    ray_worker.write_files(tmp_path, {path: text.encode() for path, text in SHOTS.items()})
    file, out = tmp_path / "work" / "shots.yaml", tmp_path / "out"
    result = fleet.run(file, out, program=program, progress=False)
    assert sorted(result.done) == ["high", "low"] and not result.failed and not result.missing
    assert "high" in result.gathered and "low" in result.gathered
    listed = listing.list_cells(program, file)
    files = {"selvedge": pathlib.Path(program).read_bytes()}
    task = ray_worker.Task(uuid.uuid4().hex, "", "", files, listed.key, "work/shots.yaml", "")
    hashes = set()
    for cell in listed.cells:
        inputs = {os.path.relpath(need, tmp_path): pathlib.Path(need).read_bytes() for need in cell.needs}
        inputs["work/shots.yaml"] = file.read_bytes()
        local = (out / "cells" / cell.name / "cell.json").read_bytes()
        assert ray_worker.do_cell(task, cell.name, inputs, local) == ((cell.name, "done", ""), None)
        end, made = ray_worker.do_cell(task, cell.name, inputs, None)
        assert end == (cell.name, "done", "")
        here, there = json.loads(local), json.loads(made["cell.json"])
        assert here["positions_hash"] == there["positions_hash"] and here["key"] == there["key"]
        hashes.add(here["positions_hash"])
    assert len(hashes) == 2


def test_the_python_of_the_page(tmp_path, monkeypatch, capsys):
    work = Work(tmp_path, [{"name": "good"}, {"name": "torn", "status": 1}])
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setattr(listing, "__file__", str(tmp_path / "site-packages" / "selvedge" / "fleet" / "listing.py"))
    monkeypatch.chdir(work.file.parent)
    work.file.rename("work.yaml")
    (block,) = (ROOT / "docs" / "scale.md").read_text().split("```python\n")[1:]
    exec(compile(block.split("```")[0], "docs/scale.md", "exec"), {})
    assert capsys.readouterr().out.splitlines()[-1] == "1 done, 1 failed, 0 missing"
    assert (work.file.parent / "out" / "work" / "table.csv").is_file()
