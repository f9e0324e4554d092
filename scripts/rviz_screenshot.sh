#!/usr/bin/env bash
# Shows the running robots in rviz on a virtual display and takes its picture. usage: rviz_screenshot.sh OUT.png
set -euo pipefail
out=${1:?usage: rviz_screenshot.sh OUT.png}
command -v Xvfb >/dev/null && command -v import >/dev/null || exit 1

display=:$((90 + $$ % 900))
Xvfb "$display" -screen 0 1400x900x24 -nolisten tcp >/dev/null 2>&1 &
xvfb=$!
trap 'kill $rviz $xvfb 2>/dev/null || true' EXIT
rviz=
sleep 1
export DISPLAY=$display LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1
rviz -d "$(dirname "${BASH_SOURCE[0]}")/../rviz/cornerstone.rviz" >/dev/null 2>&1 &
rviz=$!
sleep "${RVIZ_SECONDS:-12}" # software rendering needs some seconds to show every display
kill -0 "$rviz" 2>/dev/null
import -window root "$out"
