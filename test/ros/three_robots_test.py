#!/usr/bin/python3
"""Three robots: the third shares the first one's frame through the second, and loses it with the second's map."""
import tempfile
import unittest

import rospy
import tf2_ros
from nav_msgs.msg import OccupancyGrid
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

import chain
from cornerstone.msg import MapRegistration, MapTiles
from cornerstone.srv import AlignMaps, MapFile

ROBOTS = ("a", "b", "c")
LARGEST_ERROR_M, LARGEST_ERROR_DEG = 0.35, 1.5  # 24 m apart, of maps made with drifting odometry over 21 m


class ThreeRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("three_robots_test")
        topics = {"/tf": TFMessage, "/a/merged_map": OccupancyGrid, "/b/map_tiles": MapTiles}
        topics.update({f"/{robot}/registration": MapRegistration for robot in ROBOTS[1:]})
        topics.update({f"/{robot}/ground_truth": chain.robot_topics(robot)[f"/{robot}/ground_truth"] for robot in ROBOTS})
        cls.recorder = chain.Recorder(topics)
        cls.tf = tf2_ros.Buffer(rospy.Duration(3600))
        cls.listener = tf2_ros.TransformListener(cls.tf)
        for robot in ROBOTS:
            for topic in ("map", "landmarks"):
                chain.wait_until(lambda t=f"/{robot}/{topic}": chain.publishers_of(t), f"/{robot}/{topic}", 60)
        player = chain.Player([rospy.myargv()[1]], 1.0)
        managers = {robot: f"/{robot}/manager" for robot in ROBOTS}
        expected = {"/tf": set(managers.values()) | {rospy.get_name()}, "/clock": set(managers.values())}
        expected.update({f"/{robot}/scan": {managers[robot]} for robot in ROBOTS})
        try:
            player.start(expected)
            player.wait(100)
        finally:
            player.stop()
        cls.last = {robot: cls.recorder.last(f"/{robot}/registration") for robot in ROBOTS[1:]}
        cls.links = chain.between_maps(cls.recorder.of("/tf"))
        cls.merged = cls.recorder.last("/a/merged_map")

    def truth_between(self, robot):
        """The robot's map frame in a's: both maps begin where their robots started, heading as they did."""
        first = {r: chain.Truth(self.recorder.of(f"/{r}/ground_truth")).poses[0] for r in ("a", robot)}
        return first["a"].inverse() * first[robot]

    def test_c_shares_the_frame_through_b(self):
        self.assertEqual(self.last["b"].state, MapRegistration.REGISTERED, self.last["b"].reason)
        self.assertEqual(self.last["b"].via, [])
        self.assertEqual(self.last["c"].state, MapRegistration.REGISTERED, self.last["c"].reason)
        self.assertEqual(self.last["c"].via, ["b"])
        self.assertEqual((self.last["c"].reference_robot, self.last["c"].reference_frame), ("a", "a/map"))
        self.assertGreater(self.last["c"].covariance[0], 0)
        self.assertEqual({(t.header.frame_id, t.child_frame_id) for t in self.links}, {("a/map", "b/map"), ("a/map", "c/map")})

    def test_every_tf_between_maps_is_right(self):
        truths = {robot: chain.Truth(self.recorder.of(f"/{robot}/ground_truth")) for robot in ROBOTS}
        for robot in ROBOTS[1:]:
            stamps = [t.header.stamp.to_sec() for t in self.links if t.child_frame_id == f"{robot}/map"]
            self.assertTrue(stamps, robot)
            errors = chain.relative_errors(self.tf, ("a", robot), (truths["a"], truths[robot]), (stamps[0] + 0.2, truths["a"].times[-1] - 0.5))
            self.assertTrue(errors, robot)
            worst_m, worst_deg = (max(values) for values in zip(*errors))
            print(f"three_robots: a to {robot}: {len(errors)} poses, at worst {worst_m:.3f} m and {worst_deg:.2f} degrees off")
            self.assertLess(worst_m, LARGEST_ERROR_M, robot)
            self.assertLess(worst_deg, LARGEST_ERROR_DEG, robot)

    def test_a_draws_all_maps_in_one(self):
        self.assertIsNotNone(self.merged)
        self.assertEqual(self.merged.header.frame_id, "a/map")
        self.assertGreater(self.merged.info.width * self.merged.info.resolution, 38)  # from behind a to where c looks

    def test_align_two_saved_maps(self):
        folder = tempfile.mkdtemp(prefix="cornerstone_")
        for robot in ("a", "b"):
            answer = rospy.ServiceProxy(f"/{robot}/save_map", MapFile)(path=f"{folder}/{robot}")
            self.assertTrue(answer.success, answer.message)
        align = rospy.ServiceProxy("/a/align", AlignMaps)
        found = align(reference=f"{folder}/a.yaml", current=f"{folder}/b.yaml")
        self.assertTrue(found.registered, found.message)
        self.assertLess(chain.Pose2(found.x, found.y, found.yaw).distance_to(self.truth_between("b")), LARGEST_ERROR_M)
        self.assertGreater(found.covariance[0], 0)
        refused = align(reference=f"{folder}/a.yaml", current=f"{folder}/none.yaml")
        self.assertFalse(refused.registered)
        self.assertIn(f"{folder}/none.yaml", refused.message)
        self.assertEqual((refused.x, refused.y, refused.yaw), (0, 0, 0))

    def test_z_without_bs_map_there_is_no_frame_at_once(self):
        """Last (z): it ends what the others look at."""
        before = {robot: len(self.recorder.of(f"/{robot}/registration")) for robot in ("b", "c")}
        self.assertTrue(rospy.ServiceProxy("/b/reset", Trigger)().success)
        for robot in ("b", "c"):
            chain.wait_until(lambda r=robot: self.recorder.last(f"/{r}/registration").state == MapRegistration.LOST,
                             f"/{robot}/registration LOST", 5)
            self.assertGreater(len(self.recorder.of(f"/{robot}/registration")), before[robot])
        chain.wait_until(lambda: not self.recorder.last("/b/map_tiles").tiles, "b's map to be empty", 5)


if __name__ == "__main__":
    chain.run("three_robots", ThreeRobots)
