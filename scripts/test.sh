#!/usr/bin/env bash
# Installs what is needed, builds, and runs every test; the last line is "N passed, N failed".
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/environment.sh
scripts/setup.sh scripts/test_packages.txt
use_build

report=build/test_report.txt
# One test at a time: those that play bags need the processor to themselves.
ctest --test-dir build --output-on-failure --timeout 300 "$@" 2>&1 | tee "$report" || true
total=$(sed -n 's/.* tests failed out of \([0-9]*\)$/\1/p' "$report")
failed=$(sed -n 's/.*, \([0-9]*\) tests failed out of [0-9]*$/\1/p' "$report")
skipped=$(grep -cE '\*\*\*Skipped' "$report" || true)
if [ -z "$total" ] || [ "$total" -eq 0 ]; then
  echo "test: no test ran"
  echo "0 passed, 1 failed"
  exit 1
fi
echo "$((total - failed - skipped)) passed, $failed failed$([ "$skipped" -eq 0 ] || echo ", $skipped skipped")"
[ "$failed" -eq 0 ]
