#!/usr/bin/python3
"""A real laser's log: no scan is lost, and the walls are thin and straight."""
import unittest

import numpy
import rospy
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from tf2_msgs.msg import TFMessage

import chain
from chain import Pose2
from room import SeenMap, followed

RADIUS_M, LEAST_CELLS = 0.5, 8


def straight_share(x, y):
    """Of the occupied cells: those whose neighbourhood is a line, thinner than 0.05 m (one cell) in standard deviation."""
    straight = []
    for i in range(0, len(x), 5):
        near = numpy.hypot(x - x[i], y - y[i]) <= RADIUS_M
        if near.sum() >= LEAST_CELLS:
            straight.append(numpy.linalg.eigvalsh(numpy.cov(x[near], y[near]))[0] < 0.05 ** 2)
    return numpy.mean(straight)


class LaserLog(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("laser_log_test")
        bag, rate = rospy.myargv()[1:3]
        cls.diagnostics = chain.Diagnostics()
        cls.recorder = chain.Recorder({"/a/map": OccupancyGrid, "/a/map_updates": OccupancyGridUpdate, "/tf": TFMessage})
        chain.wait_until(lambda: chain.publishers_of("/a/map"), "the mapper", 60)
        player = chain.Player([bag], rate)
        try:
            player.start({"/tf": {"/a/manager", rospy.get_name()}, "/clock": {"/a/manager"}, "/a/scan": {"/a/manager"}})
            player.wait(200)
        finally:
            player.stop()

    def test_no_scan_is_lost(self):
        processed, dropped = self.diagnostics.settled("/a/mapper", ("processed", "dropped"))
        self.assertGreaterEqual(processed, 220)  # of 225; the first wait for odometry
        self.assertLessEqual(dropped, 2)

    def test_walls_are_straight(self):
        grid = followed(self.recorder.of("/a/map"), self.recorder.of("/a/map_updates"))
        seen = SeenMap(grid, Pose2(0, 0, 0))
        self.assertGreater(seen.count(), 2000)
        # Cars and trees are not straight. With camera robots' trust in odometry the map bends: 0.34.
        self.assertGreater(straight_share(seen.x[seen.occupied], seen.y[seen.occupied]), 0.45)


if __name__ == "__main__":
    chain.run("laser_log", LaserLog)
