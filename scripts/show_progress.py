#!/usr/bin/python3
"""Shows how a demo run goes: time, mapped area and corners of each robot, state of the registration. Ends with the run.

usage: show_progress.py ROBOT ROBOT... [--timeout-s S]     exit 0: the routes were driven to their end, 1: time is up
"""
import argparse
import sys
import time

import rospy
from cornerstone.msg import CornerArray, MapRegistration
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from std_msgs.msg import Bool

STATES = {getattr(MapRegistration, name): name for name in ("NONE", "CANDIDATE", "REGISTERED", "LOST")}
PERIOD_S = 5


class Progress:
    def __init__(self, robots):
        self.grids = {}
        self.corners = {}
        self.registrations = {}
        self.done = False
        self.start_s = None
        rospy.Subscriber("/simulation_done", Bool, self.take_done)
        for robot in robots:
            rospy.Subscriber(f"/{robot}/map", OccupancyGrid, self.take_map, robot)
            rospy.Subscriber(f"/{robot}/map_updates", OccupancyGridUpdate, self.take_update, robot)
            rospy.Subscriber(f"/{robot}/landmarks", CornerArray, self.take_corners, robot)
            rospy.Subscriber(f"/{robot}/registration", MapRegistration, self.take_registration, robot)

    def take_done(self, message):
        self.done = message.data

    def take_map(self, grid, robot):
        self.grids[robot] = grid
        grid.data = list(grid.data)

    def take_update(self, update, robot):
        grid = self.grids.get(robot)
        if grid is None:
            return
        for row in range(update.height):
            start = (update.y + row) * grid.info.width + update.x
            grid.data[start:start + update.width] = update.data[row * update.width:(row + 1) * update.width]

    def take_corners(self, message, robot):
        self.corners[robot] = len(message.corners)

    def take_registration(self, message, robot):
        self.registrations[robot] = message

    def line(self):
        if self.start_s is None and rospy.get_time() > 0:
            self.start_s = rospy.get_time()
        parts = [f"{rospy.get_time() - (self.start_s or 0):5.1f} s"]
        for robot, grid in sorted(self.grids.items()):
            area = sum(1 for cell in grid.data if cell >= 0) * grid.info.resolution ** 2
            parts.append(f"{robot}: {area:5.1f} m2, {self.corners.get(robot, 0):2d} corners")
        for robot, registration in sorted(self.registrations.items()):
            text = f"{robot} in {registration.reference_robot}: {STATES.get(registration.state, '?')}"
            if registration.state == MapRegistration.REGISTERED:
                text += f" ({registration.x:.2f} m, {registration.y:.2f} m, {registration.yaw * 57.29578:.1f} deg)"
            parts.append(text)
        return " | ".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="+")
    parser.add_argument("--timeout-s", type=float, default=120)
    options = parser.parse_args()
    rospy.init_node("show_progress", anonymous=True, disable_signals=True)
    progress = Progress(options.robots)
    end = time.monotonic() + options.timeout_s
    shown = 0.0
    while time.monotonic() < end and not rospy.is_shutdown():
        if progress.done or time.monotonic() - shown >= PERIOD_S:
            shown = time.monotonic()
            print(progress.line(), flush=True)
        if progress.done:
            time.sleep(3)  # the maps of the last images and one more attempt to register
            print(progress.line(), flush=True)
            return 0
        time.sleep(0.2)
    return 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(1)
