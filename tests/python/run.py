"""Runs the tests beside it on the package in a folder: run.py FOLDER PROGRAM. Status 77, and a line, where something is absent."""

import importlib.util
import os
import subprocess
import sys

folder, program = sys.argv[1:]
sys.path.insert(0, folder)
if not any(name.startswith("_selvedge") for name in (os.listdir(os.path.join(folder, "selvedge")) if os.path.isdir(os.path.join(folder, "selvedge")) else [])):
    print("skipped: the extension is not built (cmake -DSELVEDGE_PYTHON=ON, with nanobind)")
    sys.exit(77)
for module in ("numpy", "pytest"):
    if importlib.util.find_spec(module) is None:
        print(f"skipped: {module} is absent")
        sys.exit(77)
environment = dict(os.environ, PYTHONPATH=folder, SELVEDGE_PROGRAM=program)
here = os.path.dirname(os.path.abspath(__file__))
sys.exit(subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", here], env=environment).returncode)
