# Sourced by the other scripts. Debian's own python3 must come first: another one breaks catkin's look-ups.
export PATH=/usr/bin:$PATH
# What an older shell may carry along and would mislead roslaunch.
unset ROS_NAMESPACE ROS_PACKAGE_PATH PYTHONPATH 2>/dev/null || true

use_build() { # makes the package built in build/ visible to roslaunch, rosrun and pluginlib
  set +u
  # shellcheck disable=SC1091
  source build/devel/setup.bash
  set -u
  export CORNERSTONE_BIN=$PWD/build/devel/lib/cornerstone
}
