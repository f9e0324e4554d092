#!/usr/bin/python3
"""Writes a bag of laser robots in one long building, of which the first and the last see nothing in common.

usage: laser_bag.py OUT.bag
Topics of each robot R: /R/scan (frame R/reference, at the robot's middle), /R/ground_truth; and /tf R/odom -> R/base_link.
Each odometry starts at the robot's own start, and drifts a little.
"""
import math
import sys

import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

RANGE_M, BEAMS, VIEW_RAD, SIGMA_M = 7.0, 271, math.radians(270), 0.01
SCANS_PER_S, FORWARD_S, BACK_S = 10, 12, 9  # at 1 m/s
STARTS_M = {"a": 3.0, "b": 15.0, "c": 27.0}  # along the building, where each drives on and comes back some of the way


def building(rng):
    """Wall segments (x0, y0, x1, y1): a hall 60 m long with bays of uneven depth on both sides, and boxes."""
    walls = [(0, -4, 0, 4), (60, -4, 60, 4)]
    for side in (-1, 1):
        x, depth = 0.0, 4.0
        while x < 60:
            end = min(60, x + rng.uniform(1.2, 4.0))
            walls.append((x, side * depth, end, side * depth))
            following = rng.uniform(1.5, 4.5)
            if end < 60:
                walls.append((end, side * depth, end, side * following))
            x, depth = end, following
    for _ in range(40):
        x, y, edge = rng.uniform(1, 58), rng.choice([-1, 1]) * rng.uniform(1.2, 2.2), rng.uniform(0.3, 0.8)
        corners = [(x, y), (x + edge, y), (x + edge, y + edge), (x, y + edge)]
        walls += [(*p, *q) for p, q in zip(corners, corners[1:] + corners[:1])]
    return np.array(walls)


def ranges(walls, x, y, yaw, rng):
    angles = yaw + np.linspace(-VIEW_RAD / 2, VIEW_RAD / 2, BEAMS)
    direction = np.stack([np.cos(angles), np.sin(angles)])[:, :, None]
    start, along = walls[:, :2].T[:, None], (walls[:, 2:] - walls[:, :2]).T[:, None]
    cross = direction[0] * along[1] - direction[1] * along[0]
    to_x, to_y = start[0] - x, start[1] - y
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (to_x * along[1] - to_y * along[0]) / cross
        part = (to_x * direction[1] - to_y * direction[0]) / cross
    distance[~((part >= 0) & (part <= 1) & (distance > 0))] = np.inf
    nearest = distance.min(axis=1) + rng.normal(0, SIGMA_M, BEAMS)
    return np.where(nearest < RANGE_M, nearest, np.inf)


def transform(robot, stamp, x, y, yaw):
    t = TransformStamped()
    t.header.stamp, t.header.frame_id, t.child_frame_id = stamp, robot + "/odom", robot + "/base_link"
    t.transform.translation.x, t.transform.translation.y = x, y
    t.transform.rotation.z, t.transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return TFMessage([t])


def truth(robot, stamp, x, y, yaw):
    m = Odometry()
    m.header.stamp, m.header.frame_id, m.child_frame_id = stamp, "world", robot + "/base_link"
    m.pose.pose.position.x, m.pose.pose.position.y = x, y
    m.pose.pose.orientation.z, m.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return m


def laser(robot, stamp, values):
    m = LaserScan(angle_min=-VIEW_RAD / 2, angle_max=VIEW_RAD / 2, angle_increment=VIEW_RAD / (BEAMS - 1),
                  range_min=0.05, range_max=RANGE_M, ranges=values.tolist())
    m.header.stamp, m.header.frame_id = stamp, robot + "/reference"
    return m


def main(path):
    rng = np.random.default_rng(7)
    walls = building(rng)
    with rosbag.Bag(path, "w") as bag:
        for i in range((FORWARD_S + BACK_S) * SCANS_PER_S):
            t = i / SCANS_PER_S
            for k, (robot, start) in enumerate(STARTS_M.items()):
                stamp = rospy.Time(100 + t + 0.003 * k)
                way = t if t < FORWARD_S else 2 * FORWARD_S - t
                x, y, yaw = start + way, 0.6 * math.sin(0.9 * way + k), math.atan(0.54 * math.cos(0.9 * way + k))
                y0, yaw0 = 0.6 * math.sin(k), math.atan(0.54 * math.cos(k))
                dx, dy, drift = x - start, y - y0, 0.002 * t
                c, s = math.cos(-yaw0), math.sin(-yaw0)
                odom = (1.003 * (c * dx - s * dy), 1.003 * (s * dx + c * dy), yaw - yaw0 + drift)
                bag.write("/tf", transform(robot, stamp, *odom), stamp)
                bag.write(f"/{robot}/ground_truth", truth(robot, stamp, x, y, yaw), stamp)
                bag.write(f"/{robot}/scan", laser(robot, stamp, ranges(walls, x, y, yaw, rng)), stamp)


if __name__ == "__main__":
    main(sys.argv[1])
