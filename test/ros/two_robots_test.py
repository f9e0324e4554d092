#!/usr/bin/python3
"""Both robots play one recorded tour: maps, landmarks, registration and the tf between the maps, against the truth."""
import unittest

import rospy
import tf2_ros
from nav_msgs.srv import GetMap
from tf2_msgs.msg import TFMessage

import chain
from cornerstone.msg import MapRegistration

ROBOTS = ("a", "b")
# While they drive, up to 7 m apart in different rooms, each with what its map has drifted since its last correction.
LARGEST_ERROR_M = 0.20
LARGEST_ERROR_DEG = 2.5
# In the end, near one another; robot a is still turning.
LAST_ERROR_M = 0.10
LAST_ERROR_DEG = 1.6


def spectators_of_truth():
    return [node for robot in ROBOTS for node in chain.subscribers_of(f"/{robot}/ground_truth") if node != rospy.get_name()]


class TwoRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("two_robots_test")
        bag, rate = rospy.myargv()[1:3]
        topics = {"/tf": TFMessage, "/b/registration": MapRegistration}
        for robot in ROBOTS:
            topics.update(chain.robot_topics(robot))
        cls.recorder = chain.Recorder(topics)
        cls.diagnostics = chain.Diagnostics()
        cls.tf = tf2_ros.Buffer(rospy.Duration(3600))
        cls.listener = tf2_ros.TransformListener(cls.tf)
        chain.wait_for_robots(ROBOTS)
        cls.spectators_before = spectators_of_truth()
        player = chain.Player([bag], rate)
        try:
            player.start(chain.connections_of(ROBOTS))
            player.wait(180)
        finally:
            player.stop()
        cls.spectators_after = spectators_of_truth()
        cls.served = {robot: rospy.ServiceProxy(f"/{robot}/static_map", GetMap)().map for robot in ROBOTS}

    def registrations(self):
        return self.recorder.of("/b/registration")

    def registered_since(self):
        return next(m.header.stamp for m in self.registrations() if m.state == MapRegistration.REGISTERED)

    def test_nobody_of_the_chain_takes_the_truth(self):
        self.assertEqual(self.spectators_before + self.spectators_after, [])
        for robot in ROBOTS:
            self.assertGreater(len(self.recorder.of(f"/{robot}/ground_truth")), 1000)

    def test_registers_and_stays_registered(self):
        states = [m.state for m in self.registrations()]
        self.assertEqual(states[0], MapRegistration.NONE)
        self.assertIn(MapRegistration.REGISTERED, states)
        first = states.index(MapRegistration.REGISTERED)
        self.assertEqual(set(states[first:]), {MapRegistration.REGISTERED})

    def test_no_tf_between_the_maps_before_registration(self):
        links = chain.between_maps(self.recorder.of("/tf"))
        self.assertTrue(links)
        self.assertEqual({(t.header.frame_id, t.child_frame_id) for t in links}, {("a/map", "b/map")})
        early = [t.header.stamp for t in links if t.header.stamp < self.registered_since()]
        self.assertEqual(early, [])

    def test_tf_agrees_with_the_truth_wherever_robot_b_is(self):
        truths = [chain.Truth(self.recorder.of(f"/{robot}/ground_truth")) for robot in ROBOTS]
        errors = chain.relative_errors(self.tf, ROBOTS, truths,
                                       (self.registered_since().to_sec() + 0.5, truths[0].times[-1] - 0.5))
        self.assertGreaterEqual(len(errors), 5)
        worst_m, worst_deg = (max(values) for values in zip(*errors))
        last_m, last_deg = errors[-1]
        print(f"two_robots: {len(errors)} poses, at worst {worst_m:.3f} m and {worst_deg:.2f} degrees from the truth, "
              f"{last_m:.3f} m and {last_deg:.2f} degrees in the end")
        self.assertLess(last_m, LAST_ERROR_M)
        self.assertLess(last_deg, LAST_ERROR_DEG)
        self.assertLess(worst_m, LARGEST_ERROR_M)
        self.assertLess(worst_deg, LARGEST_ERROR_DEG)

    def test_registration_message_is_the_tf(self):
        last = self.registrations()[-1]
        self.assertEqual((last.reference_robot, last.current_robot), ("a", "b"))
        self.assertEqual((last.reference_frame, last.current_frame, last.header.frame_id), ("a/map", "b/map", "a/map"))
        told = chain.Pose2(last.x, last.y, last.yaw)
        # The newest message and the newest tf may be one attempt apart.
        newest = chain.between_maps(self.recorder.of("/tf"))[-1]
        published = chain.pose_of_transform(newest.transform)
        self.assertLess(told.distance_to(published), 0.05)
        self.assertLess(told.angle_to_deg(published), 0.5)
        self.assertGreater(min(last.covariance[0], last.covariance[4], last.covariance[8]), 0)
        self.assertEqual(len(last.reference_corners), len(last.current_corners))
        self.assertEqual(last.matched, len(last.current_corners))
        self.assertLess(last.second_best, 1)
        for robot, epoch in (("a", last.reference_epoch), ("b", last.current_epoch)):
            self.assertEqual(epoch, self.recorder.last(f"/{robot}/map_tiles").map_epoch)
        for reference, current in zip(last.reference_corners, last.current_corners):
            moved = told * chain.Pose2(current.x, current.y, current.yaw)
            self.assertLess(moved.distance_to(chain.Pose2(reference.x, reference.y, 0)), 1.0)

    def test_landmarks(self):
        for robot in ROBOTS:
            last = self.recorder.last(f"/{robot}/landmarks")
            self.assertEqual((last.header.frame_id, last.robot), (f"{robot}/map", robot))
            self.assertGreaterEqual(len(last.corners), 4)
            for corner in last.corners:
                self.assertGreater(corner.covariance[0], 0)
                self.assertLess(corner.rms, 0.1)

    def test_map_and_tiles(self):
        for robot in ROBOTS:
            newest = self.recorder.last(f"/{robot}/map")
            self.assertEqual(newest.header.frame_id, f"{robot}/map")
            metadata = self.recorder.last(f"/{robot}/map_metadata")
            self.assertEqual((metadata.width, metadata.height), (newest.info.width, newest.info.height))
            self.assertTrue(self.recorder.of(f"/{robot}/map_updates"))
            tiles = self.recorder.of(f"/{robot}/map_tiles")
            self.assertEqual({(t.header.frame_id, t.robot) for t in tiles}, {(f"{robot}/map", robot)})
            self.assertEqual(len({t.map_epoch for t in tiles}), 1)
            self.assertTrue(all(a.version <= b.version for a, b in zip(tiles, tiles[1:])))
            self.assertTrue(any(t.tiles for t in tiles))

    def test_static_map_has_free_and_occupied_cells(self):
        for robot, served in self.served.items():
            self.assertEqual(served.header.frame_id, f"{robot}/map")
            self.assertEqual(len(served.data), served.info.width * served.info.height)
            cell_m2 = served.info.resolution ** 2
            self.assertGreater(sum(1 for v in served.data if 0 <= v < 20) * cell_m2, 20)
            self.assertGreater(sum(1 for v in served.data if v > 65) * cell_m2, 1)

    def test_stereo_scan(self):
        for robot in ROBOTS:
            scan = self.recorder.last(f"/{robot}/stereo_scan")
            self.assertEqual(scan.header.frame_id, f"{robot}/base_link")
            answers = [r for r in scan.ranges if r == r]
            self.assertTrue(answers)
            self.assertTrue(all(scan.range_min <= r <= scan.range_max for r in answers))

    def test_every_image_was_mapped_and_none_dropped(self):
        images = round((self.recorder.of("/a/ground_truth")[-1].header.stamp
                        - self.recorder.of("/a/ground_truth")[0].header.stamp).to_sec() * 10)
        for robot in ROBOTS:
            for stage in ("stereo", "mapper", "registration"):
                processed, dropped = self.diagnostics.settled(f"/{robot}/{stage}", ("processed", "dropped"))
                self.assertEqual(dropped, 0, f"{robot}/{stage}: {self.diagnostics.of(f'/{robot}/{stage}')}")
                if stage != "registration":
                    self.assertGreaterEqual(processed, images - 2, f"{robot}/{stage}")


if __name__ == "__main__":
    chain.run("two_robots", TwoRobots)
