#!/usr/bin/env bash
# Usage: cmake/run-tests.sh PRESET JOBS [CTEST ARGUMENT...]
# Runs the tests of a built preset and ends with a line that counts test cases: "N passed, N failed", with ", N skipped"
# where some were. A case that began and never ended (a crash, a time-out) counts as failed.
set -uo pipefail

preset="$1" jobs="$2"
shift 2
export SELVEDGE_TALLY="$PWD/build/$preset/tally.txt"
: >"$SELVEDGE_TALLY"

ctest --preset "$preset" --parallel "$jobs" "$@"
status=$?

sed -n 's/^skipped\t//p' "$SELVEDGE_TALLY" | sort
awk -F '\t' -v status=$status '
  { ++count[$1] }
  END {
    failed = count["began"] - count["passed"] - count["skipped"]
    if (status != 0 && failed == 0) failed = 1  # a test program that did not start
    skipped = count["skipped"] ? ", " count["skipped"] " skipped" : ""
    printf "%d passed, %d failed%s\n", count["passed"], failed, skipped
    exit (failed > 0)
  }' "$SELVEDGE_TALLY"
