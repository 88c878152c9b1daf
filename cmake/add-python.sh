#!/usr/bin/env bash
# Usage: cmake/add-python.sh BUILD
# Adds the Python extension to a configured build: an environment with nanobind, at the version that pyproject.toml pins, beside
# Debian's numpy and pytest. Where nanobind cannot be had it says so, and the build goes on without.
set -euo pipefail

build="$1"
grep -q '^SELVEDGE_PYTHON:BOOL=ON' "$build/CMakeCache.txt" && exit 0
python=/usr/bin/python3
[[ -x "$python" ]] || python=python3
nanobind="$(grep -o 'nanobind==[0-9.]*' pyproject.toml)"
if ! { "$python" -m venv --system-site-packages "$build/venv" && "$build/venv/bin/pip" -q install "$nanobind"; }; then
  echo "add-python: $nanobind cannot be had: the Python extension is left out, and its tests are skipped"
  exit 0
fi
cmake -DSELVEDGE_PYTHON=ON -DPython_EXECUTABLE="$PWD/$build/venv/bin/python" "$build"
