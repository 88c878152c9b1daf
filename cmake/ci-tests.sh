#!/usr/bin/env bash
# Usage: cmake/ci-tests.sh minimal|asan
# The regular expression for the test files that .ci/run runs in a build besides `release`; docs/building.md says why.
set -euo pipefail
case "$1" in
  # Tests of what is compiled differently without OpenMP, SuiteSparse and FCL, and of the program as a whole.
  minimal) names="modules|rooms|main|simulate|check|obstacle|linear_solver|multigrid|implicit_euler|features|bvh|intersections|audit|resolve|path_pairs|give_way|body|garment|engine|graph_parity" ;;
  # Readers of files, geometry with indices, kernels and single steps; long runs of scenes and studies are for release.
  asan) names="audit|buried|bvh|contact|contour|coarse|crossing|disjoint|distance|engine|graph|intersect|network|obstacle|pairs|quiet|resolve|response|room|segments|surface|untangle|assembly|bending|features|implicit_euler|linear_solver|measures|membrane|multigrid|springs|stepper|body|clip|config|dress|export|garment|import|kill|main|mesh|motion|npz|outcome|pickle|remesh|setup|simulate|torch|trajectory|view|weight|architecture" ;;
  *) echo "ci-tests: no list for '$1'" >&2; exit 2 ;;
esac
echo "^test_($names)"
