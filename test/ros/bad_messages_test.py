#!/usr/bin/python3
"""Every node gets messages that no sane sender sends; it names and counts them, lives on, and ends with code 0."""
import unittest

import cv2
import numpy
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, Image, LaserScan
from stereo_msgs.msg import DisparityImage

import chain
from cornerstone.msg import MapTile, MapTiles
from programs import Node, load_parameters, static_mounting

NAN, INF = float("nan"), float("inf")
WIDTH, HEIGHT, FOCAL_PX, BASELINE_M = 160, 120, 80.0, 0.12


def image(encoding="mono8", width=WIDTH, height=HEIGHT, data=None, frame="a/reference_optical"):
    bytes_per_pixel = {"mono8": 1, "bgr8": 3, "32FC1": 4, "16UC1": 2}.get(encoding, 1)
    message = Image(width=width, height=height, encoding=encoding, step=width * bytes_per_pixel)
    message.data = bytes(width * height * bytes_per_pixel) if data is None else data
    message.header.frame_id = frame
    return message


def info(width=WIDTH, height=HEIGHT, focal=FOCAL_PX, shift=0.0):
    message = CameraInfo(width=width, height=height, distortion_model="plumb_bob")
    cx, cy = (width - 1) / 2, (height - 1) / 2
    message.K = [focal, 0, cx, 0, focal, cy, 0, 0, 1]
    message.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    message.P = [focal, 0, cx, shift, 0, focal, cy, 0, 0, 0, 1, 0]
    message.header.frame_id = "a/reference_optical"
    return message


def floats(values, width=WIDTH, height=HEIGHT):
    return image("32FC1", width, height, numpy.full((height, width), values, numpy.float32).tobytes())


def disparity(picture=None, f=FOCAL_PX, baseline=BASELINE_M):
    message = DisparityImage(f=f, T=baseline, min_disparity=0, max_disparity=32)
    message.image = picture if picture is not None else floats(4.0)
    message.header.frame_id = "a/reference_optical"
    return message


def laser(ranges=(2.0,) * 90, increment=0.0175, low=-0.78, range_min=0.1, range_max=8.0):
    message = LaserScan(angle_min=low, angle_max=0.78, angle_increment=increment, range_min=range_min, range_max=range_max,
                        ranges=list(ranges))
    message.header.frame_id = "a/base_link"
    return message


def tile(col=0, row=0, size=64, value=200, png=None):
    encoded = cv2.imencode(".png", numpy.full((size, size), value, numpy.uint8))[1].tobytes() if png is None else png
    return MapTile(col=col, row=row, size=size, png=encoded)


def tiles(*members, resolution=0.05, epoch=7, version=1, complete=True):
    return MapTiles(robot="a", map_epoch=epoch, version=version, resolution=resolution, complete=complete, tiles=list(members))


class BadMessages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("bad_messages_test")
        cls.programs = rospy.myargv()[1]
        cls.diagnostics = chain.Diagnostics()
        cls.mounting = static_mounting("a")
        cls.broadcaster = tf2_ros.TransformBroadcaster()
        cls.odom_x = 0.0
        cls.timer = rospy.Timer(rospy.Duration(0.02), cls.publish_odometry)

    @classmethod
    def publish_odometry(cls, _):
        transform = TransformStamped()
        transform.header.stamp = rospy.Time.now()
        transform.header.frame_id, transform.child_frame_id = "a/odom", "a/base_link"
        transform.transform.translation.x = cls.odom_x
        transform.transform.rotation.w = 1
        cls.broadcaster.sendTransform(transform)

    def start(self, name, config, **changes):
        load_parameters(config, f"/a/{name}", **changes)
        self.node = Node(f"{self.programs}/{name}_node", "__ns:=/a")
        self.addCleanup(self.node.stop)
        self.stage = f"/a/{name}"

    def publisher(self, topic, kind):
        publisher = rospy.Publisher(topic, kind, queue_size=50, latch=True)
        self.addCleanup(publisher.unregister)
        chain.wait_until(publisher.get_num_connections, f"a subscriber of {topic}", 20)
        return publisher

    def send(self, publisher, message):
        if hasattr(message, "header"):
            message.header.stamp = rospy.Time.now() - rospy.Duration(0.04)
        publisher.publish(message)
        rospy.sleep(0.06)

    def dropped(self):
        return self.diagnostics.count(self.stage, "dropped")

    def wait_for_drop(self, named):
        def seen():
            return any(named in key for key in self.diagnostics.of(self.stage) if key.startswith("dropped: "))
        try:
            chain.wait_until(seen, f"a dropped message whose cause names '{named}'", 10)
        except AssertionError as error:
            raise AssertionError(f"{error}: {self.diagnostics.of(self.stage)}") from None

    def assert_lives(self):
        self.assertIsNone(self.node.process.poll(), self.node.text()[-3000:])
        self.assertEqual(self.node.stop(), 0, self.node.text()[-3000:])

    def processed_after(self, publish):
        """A good message must still be processed after all the bad ones."""
        before = self.diagnostics.count(self.stage, "processed")
        def more():
            publish()
            return self.diagnostics.count(self.stage, "processed") > before
        chain.wait_until(more, f"{self.stage} to process something", 10)

    def test_mapper_of_disparity(self):
        self.start("occupancy_mapper", "mapper", robot="a", disparity_sigma_px=0.3)
        calibration = self.publisher("/a/reference/camera_info", CameraInfo)
        out = self.publisher("/a/disparity", DisparityImage)
        self.send(out, disparity())
        self.wait_for_drop("reference/camera_info")
        self.send(calibration, info())
        cases = ((disparity(f=0), "f"), (disparity(f=NAN), "f"), (disparity(baseline=-0.1), "T"),
                 (disparity(baseline=INF), "T"), (disparity(image("mono8")), "32FC1"), (disparity(Image()), "image"),
                 (disparity(image("32FC1", data=b"1234")), "image"), (disparity(floats(4.0, 80, 60)), "width"),
                 (disparity(floats(4.0, 160, 60)), "height"))
        for message, named in cases:
            self.send(out, message)
            self.wait_for_drop(named)
        for values in (NAN, INF, -INF, -3.0, 1e30, 1e-30, 0.0):  # senseless, but of the right form
            self.send(out, disparity(floats(values)))
        lost = disparity()
        lost.header.frame_id = "nowhere"
        self.send(out, lost)
        self.wait_for_drop("nowhere")
        for calibration_fault in (info(focal=0.0), info(width=0), info(focal=NAN)):
            self.send(calibration, calibration_fault)
            self.send(out, disparity())
        self.send(calibration, info())
        self.processed_after(lambda: self.send(out, disparity()))
        self.assert_lives()

    def test_mapper_of_depth(self):
        self.start("occupancy_mapper", "mapper", robot="a", input="depth")
        calibration, out = self.publisher("/a/camera_info", CameraInfo), self.publisher("/a/depth", Image)
        self.send(calibration, info())
        for message, named in ((image("bgr8"), "bgr8"), (Image(), "encoding"), (floats(2.0, 80, 60), "width"),
                               (image("32FC1", data=b"12"), "depth")):
            self.send(out, message)
            self.wait_for_drop(named)
        for values in (NAN, INF, -1.0, 1e30, 0.0):
            self.send(out, floats(values))
        self.processed_after(lambda: self.send(out, floats(2.0)))
        self.assert_lives()

    def test_mapper_of_laser_scans_and_odometry_gone_astray(self):
        self.start("occupancy_mapper", "mapper", robot="a", input="scan")
        out = self.publisher("/a/scan", LaserScan)
        for message, named in ((laser(increment=0.0), "angle_increment"), (laser(increment=NAN), "angle_increment"),
                               (laser(low=INF), "angle_min"), (laser(range_max=NAN), "range_max")):
            self.send(out, message)
            self.wait_for_drop(named)
        for ranges in ((), (NAN,) * 90, (INF,) * 90, (-1.0,) * 90, (1e30,) * 90, (0.0,) * 90):
            self.send(out, laser(ranges))
        self.processed_after(lambda: self.send(out, laser()))
        for astray in (1e5, 1e9, 1e30):
            type(self).odom_x = astray
            rospy.sleep(0.1)
            for _ in range(14):  # more than the scans that are waited for before a changed world is believed
                self.send(out, laser())
        self.wait_for_drop("too far")
        type(self).odom_x = 0.0
        rospy.sleep(0.2)
        self.assert_lives()

    def start_stereo(self, cameras=("reference", "right"), **changes):
        """Publishers of the cameras' calibrations, and a function that sends a set of images."""
        self.start("trinocular_stereo", "stereo", third_camera=len(cameras) > 2, **changes)
        infos = [self.publisher(f"/a/{c}/camera_info", CameraInfo) for c in cameras]
        images = [self.publisher(f"/a/{c}/image_rect", Image) for c in cameras]

        def send(*members):
            stamp = rospy.Time.now()
            for publisher, message in zip(images, members):
                message.header.stamp = stamp
                publisher.publish(message)
            rospy.sleep(0.06)
        return infos, send

    def test_stereo_goes_on_when_the_third_camera_stops(self):
        infos, send = self.start_stereo(("reference", "right", "top"), third_camera_silence_s=0.3)
        top = info()
        top.P = [*top.P[:7], FOCAL_PX * BASELINE_M, *top.P[8:]]
        for publisher, message in zip(infos, (info(), info(shift=-FOCAL_PX * BASELINE_M), top)):
            publisher.publish(message)
        rospy.sleep(0.2)
        self.processed_after(lambda: send(image(), image(), image()))
        self.assertNotEqual(self.diagnostics.of(self.stage)["level"], 2)
        rospy.sleep(0.4)
        self.processed_after(lambda: send(image(), image()))
        chain.wait_until(lambda: "/a/top is silent" in self.diagnostics.of(self.stage)["message"], "word of the top camera", 10)
        self.processed_after(lambda: send(image(), image(), image()))
        chain.wait_until(lambda: self.diagnostics.of(self.stage)["level"] != 2, "the complaint to end", 10)
        self.assert_lives()

    def test_stereo_images_before_their_calibrations(self):
        infos, send = self.start_stereo()
        send(image(), image())
        send(image(), image())
        for publisher, message in zip(infos, (info(), info(shift=-FOCAL_PX * BASELINE_M))):
            publisher.publish(message)
        chain.wait_until(lambda: self.diagnostics.count(self.stage, "processed") == 2, "both sets that waited", 10)
        self.assertEqual(self.dropped(), 0, self.diagnostics.of(self.stage))
        self.assert_lives()

    def test_stereo(self):
        infos, send = self.start_stereo()
        send(image(), image())
        self.wait_for_drop("camera_info: none received yet")
        good = info(), info(shift=-FOCAL_PX * BASELINE_M)
        for reference, right, named in ((info(focal=0.0), good[1], "/a/reference/camera_info"),
                                        (good[0], info(focal=NAN), "/a/right/camera_info"),
                                        (good[0], good[0], "baseline"),
                                        (good[0], info(80, 60, shift=-9.6), "size")):
            for publisher, message in zip(infos, (reference, right)):
                publisher.publish(message)
            rospy.sleep(0.2)
            send(image(), image())
            self.wait_for_drop(named)
        for publisher, message in zip(infos, good):
            publisher.publish(message)
        rospy.sleep(0.2)
        for pair in ((image(width=80, height=60), image()), (image(), image("32FC1")), (image("jelly"), image()),
                     (Image(), image()), (image(), image(data=b"123"))):
            before = self.dropped()
            send(*pair)
            chain.wait_until(lambda b=before: self.dropped() > b, "the pair to be dropped", 10)
        self.processed_after(lambda: send(image(), image()))
        self.assert_lives()

    def test_registration(self):
        self.start("registration", "registration", robot="b", reference_robot="a")
        own = self.publisher("/a/map_tiles", MapTiles)  # its namespace is /a: both topics are this one
        good = tile()
        for message, named in ((tiles(), "no tiles"), (tiles(good, resolution=0.0), "resolution"),
                               (tiles(good, resolution=NAN), "resolution"), (tiles(tile(png=b"")), "png"),
                               (tiles(tile(png=b"\x89PNG no picture")), "png"), (tiles(tile(png=good.png[:40])), "png"),
                               (tiles(MapTile(col=0, row=0, size=32, png=good.png)), "png"),
                               (tiles(MapTile(col=0, row=0, size=0, png=good.png)), "size"),
                               (tiles(good, tile(col=3)), "between"),
                               (tiles(good, tile(col=-2 ** 31, row=2 ** 31 - 64)), "too far")):
            self.send(own, message)
            self.wait_for_drop(named)
        self.send(own, tiles(good))
        self.send(own, tiles(good, resolution=0.1, version=2, complete=False))
        self.wait_for_drop("resolution changed")
        self.processed_after(lambda: self.send(own, tiles(tile(value=10), version=3)))
        self.assert_lives()


if __name__ == "__main__":
    chain.run("bad_messages", BadMessages)
