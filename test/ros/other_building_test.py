#!/usr/bin/python3
"""Two robots in two buildings, played together: both map, and nothing ever joins their maps."""
import unittest

import rospy
from nav_msgs.srv import GetMap
from tf2_msgs.msg import TFMessage

import chain
from cornerstone.msg import MapRegistration

ROBOTS = ("a", "b")


class OtherBuilding(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("other_building_test")
        *bags, rate = rospy.myargv()[1:4]
        topics = {"/tf": TFMessage, "/b/registration": MapRegistration}
        for robot in ROBOTS:
            topics.update(chain.robot_topics(robot))
        cls.recorder = chain.Recorder(topics)
        chain.wait_for_robots(ROBOTS)
        player = chain.Player(bags, rate)
        try:
            player.start(chain.connections_of(ROBOTS))
            player.wait(180)
        finally:
            player.stop()
        cls.served = {robot: rospy.ServiceProxy(f"/{robot}/static_map", GetMap)().map for robot in ROBOTS}

    def test_both_robots_map(self):
        for robot, served in self.served.items():
            cell_m2 = served.info.resolution ** 2
            self.assertGreater(sum(1 for v in served.data if 0 <= v < 20) * cell_m2, 10, robot)
            self.assertGreater(sum(1 for v in served.data if v > 65) * cell_m2, 0.5, robot)
            self.assertTrue(self.recorder.last(f"/{robot}/landmarks").corners, robot)

    def test_never_registered(self):
        messages = self.recorder.of("/b/registration")
        # Both maps were there to be compared for most of the recording.
        self.assertGreater(len([m for m in messages if m.reference_epoch and m.current_epoch]), 10)
        self.assertNotIn(MapRegistration.REGISTERED, {m.state for m in messages})

    def test_a_refusal_has_a_reason_and_no_pose(self):
        nothing = [m for m in self.recorder.of("/b/registration") if m.state == MapRegistration.NONE]
        self.assertTrue(nothing)
        self.assertTrue(nothing[-1].reason)
        self.assertEqual({(m.x, m.y, m.yaw, m.matched) for m in nothing}, {(0, 0, 0, 0)})

    def test_never_a_tf_between_the_maps(self):
        tf = self.recorder.of("/tf")
        for robot in ROBOTS:
            self.assertTrue(any(t.child_frame_id == f"{robot}/odom" for m in tf for t in m.transforms), robot)
        self.assertEqual(chain.between_maps(tf), [])


if __name__ == "__main__":
    chain.run("other_building", OtherBuilding)
