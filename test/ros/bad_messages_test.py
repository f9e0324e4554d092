#!/usr/bin/python3
"""Every node gets messages that no sane sender sends; it names and counts them, lives on, and ends with code 0."""
import cv2
import numpy
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, Image, LaserScan
from stereo_msgs.msg import DisparityImage

import chain
from cornerstone.msg import MapTile, MapTiles
from programs import static_mounting
from stage_case import BASELINE_M, FOCAL_PX, INF, NAN, StageCase, floats, image, info


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


class BadMessages(StageCase):
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

    def test_registration(self):
        self.start("registration", "registration", robot="b", reference_robot="a")
        own = self.publisher("/a/map_tiles", MapTiles)  # its namespace is /a: both topics are this one
        good = tile()
        for message, named in ((tiles(complete=False), "no tiles"), (tiles(good, resolution=0.0), "resolution"),
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
