#!/usr/bin/python3
"""align_maps and detect_corners from the outside: good input, refusals, and every kind of bad input."""
import math
import unittest

import cv2
import numpy

import program_case
from program_case import ProgramCase, draw_rooms, write_map


class MapProgram(ProgramCase):
    def setUp(self):
        super().setUp()
        self.rooms = draw_rooms()
        self.map = write_map(self.folder, "rooms", self.rooms)

    def bad_maps(self):
        """File, and what the message must name."""
        text = self.map.read_text()
        image = (self.folder / "rooms.png").read_bytes()
        self.file("truncated.png", image[:len(image) // 3])
        self.file("empty.png", b"")
        self.file("text.png", "this is no image")
        def changed(name, old, new):
            return self.file(name, text.replace(old, new))
        yield self.folder / "missing.yaml", "missing.yaml"
        yield self.folder, self.folder
        yield self.file("empty.yaml", ""), "empty.yaml"
        yield self.file("list.yaml", "- 1\n- 2\n"), "list.yaml"
        yield self.file("broken.yaml", "image: [rooms.png\nresolution: {"), "broken.yaml"
        yield self.file("binary.yaml", bytes(range(256)) * 8), "binary.yaml"
        yield self.file("other.yaml", "robots: [a, b]\n"), "other.yaml"
        yield changed("no_image.yaml", "rooms.png", "nowhere.png"), "nowhere.png"
        yield changed("cut.yaml", "rooms.png", "truncated.png"), "truncated.png"
        yield changed("nothing.yaml", "rooms.png", "empty.png"), "empty.png"
        yield changed("no_picture.yaml", "rooms.png", "text.png"), "text.png"
        yield changed("zero.yaml", "0.05", "0"), "resolution"
        yield changed("negative.yaml", "0.05", "-0.05"), "resolution"
        yield changed("nan.yaml", "0.05", ".nan"), "resolution"
        yield changed("words.yaml", "0.05", "fine"), "resolution"
        yield changed("origin.yaml", "[0.0, 0.0, 0.0]", "[0.0]"), "origin"
        yield changed("origin_nan.yaml", "[0.0, 0.0, 0.0]", "[.nan, 0, 0]"), "origin"
        yield changed("thresholds.yaml", "0.196", "0.9"), "free_thresh"
        yield self.file("maimed.gridmap", b"\x00\x01\x02" * 50), "maimed.gridmap"
        yield self.file("maimed.gridmap.gz", b"\x1f\x8b\x08\x00" + b"\x01" * 40), "maimed.gridmap.gz"


class DetectCorners(MapProgram):
    def test_corners_have_the_fields_promised(self):
        answer = self.answer("detect_corners", self.map)
        self.assertEqual(set(answer), {"corners", "elapsed_ms"})
        self.assertGreater(len(answer["corners"]), 8)
        for corner in answer["corners"]:
            self.assertEqual(set(corner), {"x_m", "y_m", "yaw_rad", "covariance", "rms_m", "kind"})
            self.assertEqual(len(corner["covariance"]), 9)
            self.assertIn(corner["kind"], ("inside_free", "inside_solid"))
            self.assertTrue(all(math.isfinite(v) for v in (*corner["covariance"], corner["x_m"], corner["y_m"])))

    def test_a_room_corner_is_where_it_was_drawn(self):
        # The corridor's lower left corner: column 10, image row 132 of 220.
        corners = self.answer("detect_corners", self.map)["corners"]
        self.assertLess(min(math.hypot(c["x_m"] - 0.5, c["y_m"] - (220 - 132) * 0.05) for c in corners), 0.05)

    def test_a_map_without_walls_is_no_answer(self):
        blank = write_map(self.folder, "blank", numpy.full((60, 60), program_case.UNSEEN, numpy.uint8))
        self.assertEqual(self.answer("detect_corners", blank, code=3)["corners"], [])

    def test_overlay(self):
        self.answer("detect_corners", self.map, "--overlay", self.folder / "overlay.png")
        self.assertIsNotNone(cv2.imread(str(self.folder / "overlay.png")))

    def test_bad_maps(self):
        for path, named in self.bad_maps():
            with self.subTest(path=path.name):
                self.assert_refused(named, "detect_corners", path, "--overlay", "left_behind.png")
                self.assertFalse((self.folder / "left_behind.png").exists())

    def test_bad_arguments(self):
        self.assert_refused("usage", "detect_corners")
        self.assert_refused("usage", "detect_corners", self.map, self.map)
        self.assert_refused("--frobnicate", "detect_corners", self.map, "--frobnicate", "1")
        self.assert_refused("--overlay", "detect_corners", self.map, "--overlay")
        self.assert_refused("/nowhere/x.png", "detect_corners", self.map, "--overlay", "/nowhere/x.png")
        self.assert_refused("picture.xyz", "detect_corners", self.map, "--overlay", "picture.xyz")


class AlignMaps(MapProgram):
    FIELDS = {"registered", "x_m", "y_m", "yaw_rad", "covariance", "matched", "rms_m", "overlap", "second_best", "elapsed_ms"}

    def test_a_shifted_copy(self):
        # The copy's frame lies at (0.35, -0.2) of the reference's: what is at p there is at p - shift here.
        copy = write_map(self.folder, "copy", self.rooms, origin=(-0.35, 0.2, 0.0))
        answer = self.answer("align_maps", self.map, copy)
        self.assertLessEqual(self.FIELDS, set(answer))
        self.assertTrue(answer["registered"])
        self.assertAlmostEqual(answer["x_m"], 0.35, delta=0.01)
        self.assertAlmostEqual(answer["y_m"], -0.2, delta=0.01)
        self.assertAlmostEqual(answer["yaw_rad"], 0, delta=0.002)
        self.assertEqual(len(answer["covariance"]), 9)
        self.assertGreater(answer["overlap"], 0.95)
        self.assertGreater(answer["elapsed_ms"]["total"], 0)

    def test_a_copy_turned_by_a_quarter(self):
        # Rows of the turned image: what was at (x, y) is at (W - y, x) with W the old height in metres.
        turned = write_map(self.folder, "turned", cv2.rotate(self.rooms, cv2.ROTATE_90_COUNTERCLOCKWISE))
        answer = self.answer("align_maps", self.map, turned)
        self.assertAlmostEqual(answer["yaw_rad"], -math.pi / 2, delta=0.002)
        self.assertAlmostEqual(answer["x_m"], 0, delta=0.02)
        self.assertAlmostEqual(answer["y_m"], 220 * 0.05, delta=0.02)

    def test_a_prior_is_obeyed(self):
        copy = write_map(self.folder, "copy", self.rooms, origin=(-0.35, 0.2, 0.0))
        answer = self.answer("align_maps", self.map, copy, "--prior", "0.5,-0.4,-5")
        self.assertAlmostEqual(answer["x_m"], 0.35, delta=0.01)
        self.assertAlmostEqual(answer["y_m"], -0.2, delta=0.01)

    def test_nothing_to_align_is_no_answer(self):
        blank = write_map(self.folder, "blank", numpy.full((60, 60), program_case.UNSEEN, numpy.uint8))
        answer = self.answer("align_maps", self.map, blank, code=3)
        self.assertFalse(answer["registered"])
        self.assertNotIn("x_m", answer)
        self.assertTrue(answer["reason"])

    def test_bad_maps_in_either_place(self):
        for path, named in self.bad_maps():
            with self.subTest(path=path.name):
                self.assert_refused(named, "align_maps", path, self.map, "--overlay", "left_behind.png")
                self.assert_refused(named, "align_maps", self.map, path, "--overlay", "left_behind.png")
                self.assertFalse((self.folder / "left_behind.png").exists())

    def test_bad_arguments(self):
        self.assert_refused("usage", "align_maps")
        self.assert_refused("usage", "align_maps", self.map)
        self.assert_refused("--turn", "align_maps", self.map, self.map, "--turn", "3")
        for prior in ("1,2", "1,2,3,4", "a,b,c", "1,2,nan", "", "1,2,", "1e999,0,0"):
            with self.subTest(prior=prior):
                self.assert_refused("--prior", "align_maps", self.map, self.map, "--prior", prior)


if __name__ == "__main__":
    program_case.main()
