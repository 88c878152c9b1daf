#!/usr/bin/env bash
# Usage: cmake/add-test-packages.sh BUILD
# Installs the Python packages that some tests want (pyproject.toml, the extra `everything`) into the environment of a
# build that cmake/add-python.sh has prepared, each by itself. It names those that cannot be had; their tests are skipped.
set -euo pipefail

venv="$1/venv"
[[ -x "$venv/bin/pip" ]] || exit 0
list='import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["everything"], sep="\n")'
"$venv/bin/python" -c "$list" | while read -r package; do
  "$venv/bin/pip" -q --disable-pip-version-check install "$package" </dev/null ||
    echo "add-test-packages: $package cannot be had: its tests are skipped"
done
