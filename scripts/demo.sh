#!/usr/bin/env bash
# Two simulated camera robots start at different places of an unknown office and learn where they are relative to one
# another. Needs no display. Pictures and the recorded run go to results/demo/; the last line is one JSON object.
#
# usage: scripts/demo.sh [--seed N] [--rviz] [--out FOLDER]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/environment.sh

seed=1 rviz=false out=results/demo
while [ $# -gt 0 ]; do
  case "$1" in
    --seed) seed=${2:?--seed needs a number}; shift 2 ;;
    --rviz) rviz=true; shift ;;
    --out) out=${2:?--out needs a folder}; shift 2 ;;
    *) echo "demo: unknown argument $1" >&2; sed -n '5p' "$0" >&2; exit 2 ;;
  esac
done

scripts/setup.sh
use_build
mkdir -p "$out"
out=$(realpath "$out")
rm -f "$out"/run.bag "$out"/run.bag.active "$out"/*.png

# A roscore of our own, so that one that runs already is left alone.
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://localhost:$port ROS_HOSTNAME=localhost ROS_LOG_DIR=$out/log
roslaunch --port "$port" cornerstone demo.launch "seed:=$seed" "rviz:=$rviz" "bag:=$out/run.bag" >"$out/roslaunch.log" 2>&1 &
launch=$!
finish() { # the recorder closes its bag when roslaunch ends
  kill -INT "$launch" 2>/dev/null || true
  wait "$launch" 2>/dev/null || true
}
trap finish EXIT

until rosparam get /use_sim_time >/dev/null 2>&1; do # the progress is told in simulated time
  kill -0 "$launch" 2>/dev/null || { echo "demo: roslaunch has failed; see $out/roslaunch.log" >&2; exit 1; }
  sleep 0.2
done
echo "demo: two robots drive through an office, odometry drifting (seed $seed)"
scripts/show_progress.py a b --timeout-s 150 || { echo "demo: the run did not end; see $out/roslaunch.log" >&2; exit 1; }
scripts/rviz_screenshot.sh "$out/rviz.png" || echo "demo: no rviz picture"
trap - EXIT
finish

"$CORNERSTONE_BIN/draw_run" "$out" --out "$out" >/dev/null
ls "$out"/*.png
"$CORNERSTONE_BIN/evaluate_run" "$out" || [ $? -eq 3 ] # 3: not registered, which the JSON says
