#!/usr/bin/env bash
# Usage: docs/site/build.sh
# Makes the site of docs/ in out/site. Any warning is an error. Python packages go into an environment below build/, at
# the versions of requirements.txt, and anew where these have changed. Where CI runs without pip's index, it says so and
# ends well.
set -euo pipefail
cd "$(dirname "$0")/../.."

venv=build/site/venv
wanted=docs/site/requirements.txt
if ! cmp -s "$wanted" "$venv/installed"; then
  python=/usr/bin/python3
  [[ -x "$python" ]] || python=python3
  rm -rf "$venv"
  "$python" -m venv "$venv"
  pip=("$venv/bin/pip" -q --disable-pip-version-check)
  if [[ -n "${CI:-}" ]] && ! "${pip[@]}" download --no-deps -d "$venv/probe" "$(grep "^mkdocs==" "$wanted")"; then
    echo "docs: skipped: mkdocs cannot be had"
    exit 0
  fi
  "${pip[@]}" install --no-deps --no-compile -r "$wanted"
  cp "$wanted" "$venv/installed"
fi

NO_MKDOCS_2_WARNING=1 "$venv/bin/mkdocs" build --strict -f docs/site/mkdocs.yml 2>&1 | { grep -v '^INFO' || true; }
rm -rf build/site/include
cmake -Dsource="$PWD" -DCMAKE_INSTALL_PREFIX="$PWD/build/site" -P cmake/install-headers.cmake
doxygen docs/site/Doxyfile
echo "the site is out/site/index.html"
