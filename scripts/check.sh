#!/usr/bin/env bash
# Format, package.xml and sizes: what a reviewer should not have to look at. --install: get the checkers first.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/environment.sh

if [ "${1:-}" = "--install" ]; then
  missing=()
  for package in clang-format catkin-lint universal-ctags python3; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  if [ "${#missing[@]}" -gt 0 ]; then
    root=(); [ "$(id -u)" -eq 0 ] || root=(sudo)
    "${root[@]}" apt-get update -qq
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
  fi
fi

mapfile -t sources < <(git ls-files '*.cpp' '*.h')
echo "check: format of ${#sources[@]} files"
clang-format --dry-run --Werror "${sources[@]}"
echo "check: package.xml"
# --offline: the rosdep names of system packages cannot be looked up on a machine without a rosdep database.
# The scripts of scripts/ and test/ belong to the source tree; OpenCV and the generated messages lie outside the package.
catkin_lint --offline --strict --quiet --ignore uninstalled_script --ignore external_directory \
  --ignore external_interface_path --ignore uninstalled_target .
echo "check: sizes"
/usr/bin/python3 scripts/check_sizes.py
