#!/usr/bin/python3
"""Two levels from one recording: both maps show walls, at the same places."""
import unittest

import numpy
import rospy
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid, Odometry
from tf2_msgs.msg import TFMessage

import chain
from chain import Pose2
from cornerstone.msg import MapTiles
from room import SeenMap, followed

IDENTITY = Pose2(0, 0, 0)


class Levels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("levels_test")
        bag, rate = rospy.myargv()[1:3]
        cls.diagnostics = chain.Diagnostics()
        # What the player waits for, too: all that robot a's bag has for this node.
        topics = {"/a/map_tiles/ceiling": MapTiles, "/tf": TFMessage, "/a/ground_truth": Odometry}
        for name in ("map", "map/obstacles", "map/ceiling"):
            topics.update({f"/a/{name}": OccupancyGrid, f"/a/{name}_updates": OccupancyGridUpdate})
        cls.recorder = chain.Recorder(topics)
        chain.wait_for_robots(["a"])
        player = chain.Player([bag], rate)
        try:
            player.start(chain.connections_of(["a"]))
            player.wait(60)
        finally:
            player.stop()

    def seen(self, topic):
        grid = followed(self.recorder.of(topic), self.recorder.of(topic + "_updates"))
        return SeenMap(grid, IDENTITY)

    def test_the_first_level_is_map_and_map_obstacles(self):
        first, again = self.seen("/a/map"), self.seen("/a/map/obstacles")
        self.assertGreater(first.count(), 100)
        self.assertTrue((first.occupied == again.occupied).all())
        self.assertEqual(self.diagnostics.settled("/a/mapper", ("dropped",)), [0])

    def test_the_walls_near_the_ceiling_stand_where_those_below_do(self):
        below, above = self.seen("/a/map"), self.seen("/a/map/ceiling")
        self.assertGreater(above.count(), 50)
        x, y = below.x[below.occupied], below.y[below.occupied]
        near = [numpy.hypot(x - cx, y - cy).min() <= 0.15 for cx, cy in zip(above.x[above.occupied], above.y[above.occupied])]
        self.assertGreater(numpy.mean(near), 0.8)

    def test_its_tiles_go_out_for_other_robots(self):
        tiles = self.recorder.of("/a/map_tiles/ceiling")
        self.assertTrue(tiles and tiles[0].complete)
        # With them goes where the robot has been, to what its map is off by.
        truth = chain.Truth(self.recorder.of("/a/ground_truth")).poses
        told = [truth[0] * Pose2(place.x, place.y, 0) for place in tiles[-1].way]
        self.assertTrue(told)
        self.assertLess(max(min(place.distance_to(pose) for pose in truth) for place in told), 0.3)
        self.assertLess(max(min(place.distance_to(pose) for place in told) for pose in truth), 0.6)


if __name__ == "__main__":
    chain.run("levels", Levels)
