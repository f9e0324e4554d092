#!/usr/bin/python3
"""stereo_match from the outside."""
import cv2
import numpy

import program_case
from program_case import ProgramCase

DISPARITY_PX = 6


class StereoMatch(ProgramCase):
    def setUp(self):
        super().setUp()
        noise = numpy.random.default_rng(3).integers(0, 255, (120, 200), dtype=numpy.uint8)
        texture = cv2.GaussianBlur(noise, (0, 0), 1.0)
        texture = cv2.normalize(texture, None, 20, 235, cv2.NORM_MINMAX)
        # A wall at one disparity: the right camera sees everything so much farther left, the top one farther down.
        views = {"reference": texture[:, :160], "right": texture[:, DISPARITY_PX:160 + DISPARITY_PX],
                 "top": numpy.roll(texture, DISPARITY_PX, axis=0)[:, :160]}
        self.paths = {name: self.folder / f"{name}.png" for name in views}
        for name, view in views.items():
            cv2.imwrite(str(self.paths[name]), view)
        self.out = self.folder / "out.png"

    def match(self, *options):
        answer = self.answer("stereo_match", self.paths["reference"], self.paths["right"], *options, "--out", self.out)
        self.assertGreater(answer["elapsed_ms"], 0)
        return cv2.imread(str(self.out), cv2.IMREAD_UNCHANGED)

    def assert_wall(self, disparity):
        self.assertEqual((disparity.dtype, disparity.shape), (numpy.dtype("uint16"), (120, 160)))
        middle = disparity[20:-20, 40:-20] / 256.0
        self.assertGreater((middle > 0).mean(), 0.95)
        self.assertLess(numpy.abs(middle[middle > 0] - DISPARITY_PX).max(), 0.5)

    def test_two_cameras(self):
        self.assert_wall(self.match())

    def test_three_cameras(self):
        self.assert_wall(self.match("--top", self.paths["top"]))

    def test_max_disparity(self):
        self.assert_wall(self.match("--max-disparity", "16"))

    def assert_stereo_refused(self, named, *arguments):
        self.assert_refused(named, "stereo_match", *arguments)
        self.assertEqual([p.name for p in self.folder.iterdir() if "out" in p.name], [])

    def test_bad_images(self):
        good, out = self.paths["reference"], ("--out", self.out)
        cv2.imwrite(str(self.folder / "small.png"), numpy.zeros((60, 80), numpy.uint8))
        whole = good.read_bytes()
        bad = [self.file("truncated.png", whole[:len(whole) // 20]), self.file("empty.png", b""),
               self.file("text.png", "no image"), self.folder / "missing.png", self.folder / "small.png", self.folder]
        for path in bad:
            with self.subTest(path=path.name):
                self.assert_stereo_refused(path, good, path, *out)
                self.assert_stereo_refused(path, good, self.paths["right"], "--top", path, *out)
                if path.name != "small.png":
                    self.assert_stereo_refused(path, path, good, *out)

    def test_bad_arguments(self):
        pair = (self.paths["reference"], self.paths["right"])
        self.assert_stereo_refused("usage")
        self.assert_stereo_refused("usage", pair[0], "--out", self.out)
        self.assert_stereo_refused("--out", *pair)
        self.assert_stereo_refused("--bottom", *pair, "--bottom", pair[0], "--out", self.out)
        self.assert_stereo_refused("/nowhere/out.png", *pair, "--out", "/nowhere/out.png")
        for text in ("0", "-4", "2.5", "many", "1e12", "nan"):
            with self.subTest(max_disparity=text):
                self.assert_stereo_refused("max", *pair, "--max-disparity", text, "--out", self.out)


if __name__ == "__main__":
    program_case.main()
