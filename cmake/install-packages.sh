#!/usr/bin/env bash
# Usage: cmake/install-packages.sh PURPOSE...
# Installs what is missing of the packages that packages-debian.txt lists for these purposes. Asks nothing, and touches
# apt only when something is missing. Elsewhere than on Debian it leaves the matter to CMake, which names what it misses.
set -euo pipefail

list="$(dirname "$0")/packages-debian.txt"
command -v dpkg-query >/dev/null || exit 0

wanted=()
for purpose in "$@"; do
  mapfile -t found < <(awk -v purpose="$purpose" '$1 == purpose { for (i = 2; i <= NF; ++i) print $i }' "$list")
  if ((${#found[@]} == 0)); then
    echo "install-packages: no purpose '$purpose' in $list" >&2
    exit 2
  fi
  wanted+=("${found[@]}")
done

missing=()
for package in "${wanted[@]}"; do
  status="$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)"
  [[ "$status" == installed ]] || missing+=("$package")
done
((${#missing[@]})) || exit 0

as_root=()
if [[ "$(id -u)" != 0 ]]; then
  if ! sudo -n true 2>/dev/null; then
    echo "install-packages: these packages are missing and neither root nor sudo without a password is at hand: run" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo -n)
fi

apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 -q "$@" </dev/null
}
echo "Installing ${missing[*]}"
apt update || echo "install-packages: apt-get update failed; trying with the lists that are here" >&2
apt install -y --no-install-recommends "${missing[@]}"
