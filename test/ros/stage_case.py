"""One stage as a program that gets messages made by hand: what is sent, and what its diagnostics say of it."""
import unittest

import numpy
import rospy
from sensor_msgs.msg import CameraInfo, Image

import chain
from programs import Node, load_parameters

NAN, INF = float("nan"), float("inf")
WIDTH, HEIGHT, FOCAL_PX, BASELINE_M = 160, 120, 80.0, 0.12


def image(encoding="mono8", width=WIDTH, height=HEIGHT, data=None, frame="a/reference_optical"):
    bytes_per_pixel = {"mono8": 1, "bgr8": 3, "32FC1": 4, "16UC1": 2, "mono16": 2}.get(encoding, 1)
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


class StageCase(unittest.TestCase):
    """setUpClass of a test sets `programs`, the folder of the programs, and `diagnostics`."""

    def start(self, name, config, **changes):
        self.stage = f"/a/{name}"
        self.diagnostics.forget(self.stage)
        load_parameters(config, self.stage, **changes)
        self.node = Node(f"{self.programs}/{name}_node", "__ns:=/a")
        self.addCleanup(self.node.stop)
        if name == "occupancy_mapper":  # it reads ranges when the pose of their instant is known, and here time does not wait
            chain.wait_until(lambda: self.stage in chain.connected(rospy.get_name(), "/tf"), "the mapper to take tf", 20)
            rospy.sleep(0.2)

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
