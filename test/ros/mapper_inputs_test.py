#!/usr/bin/python3
"""Depth cameras and lasers through the mapper, levels, tilt, saved maps, and stamps gone wrong.

Every test starts a mapper of its own and lets simulated time run as it needs it: what reaches the mapper, and when, is exact.
"""
import math
import os
import tempfile
import time
import unittest

import numpy
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap
from map_msgs.msg import OccupancyGridUpdate
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image, LaserScan
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

import chain
from chain import Pose2
from cornerstone.msg import MapTiles
from cornerstone.srv import MapFile
from programs import Node, load_parameters, parameters_of, rotation
from room import CAMERA_HEIGHT_M, FOCAL_PX, HEIGHT, LASER_FORWARD_M, WIDTH, Room, SeenMap, circle, tilted

BEARINGS = numpy.radians(numpy.arange(-135, 135, 0.75))
PERIOD_S = 0.1
STAGE = "/a/occupancy_mapper"


def time_of(seconds):
    """The same stamp for the same tenth of a second, however it was added up."""
    return rospy.Time.from_sec(round(seconds, 3))


def transform(parent, child, xyz, q, stamp=None):
    message = TransformStamped()
    message.header.frame_id, message.child_frame_id = parent, child
    message.header.stamp = stamp or rospy.Time()
    t, r = message.transform.translation, message.transform.rotation
    t.x, t.y, t.z = xyz
    r.x, r.y, r.z, r.w = q
    return message


def laser_of(room, pose):
    message = LaserScan(angle_min=BEARINGS[0], angle_max=BEARINGS[-1], angle_increment=BEARINGS[1] - BEARINGS[0], range_min=0.05, range_max=10)
    message.ranges = room.laser_ranges(pose, BEARINGS).tolist()
    message.header.frame_id = "a/laser"
    return message


def depth_of(room, pose, pitch=0.0, encoding="32FC1", height=CAMERA_HEIGHT_M):
    depth = room.depth_image(pose, pitch, height)
    pixels = depth.astype(numpy.float32) if encoding == "32FC1" else numpy.rint(1000 * depth).astype(numpy.uint16)
    message = Image(width=WIDTH, height=HEIGHT, encoding=encoding, step=WIDTH * pixels.itemsize, data=pixels.tobytes())
    message.header.frame_id = "a/reference_optical"
    return message


def calibration():
    info = CameraInfo(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob")
    cx, cy = (WIDTH - 1) / 2, (HEIGHT - 1) / 2
    info.K = [FOCAL_PX, 0, cx, 0, FOCAL_PX, cy, 0, 0, 1]
    info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    info.P = [FOCAL_PX, 0, cx, 0, 0, FOCAL_PX, cy, 0, 0, 0, 1, 0]
    return info


class MapperInputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("mapper_inputs_test")
        cls.programs = rospy.myargv()[1]
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=1)
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=100)
        cls.diagnostics = chain.Diagnostics()
        cls.static = tf2_ros.StaticTransformBroadcaster()
        cls.static.sendTransform([
            transform("a/base_link", "a/reference_optical", (0, 0, CAMERA_HEIGHT_M), rotation(-math.pi / 2, 0, -math.pi / 2)),
            transform("a/base_link", "a/mast_optical", (0, 0, 1.0), rotation(-math.pi / 2, 0, -math.pi / 2)),
            transform("a/base_link", "a/laser", (LASER_FORWARD_M, 0, 0.3), (0, 0, 0, 1))])
        cls.room = Room()
        cls.scans = chain.Recorder({"/a/stereo_scan": LaserScan})  # one for each look that was mapped

    def start(self, sensor, **changes):
        load_parameters("mapper", STAGE, robot="a", input=sensor, **changes)
        self.node = Node(f"{self.programs}/occupancy_mapper_node", "__ns:=/a")
        self.addCleanup(self.stop)
        self.diagnostics.newest.pop(STAGE, None)
        kinds = {"depth": Image, "scan": LaserScan}
        self.out = rospy.Publisher(f"/a/{sensor}", kinds[sensor], queue_size=50)
        chain.wait_until(self.out.get_num_connections, f"a subscriber of /a/{sensor}", 20)
        if sensor == "depth":
            info = rospy.Publisher("/a/camera_info", CameraInfo, queue_size=1, latch=True)
            info.publish(calibration())
            self.addCleanup(info.unregister)
            chain.wait_until(info.get_num_connections, "a subscriber of /a/camera_info", 20)
        for publisher in (self.clock, self.tf):
            chain.wait_until(lambda p=publisher: STAGE in chain.connected(rospy.get_name(), p.name), publisher.name, 20)
        self.now_s = 1000.0
        self.tick(0)
        time.sleep(0.2)
        self.sent, self.before = 0, len(self.scans.of("/a/stereo_scan"))
        chain.wait_until(lambda: STAGE in chain.publishers_of("/a/stereo_scan") and chain.connected(STAGE, "/a/stereo_scan"), "stereo_scan", 20)

    def stop(self):
        """Exit code. The next mapper has the same name: nothing may be connected to this one any more."""
        code = self.node.stop()
        self.out.unregister()
        for topic in ("/clock", "/tf", "/tf_static"):
            chain.wait_until(lambda t=topic: STAGE not in chain.connected(rospy.get_name(), t), f"the end of {topic}", 10)
        return code

    def mapped(self):
        return len(self.scans.of("/a/stereo_scan")) - self.before

    def wait_for_mapped(self, count):
        """So that no queue overflows however slow the machine is. A scan that came before its tf waits for a timer."""
        for _ in range(7):
            end = time.monotonic() + 0.5
            while time.monotonic() < end:
                if self.mapped() >= count:
                    return
                time.sleep(0.002)
            self.tick(0.06)
        self.fail(f"look {count} was not mapped: {self.mapped()}, {self.report()}")

    def tick(self, seconds):
        self.now_s += seconds
        self.clock.publish(Clock(time_of(self.now_s)))

    def odometry(self, pose, stamp_s=None, pitch=0.0):
        stamp = time_of(self.now_s if stamp_s is None else stamp_s)
        self.tf.publish(TFMessage([transform("a/odom", "a/base_link", (pose.x, pose.y, 0), tilted(pose, pitch), stamp)]))

    def look(self, message, stamp_s=None):
        message.header.stamp = time_of(self.now_s if stamp_s is None else stamp_s)
        self.out.publish(message)
        self.sent += 1

    def drive(self, poses, message_of, pitch=0.0, start=None):
        """One look a tenth of a second; the odometry of its instant comes before it."""
        for pose in poses:
            self.tick(PERIOD_S)
            self.odometry((start or poses[0]).inverse() * pose, pitch=pitch)
            time.sleep(0.005)  # /tf and the sensor's topic are two connections
            before = self.mapped()
            self.look(message_of(pose))
            self.wait_for_mapped(before + 1)

    def report(self):
        """Of all that was sent: scans that wait for tf have had their time, and what came of them was told."""
        for _ in range(12):
            self.tick(0.1)
            time.sleep(0.02)
        self.diagnostics.settled(STAGE, ("processed", "dropped"))
        return self.diagnostics.of(STAGE)

    def dropped(self, named):
        return sum(int(value) for key, value in self.report().items() if key.startswith("dropped: ") and named in key)

    def seen(self, start=None):
        return SeenMap(rospy.ServiceProxy("/a/static_map", GetMap)().map, start or circle()[0])

    def assert_right(self, seen, walls=None):
        walls = walls or self.room.seen_from_the_middle()
        self.assertGreater(seen.count(), 200)
        self.assertGreater(seen.precision(self.room), 0.98)
        self.assertGreater(seen.recall(walls), 0.95)
        self.assertEqual(seen.occupied_within(0.3, 0.3, 4.7, 3.7), 0, "something stands in the free middle of the room")

    def test_a_laser_maps_the_room(self):
        self.start("scan")
        self.drive(circle(), lambda pose: laser_of(self.room, pose))
        report = self.report()
        self.assertEqual((report["processed"], report["dropped"]), (str(self.sent), "0"), report)
        self.assert_right(self.seen())

    def test_depth_in_metres_and_millimetres_map_the_room(self):
        for encoding in ("32FC1", "16UC1"):
            self.start("depth")
            self.drive(circle(), lambda pose, e=encoding: depth_of(self.room, pose, encoding=e))
            report = self.report()
            self.assertEqual((report["processed"], report["dropped"]), (str(self.sent), "0"), report)
            self.assert_right(self.seen())
            self.assertEqual(self.stop(), 0, self.node.text()[-2000:])

    def test_the_floor_before_a_pitched_robot_is_no_wall(self):
        """From 1 m above it the floor changes little from row to row, and a rough sensor takes rows for one surface."""
        pitch = math.radians(6)

        def image(pose):
            message = depth_of(self.room, pose, pitch, height=1.0)
            message.header.frame_id = "a/mast_optical"
            return message

        rough = {"sigma_m_per_m2": 0.01, "common_ratio": 0.005}
        for use_tilt in (True, False):
            self.start("depth", depth=rough, use_tilt=use_tilt)
            self.drive(circle(), image, pitch)
            self.report()
            if use_tilt:
                self.assert_right(self.seen())
            else:
                self.assertLess(self.seen().precision(self.room), 0.9, "the test would see no wall of floor")
            self.stop()

    def test_levels_have_maps_of_their_own(self):
        scan = parameters_of("mapper")["scan"]
        scan["levels"] = [{"name": "obstacles", "z_min_m": 0.15, "z_max_m": 1.5}, {"name": "ceiling", "z_min_m": 1.6, "z_max_m": 2.45}]
        topics = {"/a/map": OccupancyGrid, "/a/map/ceiling_updates": OccupancyGridUpdate, "/a/map_tiles/ceiling": MapTiles}
        recorder = chain.Recorder(topics)
        self.start("depth", scan=scan)
        self.drive(circle(), lambda pose: depth_of(self.room, pose))
        self.report()
        for topic in topics:
            self.assertTrue(recorder.of(topic), f"nothing on {topic}")
        # A late subscriber gets the latched map, then the whole map as it is now.
        late = chain.Recorder({"/a/map/obstacles": OccupancyGrid, "/a/map/ceiling": OccupancyGrid})
        chain.wait_until(lambda: self.report() and all(late.of(topic) for topic in late.messages), "maps for a late subscriber", 10)
        self.report()
        driving, ceiling = (SeenMap(late.last(topic), circle()[0]) for topic in late.messages)
        self.assert_right(driving)
        self.assertEqual(driving.count(), self.seen().count())
        # Over the cupboard only the room's own walls are seen, in the corner, too.
        self.assertGreater(ceiling.precision(self.room, self.room.outer), 0.98)
        self.assertEqual(ceiling.occupied_within(4.9, 2.7, 5.85, 3.85), 0)
        self.assertGreater(ceiling.recall(self.room.outer), 0.85)
        epoch = recorder.last("/a/map_tiles/ceiling").map_epoch
        self.assertTrue(rospy.ServiceProxy("/a/reset", Trigger)().success)
        self.drive(circle()[:10], lambda pose: depth_of(self.room, pose))
        chain.wait_until(lambda: self.report() and recorder.last("/a/map_tiles/ceiling").map_epoch > epoch, "the epoch after the reset", 10)

    def test_a_saved_map_is_gone_on_in(self):
        with tempfile.TemporaryDirectory() as folder:
            self.start("scan")
            self.drive(circle(), lambda pose: laser_of(self.room, pose))
            cells = self.seen().count()
            for name in ("map.gridmap", "map"):
                answer = rospy.ServiceProxy("/a/save_map", MapFile)(os.path.join(folder, name), 0, 0, 0)
                self.assertTrue(answer.success, answer.message)
            self.stop()
            # The robot starts where the circle began, and 30 degrees turned; its odometry knows nothing of that.
            turned = circle()[0] * Pose2(0, 0, math.radians(30))
            for name in ("map.gridmap", "map.yaml"):
                self.start("scan", load_map=os.path.join(folder, name), start={"x_m": 0.0, "y_m": 0.0, "yaw_deg": 30.0})
                self.assertAlmostEqual(self.seen().count(), cells, delta=0.02 * cells)
                self.drive([turned * Pose2(0.02 * i, 0, 0) for i in range(20)], lambda pose: laser_of(self.room, pose))
                self.report()
                self.assert_right(self.seen())
                self.assertAlmostEqual(self.seen().count(), cells, delta=0.2 * cells)
                self.stop()

    def test_late_odometry_is_waited_for_and_too_late_is_dropped(self):
        self.start("scan")
        poses = circle()
        moved = [poses[0].inverse() * pose for pose in poses]
        for delay in (3, 20):  # tenths of a second; tf_timeout_s is 0.5
            stamps = []
            for i in range(len(poses) + delay):
                self.tick(PERIOD_S)
                stamps.append(self.now_s)
                if i < len(poses):
                    self.look(laser_of(self.room, poses[i]))
                if i >= delay:
                    self.odometry(moved[i - delay], stamps[i - delay])
                time.sleep(0.02)
                if i >= delay == 3:
                    self.wait_for_mapped(i - delay)  # the newest may wait for a timer
            if delay == 3:
                report = self.report()
                self.assertEqual(int(report["processed"]), len(poses), report)
                self.assert_right(self.seen())
        self.assertGreater(self.dropped("no tf a/odom -> a/base_link"), len(poses) - 5)
        self.assert_right(self.seen())

    def test_single_stamps_gone_wrong_cost_one_scan_each(self):
        self.start("scan")
        poses = circle()
        self.drive(poses[:40], lambda pose: laser_of(self.room, pose))
        elsewhere = laser_of(self.room, poses[0])  # would spoil the map
        expected = {}
        for stamp_s, named in ((0, "without a stamp"), (self.now_s - 0.05, "out of order"), (self.now_s - 30, "out of order"),
                               (self.now_s + 3600, "future"), (self.now_s - 5, "out of order")):
            expected[named] = expected.get(named, 0) + 1
            self.look(elsewhere, stamp_s)
            self.assertEqual(self.dropped(named), expected[named], f"{named}: {self.diagnostics.of(STAGE)}")
        self.drive(poses[40:], lambda pose: laser_of(self.room, pose), start=poses[0])
        report = self.report()
        self.assertEqual(int(report["processed"]), len(poses), report)
        self.assert_right(self.seen())

    def test_time_that_jumps_back_mixes_no_poses(self):
        """The second run has other poses at the same stamps; with those of the first it would draw a second room."""
        recorder = chain.Recorder({"/a/map_tiles": MapTiles})
        for clock_jumps in (True, False):  # a bag that loops; a sensor's and the odometry's clock set back together
            self.start("scan")
            self.drive(circle(), lambda pose: laser_of(self.room, pose))
            self.report()
            epoch = recorder.last("/a/map_tiles").map_epoch
            begin_s = self.now_s - 6
            poses = [pose * Pose2(0, 0, math.pi) for pose in circle()]
            if clock_jumps:
                self.now_s = begin_s
            for i, pose in enumerate(poses):
                self.tick(PERIOD_S)
                stamp_s = begin_s + (i + 1) * PERIOD_S
                self.odometry(poses[0].inverse() * pose, stamp_s)
                time.sleep(0.02)  # /tf and the scan are two connections, and the first few are not mapped
                self.look(laser_of(self.room, pose), stamp_s)
                time.sleep(0.02)
            self.report()
            self.assertGreater(recorder.last("/a/map_tiles").map_epoch, epoch)
            # The new map's frame is odometry's at its first scan, and that may be one of the first few.
            self.assert_right(self.seen(poses[0]))
            self.stop()


if __name__ == "__main__":
    chain.run("mapper_inputs", MapperInputs)
