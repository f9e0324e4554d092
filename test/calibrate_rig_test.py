#!/usr/bin/python3
"""calibrate_rig from the outside: rendered boards of three cameras, and the real set of Debian's opencv-doc,
each as files and as a recording."""
import gzip
from pathlib import Path

import cv2
import numpy
import rosbag
import rospy
import yaml
from sensor_msgs.msg import CompressedImage, Image

import program_case

REAL = Path("/usr/share/doc/opencv-doc/examples/data")
SIZE, FOCAL_PX, BASELINE_M, SQUARE_M = (320, 240), 250.0, 0.12, 0.04
BOARD = (8, 6)
CAMERAS = {"reference": (0, 0), "right": (BASELINE_M, 0), "top": (0, -BASELINE_M)}


def board_picture(square_px=40):
    rows, cols = BOARD[1] + 1, BOARD[0] + 1
    squares = (numpy.indices((rows, cols)).sum(0) % 2 == 0)
    picture = numpy.where(squares, 30, 220).astype(numpy.uint8).repeat(square_px, 0).repeat(square_px, 1)
    return cv2.copyMakeBorder(picture, square_px, square_px, square_px, square_px, cv2.BORDER_CONSTANT, value=220)


def rendered(rotation, position_m, camera_m, square_px=40):
    """The board as a camera without lens distortion sees it, its first inner corner at position_m."""
    metres = SQUARE_M / square_px
    # Picture pixel (u, v) lies at ((u - 2 squares) metres, (v - 2 squares) metres) on the board.
    board = numpy.array([[metres, 0, -2 * SQUARE_M], [0, metres, -2 * SQUARE_M], [0, 0, 1]])
    at = (numpy.array(position_m) - [*camera_m, 0]).reshape(3, 1)
    camera = numpy.array([[FOCAL_PX, 0, (SIZE[0] - 1) / 2], [0, FOCAL_PX, (SIZE[1] - 1) / 2], [0, 0, 1]])
    homography = camera @ numpy.hstack([rotation[:, :2], at]) @ board
    double = numpy.array([[2, 0, 0.5], [0, 2, 0.5], [0, 0, 1]])
    large = cv2.warpPerspective(board_picture(square_px), double @ homography, (2 * SIZE[0], 2 * SIZE[1]), borderValue=220)
    return cv2.resize(large, SIZE, interpolation=cv2.INTER_AREA)


def message_of(picture, time_s, compressed=False):
    if compressed:
        message = CompressedImage(format="png", data=cv2.imencode(".png", picture)[1].tobytes())
    else:
        message = Image(height=picture.shape[0], width=picture.shape[1], step=picture.shape[1], encoding="mono8", data=picture.tobytes())
    message.header.stamp = rospy.Time.from_sec(time_s)
    return message


class CalibrateRig(program_case.ProgramCase):
    def render(self, sets=12):
        random = numpy.random.default_rng(2)
        for name in CAMERAS:
            (self.folder / name).mkdir()
        for i in range(sets):
            rotation = cv2.Rodrigues(random.uniform([-.5, -.5, -.2], [.5, .5, .2]))[0]
            position = random.uniform([-.2, -.15, .6], [-.05, -.05, .8])
            for name, at in CAMERAS.items():
                cv2.imwrite(str(self.folder / name / f"{i:02d}.png"), rendered(rotation, position, at))

    def calibrate(self, *arguments, code=0):
        return self.answer("calibrate_rig", *arguments, "--out", self.folder / "out", code=code)

    def info(self, name):
        return yaml.safe_load((self.folder / "out" / f"{name}.yaml").read_text())

    def record(self, folders, late_s=0.0, times=1, compressed=False):
        """The images of some folders, or patterns, as a bag; every board is seen so many times on end."""
        path = self.folder / "boards.bag"
        with rosbag.Bag(str(path), "w") as bag:
            for name, pattern in folders.items():
                for i, file in enumerate(sorted(self.folder.glob(pattern))):
                    picture = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
                    for repeat in range(times):
                        time_s = 100 + i + 0.1 * repeat + (late_s if name != "reference" else 0)
                        message = message_of(picture, time_s, compressed)
                        bag.write(f"/a/{name}/image_raw", message, message.header.stamp)
        return path

    def check_three(self, answer, sets):
        for pair in ("right", "top"):
            self.assertEqual(answer["pairs"][pair]["sets"], sets)
            self.assertAlmostEqual(answer["pairs"][pair]["baseline_m"], BASELINE_M, delta=0.001)
            self.assertLess(answer["pairs"][pair]["epipolar_rms_px"], 0.3)

    BOARD_OPTIONS = ("--board", "8x6", "--square", SQUARE_M)
    THREE_TOPICS = "/a/reference/image_raw,/a/right/image_raw,/a/top/image_raw"

    def test_a_bag_of_three_rendered_cameras(self):
        self.render()
        bag = self.record({name: f"{name}/*.png" for name in CAMERAS}, late_s=0.002, times=3)
        self.check_three(self.calibrate("--bag", bag, "--topics", self.THREE_TOPICS, *self.BOARD_OPTIONS), 12)

    def test_a_bag_of_compressed_images(self):
        self.render()
        bag = self.record({name: f"{name}/*.png" for name in CAMERAS}, compressed=True)
        self.check_three(self.calibrate("--bag", bag, "--topics", self.THREE_TOPICS, *self.BOARD_OPTIONS), 12)

    def test_bags_that_do_not_do(self):
        self.render(sets=6)
        bag = self.record({name: f"{name}/*.png" for name in CAMERAS}, late_s=0.02)
        options = (*self.BOARD_OPTIONS, "--out", "out")
        two = "/a/reference/image_raw,/a/right/image_raw"
        self.assert_refused("only 0 boards", "calibrate_rig", "--bag", bag, "--topics", two, *options)
        self.assertTrue(self.calibrate("--bag", bag, "--topics", two, "--tolerance", 0.03, *self.BOARD_OPTIONS)["calibrated"])
        for topics, named in (("/a/reference/image_raw,/a/left", f"{bag}: no topic /a/left; it holds /a/reference/image_raw"),
                              ("/a/reference/image_raw", "--topics"), ("", "--topics")):
            self.assert_refused(named, "calibrate_rig", "--bag", bag, "--topics", topics, *options)
        self.assert_refused("expected 0 arguments", "calibrate_rig", "reference", "--bag", bag, "--topics", two, *options)
        self.assert_refused("nowhere.bag", "calibrate_rig", "--bag", "nowhere.bag", "--topics", two, *options)
        self.assert_refused("none.bag", "calibrate_rig", "--bag", self.file("none.bag", "no bag"), "--topics", two, *options)
        with rosbag.Bag(str(self.folder / "odd.bag"), "w") as odd:
            odd.write("/a/reference/image_raw", Image(encoding="jelly", width=2, height=2, step=2, data=bytes(4)))
            odd.write("/a/right/image_raw", message_of(numpy.zeros((2, 2), numpy.uint8), 1))
            odd.write("/a/time", rospy.Header())
        self.assert_refused("odd.bag, /a/reference/image_raw: encoding 'jelly'", "calibrate_rig", "--bag", "odd.bag", "--topics", two, *options)
        self.assert_refused("/a/time is of type std_msgs/Header, no images", "calibrate_rig", "--bag", "odd.bag", "--topics",
                            "/a/right/image_raw,/a/time", *options)

    def test_three_rendered_cameras(self):
        self.render()
        answer = self.calibrate("reference", "right", "--top", "top", "--board", "8x6", "--square", SQUARE_M)
        self.assertTrue(answer["calibrated"])
        self.check_three(answer, 12)
        for name in CAMERAS:
            info = self.info(name)
            self.assertEqual((info["image_width"], info["image_height"], info["camera_name"]), (*SIZE, name))
            self.assertAlmostEqual(info["camera_matrix"]["data"][0], FOCAL_PX, delta=4)
            self.assertEqual(info["distortion_model"], "plumb_bob")
            self.assertEqual((info["projection_matrix"]["rows"], info["projection_matrix"]["cols"]), (3, 4))
            self.assertEqual(len(info["distortion_coefficients"]["data"]), 5)
        focal = self.info("right")["projection_matrix"]["data"][0]
        self.assertAlmostEqual(self.info("right")["projection_matrix"]["data"][3], -focal * BASELINE_M, delta=0.4)
        self.assertAlmostEqual(self.info("top")["projection_matrix"]["data"][7], focal * BASELINE_M, delta=0.4)
        picture = cv2.imread(str(self.folder / "out" / "epipolar.png"))
        self.assertEqual(picture.shape, (SIZE[1], 2 * SIZE[0] + 10, 3))

    def test_ros_reads_the_calibration(self):
        try:
            import camera_calibration_parsers
        except ImportError:
            self.skipTest("package python3-camera-calibration-parsers is not installed")
        self.render(sets=6)
        self.calibrate("reference", "right", *self.BOARD_OPTIONS)
        for camera in ("reference", "right"):
            name, info = camera_calibration_parsers.readCalibration(str(self.folder / "out" / f"{camera}.yaml"))
            self.assertEqual((name, info.width, info.height, info.distortion_model), (camera, *SIZE, "plumb_bob"))
            for key, values in (("camera_matrix", info.K), ("rectification_matrix", info.R), ("projection_matrix", info.P),
                                ("distortion_coefficients", info.D)):
                numpy.testing.assert_allclose(values, self.info(camera)[key]["data"], rtol=0, atol=1e-9)

    def test_bad_input(self):
        self.render(sets=2)
        board = ("--board", "8x6", "--square", SQUARE_M, "--out", "out")
        self.assert_refused("only 2 boards", "calibrate_rig", "reference", "right", *board)
        self.assert_refused("nowhere", "calibrate_rig", "nowhere/left*.png", "right", *board)
        self.assert_refused("no images", "calibrate_rig", "reference/*.jpg", "right", *board)
        self.assert_refused("--board", "calibrate_rig", "reference", "right", "--board", "8", "--square", 1, "--out", "out")
        self.assert_refused("square", "calibrate_rig", "reference", "right", "--board", "8x6", "--square", 0, "--out", "out")
        self.assert_refused("--out is missing", "calibrate_rig", "reference", "right", "--board", "8x6", "--square", 1)
        (self.folder / "right" / "02.png").write_bytes(b"no picture")
        self.assert_refused("02.png", "calibrate_rig", "reference", "right", *board)

    def test_real_boards_of_two_cameras(self):
        left, right = (sorted(path for path in REAL.glob(f"{side}[0-9][0-9].jpg*")) for side in ("left", "right"))
        if not left or len(left) != len(right):
            self.skipTest("package opencv-doc is not installed")
        for path in left + right:
            data = path.read_bytes()
            (self.folder / path.name.removesuffix(".gz")).write_bytes(gzip.decompress(data) if path.suffix == ".gz" else data)
        self.check_real(self.calibrate("left*.jpg", "right*.jpg", "--board", "9x6", "--square", 0.05))
        bag = self.record({"reference": "left*.jpg", "right": "right*.jpg"})
        self.check_real(self.calibrate("--bag", bag, "--topics", "/a/reference/image_raw,/a/right/image_raw", "--board", "9x6", "--square", 0.05))

    def check_real(self, answer):
        # 13 pairs; the size of the squares is not known, 5 cm sets the scale.
        self.assertGreaterEqual(answer["pairs"]["right"]["sets"], 12)
        self.assertLess(answer["pairs"]["right"]["rms_px"], 0.3)
        self.assertLess(answer["pairs"]["right"]["epipolar_rms_px"], 0.3)
        self.assertAlmostEqual(answer["pairs"]["right"]["baseline_m"], 0.167, delta=0.01)


if __name__ == "__main__":
    program_case.main()
