#!/usr/bin/env bash
# Measures cornerstone beside its peers (OpenCV's stereo, MRPT's insertion and aligner) and rewrites bench/RESULTS.md.
# One thread; some minutes. The build folder is left as it was, without the benchmark program.
#
# usage: scripts/bench.sh [--seeds N] [--tours N] [--stereo-sets FOLDER...]   seeds: runs a world of the robots that meet
# (1; 20 take an hour or more); tours: seeds a world of the long tours (none; 5 take twenty minutes); FOLDER: images of two
# or three cameras with true disparity, with reference.png, right.png, perhaps top.png, disparity.png (256 x px, 0 unknown)
# and visible.png (seen by all cameras)
set -euo pipefail
sets=()
seeds=1
tours=0
if [ "${1:-}" = "--seeds" ] && [ $# -gt 1 ]; then
  seeds=$2
  shift 2
fi
if [ "${1:-}" = "--tours" ] && [ $# -gt 1 ]; then
  tours=$2
  shift 2
fi
if [ $# -gt 0 ]; then
  if [ "$1" != "--stereo-sets" ] || [ $# -lt 2 ]; then sed -n '5,8p' "$0" >&2; exit 2; fi
  for folder in "${@:2}"; do
    [ -f "$folder/disparity.png" ] || { echo "bench: $folder: no disparity.png" >&2; exit 2; }
    sets+=("$(realpath "$folder")")
  done
  sets=(--stereo-sets "${sets[@]}")
fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh
source scripts/environment.sh

restore() { cmake -S . -B build -DBUILD_BENCHMARKS=OFF >/dev/null; }
trap restore EXIT
cmake -S . -B build -DBUILD_BENCHMARKS=ON >/dev/null
cmake --build build --target cornerstone_bench

report=$(mktemp)
trap 'rm -f "$report"; restore' EXIT
version() { dpkg-query -W -f '${Version}' "$1" 2>/dev/null || echo unknown; }
commit() { # results themselves do not make a commit a changed one
  local changed=""
  git diff --quiet HEAD -- . ':!bench/RESULTS.md' 2>/dev/null || changed=" with changes"
  echo "$(git rev-parse --short HEAD 2>/dev/null || echo unknown)$changed"
}
head_lines() {
  echo "These figures were made by \`scripts/bench.sh\` on $(date -u '+%Y-%m-%d %H:%M UTC'); it overwrites this file."
  echo
  echo "# Benchmarks"
  echo
  echo "- Command: \`scripts/bench.sh\`; one thread (\`cv::setNumThreads(1)\`), methods take turns, medians."
  echo "- Commit: $(commit)"
  echo "- Machine: $(nproc) cores, $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1), $(uname -m);" \
    "load before the start: $(cut -d ' ' -f 1 /proc/loadavg)"
  echo "- Compiler: $(c++ --version | head -n 1), Release; OpenCV $(version libopencv-dev), MRPT $(version libmrpt-maps-dev)"
  [ ${#sets[@]} -eq 0 ] || echo "- Image sets: $(basename -a "${sets[@]:1}" | paste -sd ' ')"
  echo "- Data: the package's simulator (\`worlds/*.yaml\`) and \`/usr/share/mrpt/datasets\` (package mrpt-common)"
}
head_lines >"$report"
bench=$(find build/devel -type f -name cornerstone_bench | head -n 1)
"$bench" --seeds "$seeds" "${sets[@]}" >>"$report"
[ "$tours" -eq 0 ] || "$bench" --tours "$tours" >>"$report"
cat bench/what_they_do_not_say.md >>"$report"
cp "$report" bench/RESULTS.md
cat bench/RESULTS.md
