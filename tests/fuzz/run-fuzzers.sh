#!/usr/bin/env bash
# Usage: tests/fuzz/run-fuzzers.sh SECONDS [FORMAT...]
# Runs each fuzzer of build/fuzz for that long over its corpus, and ends with a line a format: inputs tried, and "failed"
# where one crashed, took over 10 s or over 2 GiB. What failed is left in out/fuzz/FORMAT-*. What is found on the way stays in
# out/fuzz/FORMAT, which the next run begins with.
set -uo pipefail

seconds="$1"
shift
formats=("$@")
((${#formats[@]})) || formats=(obj ply bvh yaml npz trajectory checkpoint body garment weights stage scales drapes
  torch pattern rig gltf ccd)
failed=0
for format in "${formats[@]}"; do
  found="out/fuzz/$format"
  mkdir -p "$found"
  log="out/fuzz/$format.log"
  build/fuzz/fuzz_"$format" "$found" tests/fuzz/corpus/"$format" -max_total_time="$seconds" -timeout=10 \
    -rss_limit_mb=2048 -malloc_limit_mb=2048 -max_len=4096 -artifact_prefix="$found-" -print_final_stats=1 >"$log" 2>&1
  status=$?
  inputs="$(awk '/stat::number_of_executed_units/ { print $2 }' "$log")"
  if ((status)); then
    failed=1
    tail -n 40 "$log"
  fi
  echo "fuzz $format: ${inputs:-?} inputs$( ((status)) && echo ", failed: see $log")"
done
exit "$failed"
