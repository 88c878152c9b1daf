#!/usr/bin/env bash
# Usage: cmake/check-install.sh FOLDER
# Copies the sources, configures them for the libraries alone, with the packages of the program out of sight, installs
# them, removes the copy, and builds and runs docs/examples/drop.cpp by find_package(selvedge). Takes what a compile
# cache has.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
mkdir -p "$1"
work="$(cd "$1" && pwd)"
rm -rf "$work"
mkdir -p "$work/source"
cp -r "$root"/{CMakeLists.txt,cmake,collision,physics,configs} "$work/source"
hidden=()
for package in HDF5 yaml-cpp CLI11 nlohmann_json fmt Catch2; do
  hidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
launcher="${CMAKE_CXX_COMPILER_LAUNCHER:-$(command -v ccache || true)}"
cmake -S "$work/source" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" \
  -DSELVEDGE_PROGRAM=OFF "${hidden[@]}" >/dev/null
cmake --build "$work/build" --parallel "${JOBS:-$(nproc)}" | tail -n 1
cmake --install "$work/build" --prefix "$work/prefix" >/dev/null
rm -rf "$work/source" "$work/build"
# What was installed serves another machine: it names no folder of this one.
if grep -rnE "$work|/usr/(lib|include)" "$work/prefix/lib/cmake"; then
  echo "check-install: the installed package names folders of this machine" >&2
  exit 1
fi

mkdir "$work/user"
cp "$root/docs/examples/drop.cpp" "$work/user"
cat >"$work/user/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.21)
project(user LANGUAGES CXX)
find_package(selvedge 0.1 REQUIRED)
add_executable(drop drop.cpp)
target_link_libraries(drop PRIVATE selvedge::physics)
END
cmake -S "$work/user" -B "$work/user/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/user/build" | tail -n 1
"$work/user/build/drop"
rm -rf "$work"
