#!/usr/bin/python3
"""The stereo node: points, parameters that change while it runs, and the cause of every set that is dropped."""
import cv2
import numpy
import rospy
from dynamic_reconfigure.client import Client
from sensor_msgs import point_cloud2
from sensor_msgs.msg import CameraInfo, Image, PointCloud2
from stereo_msgs.msg import DisparityImage

import chain
from programs import parameters_of
from stage_case import BASELINE_M, FOCAL_PX, HEIGHT, NAN, WIDTH, StageCase, image, info

SHIFT = -FOCAL_PX * BASELINE_M  # of the right camera's P
DISPARITY_PX = 8  # of the scene: 1.2 m everywhere


def top_info(shift=-SHIFT):
    message = info()
    message.P = [*message.P[:7], shift, *message.P[8:]]
    return message


def of(picture, encoding="mono8"):
    return image(encoding, picture.shape[1], picture.shape[0], picture.tobytes())


def scene():
    """Reference, right and top image of a wall with texture."""
    random = numpy.random.default_rng(5)
    wall = cv2.GaussianBlur(random.uniform(0, 255, (HEIGHT + DISPARITY_PX, WIDTH + DISPARITY_PX)), (0, 0), 1.2)
    wall = cv2.normalize(wall, None, 0, 255, cv2.NORM_MINMAX).astype(numpy.uint8)
    return tuple(of(numpy.ascontiguousarray(wall[y:y + HEIGHT, x:x + WIDTH])) for x, y in
                 ((0, DISPARITY_PX), (DISPARITY_PX, DISPARITY_PX), (0, 0)))


class StereoNodelet(StageCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("stereo_nodelet_test")
        cls.programs = rospy.myargv()[1]
        cls.diagnostics = chain.Diagnostics()

    def start_stereo(self, cameras=("reference", "right"), images="image_rect", calibrations=(), **changes):
        """Starts the node and, unless told otherwise, calibrates it."""
        self.start("trinocular_stereo", "stereo", third_camera=len(cameras) > 2, images=images, **changes)
        self.infos = [self.publisher(f"/a/{c}/camera_info", CameraInfo) for c in cameras]
        self.images = [self.publisher(f"/a/{c}/{images}", Image) for c in cameras]
        if calibrations is not None:
            self.calibrate(*(calibrations or (info(), info(shift=SHIFT), top_info())[:len(cameras)]))

    def calibrate(self, *calibrations):
        for publisher, message in zip(self.infos, calibrations):
            publisher.publish(message)
        rospy.sleep(0.2)

    def send(self, *members, late_s=0.0):
        """A set; all images but the reference camera's have later stamps by late_s."""
        stamp = rospy.Time.now()
        for i, (publisher, message) in enumerate(zip(self.images, members)):
            if message is not None:
                message.header.stamp = stamp + rospy.Duration(late_s if i else 0)
                publisher.publish(message)
        rospy.sleep(0.06)

    def answer_to(self, topic, kind, *members):
        """The node's next message on a topic after images are sent."""
        recorder = chain.Recorder({topic: kind})
        chain.wait_until(lambda: recorder.subscribers[0].get_num_connections(), f"a publisher of {topic}")

        def answered():
            self.send(*members)
            return recorder.last(topic)
        answer = chain.wait_until(answered, f"an answer on {topic}", 20)
        recorder.subscribers[0].unregister()
        return answer

    def wait_for_complaint(self, named):
        chain.wait_until(lambda: named in self.diagnostics.of(self.stage).get("message", ""), f"the complaint '{named}'", 15)

    def test_points_lie_where_the_wall_is(self):
        self.start_stereo(("reference", "right", "top"))
        cloud = self.answer_to("/a/points", PointCloud2, *scene())
        self.assertEqual((cloud.width, cloud.height, cloud.header.frame_id), (WIDTH, HEIGHT, "a/reference_optical"))
        self.assertEqual([field.name for field in cloud.fields], ["x", "y", "z", "intensity"])
        points = numpy.array(list(point_cloud2.read_points(cloud))).reshape(HEIGHT, WIDTH, 4)
        there = numpy.isfinite(points[..., 2])
        self.assertGreater(there.mean(), 0.9)
        range_m = FOCAL_PX * BASELINE_M / DISPARITY_PX
        self.assertLess(numpy.abs(points[there][:, 2] - range_m).max(), 0.1)
        x_m = (numpy.arange(WIDTH) - (WIDTH - 1) / 2) * range_m / FOCAL_PX
        self.assertLess(numpy.nanmax(numpy.abs(points[..., 0] - x_m)), 0.1)
        self.assert_lives()

    def test_parameters_change_while_it_runs(self):
        stereo = dict(parameters_of("stereo")["stereo"], max_disparity_px=48, largest_sigma_px=1.2)
        self.start_stereo(stereo=stereo)
        client = Client("/a/trinocular_stereo/stereo", timeout=20)
        begun = client.get_configuration(timeout=20)
        self.assertEqual({name: begun[name] for name in stereo if name in begun}, {name: value for name, value in stereo.items() if name in begun})
        self.assertIn("window_px", begun)
        self.assertEqual(rospy.get_param("/a/trinocular_stereo/stereo"), stereo)
        self.assertEqual(self.answer_to("/a/disparity", DisparityImage, *scene()).max_disparity, 48)
        self.assertEqual(client.update_configuration({"max_disparity_px": 16})["max_disparity_px"], 16)
        self.assertEqual(self.answer_to("/a/disparity", DisparityImage, *scene()).max_disparity, 16)
        # An even window is refused and takes what else was asked for with it.
        refused = client.update_configuration({"window_px": 4, "max_disparity_px": 32})
        self.assertEqual((refused["window_px"], refused["max_disparity_px"]), (stereo["window_px"], 16))
        self.assertIn("window_px must be odd", self.node.text())
        client.update_configuration({"largest_sigma_px": NAN})
        self.assertIn("largest_sigma_px", self.node.text())
        self.assertEqual(self.answer_to("/a/disparity", DisparityImage, *scene()).max_disparity, 16)
        self.assertEqual(rospy.get_param("/a/trinocular_stereo/stereo/max_disparity_px"), 16)
        self.assert_lives()

    def listen(self):
        """Somebody wants disparities: without, nothing is matched."""
        recorder = chain.Recorder({"/a/disparity": DisparityImage})
        self.addCleanup(recorder.subscribers[0].unregister)
        chain.wait_until(recorder.subscribers[0].get_num_connections, "the node as a publisher")
        return recorder

    def test_swapped_cameras_are_found_out(self):
        self.start_stereo()
        reference, right, _ = scene()
        recorder = self.listen()
        for _ in range(15):
            self.send(right, reference)
        self.wait_for_complaint("cameras swapped")
        self.wait_for_drop("cameras swapped")
        self.assertLess(len(recorder.of("/a/disparity")), 10)
        for _ in range(3):
            self.send(reference, right)
        chain.wait_until(lambda: self.diagnostics.of(self.stage)["level"] != 2, "the complaint to end", 15)
        self.assert_lives()

    def test_a_third_camera_that_contradicts_is_found_out(self):
        self.start_stereo(("reference", "right", "top"), calibrations=(info(), info(shift=SHIFT), top_info(-2 * SHIFT)))
        self.listen()
        views = scene()
        for _ in range(110):
            self.send(*views)
        self.wait_for_complaint("the third camera contradicts the first two")
        self.wait_for_drop("the third camera contradicts the first two")
        self.calibrate(info(), info(shift=SHIFT), top_info())
        self.processed_after(lambda: self.send(*views))
        chain.wait_until(lambda: self.diagnostics.of(self.stage)["level"] != 2, "the complaint to end", 15)
        self.assert_lives()

    def test_goes_on_when_the_third_camera_stops(self):
        self.start_stereo(("reference", "right", "top"), third_camera_silence_s=0.3)
        self.processed_after(lambda: self.send(image(), image(), image()))
        self.assertNotEqual(self.diagnostics.of(self.stage)["level"], 2)
        rospy.sleep(0.4)
        self.processed_after(lambda: self.send(image(), image()))
        self.wait_for_complaint("/a/top is silent")
        self.processed_after(lambda: self.send(image(), image(), image()))
        chain.wait_until(lambda: self.diagnostics.of(self.stage)["level"] != 2, "the complaint to end", 10)
        self.assert_lives()

    def test_stops_with_the_third_camera_when_told_so(self):
        self.start_stereo(("reference", "right", "top"), third_camera_silence_s=0)
        self.processed_after(lambda: self.send(image(), image(), image()))
        before = self.diagnostics.count(self.stage, "processed")
        for _ in range(12):
            self.send(image(), image())
        self.wait_for_drop("/a/top: no image, the camera is silent")
        self.assertLessEqual(self.diagnostics.count(self.stage, "processed"), before + 1)
        self.processed_after(lambda: self.send(image(), image(), image()))
        self.assert_lives()

    def test_images_before_their_calibrations(self):
        self.start_stereo(calibrations=None)
        sets = 10  # twice queue_size, in less than the 2 s that sets wait
        for _ in range(sets):
            self.send(image(), image())
        self.calibrate(info(), info(shift=SHIFT))
        chain.wait_until(lambda: self.diagnostics.count(self.stage, "processed") == sets, "every set that waited", 10)
        self.assertEqual(self.dropped(), 0, self.diagnostics.of(self.stage))
        self.assert_lives()

    def test_calibrations_that_make_no_rig(self):
        self.start_stereo(("reference", "right", "top"), calibrations=None)
        self.send(image(), image(), image())
        self.wait_for_drop("camera_info: none received yet")
        good = info(), info(shift=SHIFT), top_info()
        unequal, skew = info(), info(shift=SHIFT)
        unequal.P = [*unequal.P[:5], 1.1 * FOCAL_PX, *unequal.P[6:]]
        skew.P = [*skew.P[:7], 0.1 * SHIFT, *skew.P[8:]]
        for calibrations, named in (((info(focal=0.0), *good[1:]), "/a/reference/camera_info: focal length in P is not positive"),
                                    ((good[0], info(focal=NAN), good[2]), "/a/right/camera_info: P holds NaN"),
                                    ((good[0], info(), good[2]), "/a/right/camera_info: baseline is zero"),
                                    ((good[0], info(shift=-SHIFT), good[2]), "baseline is negative"),
                                    ((good[0], skew, good[2]), "/a/right/camera_info: baseline lies along neither"),
                                    ((unequal, *good[1:]), "/a/reference/camera_info: P has unequal focal lengths in x and y: not rectified"),
                                    ((*good[:2], top_info(NAN)), "/a/top/camera_info: P holds NaN"),
                                    ((*good[:2], info()), "/a/top/camera_info: baseline is zero"),
                                    ((good[0], info(80, 60, shift=SHIFT), good[2]), "/a/right/camera_info: image size differs"),
                                    ((CameraInfo(), *good[1:]), "/a/reference/camera_info: image size is zero: not calibrated")):
            self.calibrate(*calibrations)
            self.send(image(), image(), image())
            self.wait_for_drop(named)
            self.wait_for_complaint(named)
        self.calibrate(*good)
        self.processed_after(lambda: self.send(image(), image(), image()))
        self.assert_lives()

    def test_raw_images_of_cameras_without_lens(self):
        self.start_stereo(images="image_raw", calibrations=None)
        no_lens, no_rotation = info(), info()
        no_lens.K, no_rotation.R = [0.0] * 9, [0.0] * 9
        for reference, named in ((no_lens, "focal length in K"), (no_rotation, "R is not a rotation")):
            self.calibrate(reference, info(shift=SHIFT))
            self.send(image(), image())
            self.wait_for_drop(named)
        self.calibrate(info(), info(shift=SHIFT))
        self.processed_after(lambda: self.send(*scene()[:2]))
        self.send(image(width=80, height=60), image())
        self.wait_for_drop("80x60")
        self.assert_lives()

    def test_images_that_are_none(self):
        self.start_stereo()
        for pair, named in (((image(width=80, height=60), image()), "reference image is 80x60, expected 160x120"),
                            ((image(), image("32FC1")), "/a/right/image_rect: encoding '32FC1'"),
                            ((image("jelly"), image()), "/a/reference/image_rect: encoding 'jelly'"),
                            ((Image(), image()), "/a/reference/image_rect: the image is empty"),
                            ((image(width=WIDTH + 1), image()), "reference image is 161x120"),
                            ((image(), image(data=b"123")), "/a/right/image_rect: the image is truncated")):
            self.send(*pair)
            self.wait_for_drop(named)
        wrong_step = image()
        wrong_step.step = 10
        self.send(wrong_step, image())
        self.wait_for_drop("/a/reference/image_rect")
        for encoding in ("bgr8", "mono16"):
            self.processed_after(lambda e=encoding: self.send(image(e), image(e)))
        self.assert_lives()

    def test_odd_sizes(self):
        self.start_stereo(calibrations=(info(37, 21), info(37, 21, shift=SHIFT)))
        small = [of(numpy.ascontiguousarray(numpy.frombuffer(m.data, numpy.uint8).reshape(HEIGHT, WIDTH)[:21, :37])) for m in scene()]
        answer = self.answer_to("/a/disparity", DisparityImage, *small[:2])
        self.assertEqual((answer.image.width, answer.image.height), (37, 21))
        self.assert_lives()

    def test_stamps_that_differ(self):
        self.start_stereo(sync_tolerance_s=0.01)
        self.send(image(), image(), late_s=0.008)
        chain.wait_until(lambda: self.diagnostics.count(self.stage, "processed") == 1, "the set, without a next one", 10)
        for _ in range(8):
            self.send(image(), image(), late_s=0.03)
        self.wait_for_drop("/a/right: its stamps differ from the reference camera's by more than sync_tolerance_s")
        self.assert_lives()

    def test_a_camera_that_is_silent(self):
        self.start_stereo()
        self.processed_after(lambda: self.send(image(), image()))
        for _ in range(8):
            self.send(image(), None)
        self.wait_for_drop("/a/right: no image, the camera is silent")
        self.assert_lives()

    def test_no_set_of_a_burst_goes_uncounted(self):
        self.start_stereo(calibrations=(info(640, 480), info(640, 480, shift=SHIFT)), queue_size=1)
        self.listen()
        # From the first complete set on every image counts: before it, the cameras' connections come one by one.
        self.send(*[image(width=640, height=480) for _ in self.images])
        chain.wait_until(lambda: self.diagnostics.count(self.stage, "processed") == 1, "the first set", 20)
        sets = 41  # with the first
        for _ in range(sets - 1):
            stamp = rospy.Time.now()
            for publisher in self.images:
                message = image(width=640, height=480)
                message.header.stamp = stamp
                publisher.publish(message)
        self.wait_for_drop("the queue was full")
        # All but the newest, which may still wait for their set.
        chain.wait_until(lambda: self.diagnostics.count(self.stage, "processed") + self.dropped() >= sets - 2,
                         "every set to be processed or counted", 10)
        self.assertLessEqual(self.diagnostics.count(self.stage, "processed") + self.dropped(), sets)
        self.assert_lives()


if __name__ == "__main__":
    chain.run("stereo_nodelet", StereoNodelet)
