#!/usr/bin/env bash
# Usage: cmake/test-wheel.sh FOLDER [PROGRAM]
# Does as a user of `pip install .` does: builds a wheel of a copy of the tracked files, installs it into an empty environment,
# moves the copy away, and runs tests/python. PROGRAM is one without SuiteSparse, whose bits a run from Python must have;
# where it is not built that test is skipped. Where pip has no index, it says so and ends well.
set -euo pipefail

folder="$(mkdir -p "$1" && cd "$1" && pwd)"
program="$([[ -x "${2:-}" ]] && realpath "$2" || true)"
python=/usr/bin/python3
[[ -x "$python" ]] || python=python3
rm -rf "$folder"/{moved,tests,installed,empty,wheels}
"$python" -m venv "$folder/empty"
if ! "$folder/empty/bin/pip" -q download --no-deps -d "$folder/wheels" "$(grep -o 'nanobind==[0-9.]*' pyproject.toml)"; then
  echo "test-wheel: skipped: nanobind cannot be had"
  exit 0
fi
rm -rf "$folder/wheels"

# Times are kept, so that a second run compiles what has changed.
mkdir -p "$folder/source"
git ls-files -z | xargs -0 cp -p --parents -t "$folder/source"
CMAKE_BUILD_PARALLEL_LEVEL="${JOBS:-$(nproc)}" "$folder/empty/bin/pip" wheel --no-deps -w "$folder/wheels" "$folder/source"
"$folder/empty/bin/pip" -q install "$folder"/wheels/*.whl pytest
"$folder/empty/bin/pip" -q install "$(echo "$folder"/wheels/*.whl)[fleet]" ||
  echo "test-wheel: Ray cannot be had: the tests of a cluster are skipped"
mkdir -p "$folder/tests"
cp --parents -r -t "$folder/tests" tests/python README.md docs configs/weights

mv "$folder/source" "$folder/moved"
trap 'mv "$folder/moved" "$folder/source"' EXIT
cd "$folder/tests"
SELVEDGE_PROGRAM="$program" "$folder/empty/bin/python" -m pytest -q -p no:cacheprovider tests/python
