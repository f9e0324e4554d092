#!/usr/bin/env bash
# Installs every dependency from Debian 12 and builds into build/ (Release). It can be run again at any time.
#
# usage: scripts/setup.sh [FILE]...   FILE: more packages, listed as in scripts/packages.txt
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/environment.sh

as_root() { if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi; }

missing() { # the packages of these files that are not installed
  local wanted
  wanted=$(sed 's/#.*//' "$@" | tr -s '[:space:]' '\n' | sed '/^$/d')
  comm -23 <(echo "$wanted" | sort -u) \
    <(dpkg-query -W -f '${binary:Package} ${db:Status-Status}\n' | awk '$2=="installed" {sub(":.*", "", $1); print $1}' | sort -u)
}

packages=$(missing scripts/packages.txt "$@")
if [ -n "$packages" ]; then
  echo "setup: installing $(echo "$packages" | wc -l) Debian packages"
  export DEBIAN_FRONTEND=noninteractive
  as_root apt-get update -qq
  # shellcheck disable=SC2086
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $packages >/dev/null
fi

cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build
