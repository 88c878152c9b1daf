"""Stands in for the program in tests of selvedge.fleet: its commands `cells`, `cell` and `gather` (docs/scale.md).

FILE is JSON: "marks", a folder in which every try leaves a file, "needs", files, and "cells", each with "name" and
where wanted "cost"; "status" to end with; "deaths", how many tries kill themselves; "held", to wait until
marks/release is there.
"""

import argparse
import hashlib
import json
import os
import pathlib
import shutil
import signal
import sys
import time
import uuid


def key_of_program():
    return hashlib.sha256(pathlib.Path(__file__).read_bytes()).hexdigest()[:16]


def needs_of(file, work):
    return [file.parent / need for need in work.get("needs", [])]


def list_cells(file, work):
    needs = [str(need) for need in needs_of(file, work)]
    cells = [{"name": c["name"], "needs": needs, "cost": c.get("cost", 1)} for c in work["cells"]]
    print(json.dumps({"file": str(file), "kind": "stand-in", "program": key_of_program(), "cells": cells}))
    return 0


def do_cell(file, work, name, out, program):
    if program not in (None, key_of_program()):
        return refuse(f"--program: is {program}, and this program is {key_of_program()}")
    asked = [cell for cell in work["cells"] if cell["name"] == name]
    if not asked:
        return refuse(f"{file}: has no cell {name}")
    cell = asked[0]
    absent = [need for need in needs_of(file, work) if not need.is_file()]
    if absent:
        return refuse(f"{absent[0]}: no such file")
    content = [need.read_text() for need in needs_of(file, work)]
    result = {"name": name, "status": cell.get("status", 0)}
    result["value"] = hashlib.sha256(json.dumps([name, content]).encode()).hexdigest()
    result["key"] = hashlib.sha256(json.dumps([result, key_of_program()]).encode()).hexdigest()
    text, place = json.dumps(result), out / "cells" / name
    if place.is_dir() and (place / "cell.json").read_text() == text:
        return result["status"]
    start(cell, pathlib.Path(work["marks"]))
    if cell.get("status") == 2:
        return refuse(f"{name}: has a bad number")
    growing = place.with_name(f".{uuid.uuid4().hex}")
    (growing / "frames").mkdir(parents=True)
    (growing / "frames" / "x.bin").write_bytes(text.encode() * 1000)
    (growing / "cell.json").write_text(text)
    shutil.rmtree(place, ignore_errors=True)
    growing.rename(place)
    return result["status"]


def start(cell, marks):
    tries = len(list(marks.glob(f"{cell['name']}.try.*")))
    mark = marks / f"{cell['name']}.try.{time.time_ns()}"
    mark.with_suffix(".new").write_text(json.dumps([os.getpid(), os.getppid(), os.environ.get("OMP_NUM_THREADS")]))
    mark.with_suffix(".new").rename(mark)
    if tries < cell.get("deaths", 0):
        os.kill(os.getpid(), signal.SIGKILL)
    while cell.get("held") and not (marks / "release").exists():
        time.sleep(0.01)


def gather(out):
    rows = [json.loads(file.read_text()) for file in sorted(out.glob("cells/*/cell.json"))]
    table = "".join(f"{row['name']},{row['status']},{row['value']}\n" for row in rows)
    (out / "table.csv").write_text(table)
    print(table, end="")
    return 0


def refuse(message):
    print(message, file=sys.stderr)
    return 2


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command", choices=["cells", "cell", "gather"])
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("name", nargs="?")
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--program")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    if not given.file.is_file():
        return refuse(f"{given.file}: no such file")
    work = json.loads(given.file.read_text())
    if given.command == "cells":
        return list_cells(given.file, work)
    if given.command == "gather":
        return gather(given.out)
    try:
        return do_cell(given.file, work, given.name, given.out, given.program)
    except KeyboardInterrupt:
        (pathlib.Path(work["marks"]) / f"{given.name}.interrupted").touch()
        return 1


sys.exit(main())
