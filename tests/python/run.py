"""Runs the tests beside it on the package in FOLDER: run.py FOLDER PROGRAM.

Status 77, and a line, where something is absent.
"""

import importlib.util
import os
import pathlib
import subprocess
import sys


def absent(folder):
    """What the tests need and cannot have, as a sentence; empty where all is there."""
    if not list((folder / "selvedge").glob("_selvedge*.so")):
        return "the extension is not built (cmake/add-python.sh, which needs nanobind from the package index)"
    missing = [module for module in ("numpy", "pytest") if importlib.util.find_spec(module) is None]
    return f"{' and '.join(missing)} cannot be imported" if missing else ""


def main():
    folder, program = pathlib.Path(sys.argv[1]), sys.argv[2]
    if why := absent(folder):
        print(f"skipped: {why}")
        return 77
    environment = dict(os.environ, PYTHONPATH=str(folder), SELVEDGE_PROGRAM=program)
    tests = pathlib.Path(__file__).resolve().parent
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", tests]
    return subprocess.run(command, env=environment).returncode


sys.exit(main())
