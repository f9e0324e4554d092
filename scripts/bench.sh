#!/usr/bin/env bash
# Measures cornerstone beside its peers (OpenCV's stereo, MRPT's insertion and aligner) and rewrites bench/RESULTS.md.
# One thread; some minutes. scripts/bench.sh [SEEDS]: of the two robots that meet (default 2, 20 takes hours). The build folder is left as it was, without the benchmark program.
set -euo pipefail
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
  echo "- Data: the package's simulator (\`worlds/*.yaml\`, seed 1) and \`/usr/share/mrpt/datasets\` (package mrpt-common)"
}
head_lines >"$report"
"$(find build/devel -type f -name cornerstone_bench | head -n 1)" "${1:-2}" >>"$report"
cat bench/what_they_do_not_say.md >>"$report"
cp "$report" bench/RESULTS.md
cat bench/RESULTS.md
