#!/usr/bin/env bash
# Usage: cmake/try-dockerfile.sh FOLDER
# Runs the commands of Dockerfile in an empty Debian folder made by debootstrap, then the program in it on a scene of
# one sheet. Needs root, debootstrap and Debian's package index. CACHE names a compile cache to copy in (ccache's folder).
# What stays is FOLDER, to look into; a mount of this machine's /proc is removed.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
mkdir -p "$1"
work="$(cd "$1" && pwd)"
[[ -z "$(ls -A "$work")" ]] || { echo "try-dockerfile: $work is not empty" >&2; exit 2; }

suite=bookworm  # debian:12
debootstrap --variant=minbase "$suite" "$work" http://deb.debian.org/debian >"$work.log"
# What this machine needs to reach its package index.
cp -r /etc/apt/apt.conf.d /etc/apt/sources.list.d "$work/etc/apt/" 2>/dev/null || true
cp /etc/resolv.conf /etc/hosts "$work/etc/" 2>/dev/null || true
trap 'umount "$work/proc" "$work/dev" 2>/dev/null || true' EXIT
mount --bind /proc "$work/proc"
mount --bind /dev "$work/dev"

inside=(env -i PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin HOME=/root DEBIAN_FRONTEND=noninteractive)
for name in http_proxy https_proxy no_proxy; do [[ -z "${!name:-}" ]] || inside+=("$name=${!name}"); done
if [[ -n "${CACHE:-}" ]]; then
  chroot "$work" "${inside[@]}" sh -c 'apt-get -q update && apt-get -q install --yes --no-install-recommends ccache' \
    >>"$work.log"
  mkdir -p "$work/root/.cache"
  cp -r "$CACHE" "$work/root/.cache/ccache"
  inside+=(CI=true ${LANG:+LANG=$LANG}  # which ccache counts among what an object depends on
    CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_NOHASHDIR=1
    CCACHE_BASEDIR=/selvedge CCACHE_SLOPPINESS=pch_defines,time_macros)
fi

while read -r word rest; do
  case "$word" in
    RUN) echo "== $rest"; chroot "$work" "${inside[@]}" sh -ec "$rest" >>"$work.log" 2>&1 ||
      { tail -n 20 "$work.log"; echo "try-dockerfile: failed: $rest" >&2; exit 1; } ;;
    COPY)
      [[ "$rest" == ". /selvedge" ]] || { echo "try-dockerfile: COPY of something else: $rest" >&2; exit 2; }
      mkdir -p "$work/selvedge"
      git -C "$root" ls-files -z | tar -C "$root" --null --files-from=- -cf - | tar -C "$work/selvedge" -xf - ;;
    WORKDIR) mkdir -p "$work$rest" ;;
  esac
done <"$root/Dockerfile"

cat >"$work/work/sheet.yaml" <<'END'
description: A sheet falls onto a floor.
run: {frames: 10}
cloths:
  - rectangle: {size: [0.4, 0.4], resolution: 10}
    translate: [0, 0.1, 0]
obstacles:
  - name: floor
    plane: {size: [2, 2], edge: 0.5}
END
rm -rf "$work/selvedge"  # nothing of the source is needed any more
chroot "$work" "${inside[@]}" sh -ec 'cd /work && selvedge simulate sheet.yaml --out out'
