#!/usr/bin/python3
"""One robot's chain under faults. The tests share the running chain and go in the order of their names."""
import copy
import os
import tempfile
import unittest

import rosbag
import rospy
from cornerstone.srv import MapFile
from nav_msgs.srv import GetMap
from std_srvs.srv import Trigger
from stereo_msgs.msg import DisparityImage
from tf2_msgs.msg import TFMessage

import chain


def rewritten(bag, path, change):
    """A copy of a bag in which change(topic, message) gives what is written; None leaves the message out."""
    with rosbag.Bag(bag) as source, rosbag.Bag(path, "w") as target:
        for topic, message, stamp in source.read_messages():
            changed = change(topic, message)
            if changed is not None:
                target.write(topic, changed, stamp)
    return path


def with_calibration(set_fields, camera="right"):
    def change(topic, message):
        if topic == f"/a/{camera}/camera_info":
            set_fields(message)
        return message
    return change


def no_calibration(info):
    info.K, info.P = [0.0] * 9, [0.0] * 12


def negative_baseline(info):
    info.P = [*info.P[:3], -info.P[3], *info.P[4:]]


def without_odometry(topic, message):
    return None if topic == "/tf" else message


def nan_odometry(topic, message):
    if topic == "/tf":
        message = copy.deepcopy(message)
        for transform in message.transforms:
            transform.transform.translation.x = float("nan")
    return message


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("faults_test")
        cls.bag, cls.rate = rospy.myargv()[1:3]
        cls.folder = tempfile.TemporaryDirectory()
        cls.recorder = chain.Recorder(dict(chain.robot_topics("a"), **{"/a/disparity": DisparityImage, "/tf": TFMessage}))
        cls.diagnostics = chain.Diagnostics()
        chain.wait_for_robots(["a"])

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def play(self, bag):
        expected = chain.connections_of(["a"])
        player = chain.Player([bag], self.rate)
        try:
            player.start(expected)
            player.wait(60)
        finally:
            player.stop()

    def play_changed(self, change):
        self.play(rewritten(self.bag, os.path.join(self.folder.name, self.id() + ".bag"), change))

    def epochs(self):
        return [tiles.map_epoch for tiles in self.recorder.of("/a/map_tiles")]

    def call(self, name, kind, *arguments):
        rospy.wait_for_service(name, 10)
        return rospy.ServiceProxy(name, kind)(*arguments)

    def occupied_cells(self):
        return sum(1 for value in self.call("/a/static_map", GetMap).map.data if value > 65)

    def test_1_time_that_jumps_back_begins_a_new_map(self):
        self.play(self.bag)
        first = self.epochs()
        self.assertEqual(len(set(first)), 1)
        mapped, _ = self.settled()
        self.play(self.bag)
        after = self.epochs()[len(first):]
        # The last report of the first time may still come; then there is one new map, which goes on growing.
        self.assertEqual(len(set(after) - set(first)), 1)
        self.assertEqual(after[-1], max(after))
        self.assertGreater(len([epoch for epoch in after if epoch == after[-1]]), 3)
        self.assertGreater(self.settled()[0], 1.5 * mapped)
        self.assertGreater(self.occupied_cells(), 50)

    def test_2_maps_are_saved_loaded_and_reset(self):
        path = os.path.join(self.folder.name, "map")
        epoch, cells = self.epochs()[-1], self.occupied_cells()
        self.assertGreater(cells, 50)
        saved = self.call("/a/save_map", MapFile, path, 0, 0, 0)
        self.assertTrue(saved.success, saved.message)
        self.assertTrue(os.path.exists(path + ".yaml") and os.path.exists(path + ".png"))
        self.assertTrue(self.call("/a/reset", Trigger).success)
        self.assertEqual(self.occupied_cells(), 0)
        loaded = self.call("/a/load_map", MapFile, path + ".yaml", 1.0, 2.0, 0.5)
        self.assertTrue(loaded.success, loaded.message)
        self.assertEqual(self.occupied_cells(), cells)
        chain.wait_until(lambda: self.epochs()[-1] > epoch, "the epoch after load_map", 10)

    def test_3_bad_requests_are_refused_with_the_name(self):
        cells = self.occupied_cells()
        for name, arguments in (("load_map", ("/nowhere/map.yaml", 0, 0, 0)), ("save_map", ("/nowhere/map", 0, 0, 0)),
                                ("load_map", (os.path.join(self.folder.name, "map"), float("nan"), 0, 0))):
            answer = self.call("/a/" + name, MapFile, *arguments)
            self.assertFalse(answer.success, name)
            self.assertTrue("/nowhere/map" in answer.message or "finite" in answer.message, answer.message)
        self.assertEqual(self.occupied_cells(), cells)

    def settled(self):
        return self.diagnostics.settled("/a/mapper", ("processed", "dropped"))

    def test_4_scans_without_odometry_are_dropped_and_counted(self):
        processed, dropped = self.settled()
        self.play_changed(without_odometry)
        # What odometry of the play before had left in tf ended with it.
        after = self.settled()
        self.assertEqual(after[0], processed)
        self.assertGreater(after[1], dropped + 20)
        causes = [key for key in self.diagnostics.of("/a/mapper") if key.startswith("dropped: ")]
        self.assertTrue(any("a/odom -> a/base_link" in cause for cause in causes), causes)

    def test_5_odometry_that_is_nan_is_no_odometry(self):
        processed, dropped = self.settled()
        self.play_changed(nan_odometry)
        after = self.settled()
        self.assertEqual(after[0], processed)
        self.assertGreater(after[1], dropped + 20)

    def complaint_about(self, set_fields):
        disparities = len(self.recorder.of("/a/disparity"))
        self.play_changed(with_calibration(set_fields))
        # One set may pass before the changed calibration arrives.
        self.assertLessEqual(len(self.recorder.of("/a/disparity")), disparities + 1)
        report = self.diagnostics.of("/a/stereo")
        self.assertEqual(report["level"], 2, report)
        return report["message"]

    def test_6_a_camera_without_calibration_is_named(self):
        self.assertIn("/a/right/camera_info", self.complaint_about(no_calibration))

    def test_7_a_negative_baseline_is_named(self):
        message = self.complaint_about(negative_baseline)
        self.assertIn("/a/right/camera_info", message)
        self.assertIn("baseline", message)

    def test_8_all_is_well_again_with_good_input(self):
        disparities = len(self.recorder.of("/a/disparity"))
        self.play(self.bag)
        self.assertGreater(len(self.recorder.of("/a/disparity")), disparities + 20)
        self.assertGreater(self.occupied_cells(), 50)
        self.assertNotEqual(self.diagnostics.of("/a/stereo")["level"], 2)


if __name__ == "__main__":
    chain.run("faults", Faults)
