"""What the tests of programs share: running one in a clean environment, small maps and images as files."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import cv2
import numpy

FREE, OCCUPIED, UNSEEN = 254, 0, 205  # grey levels of map_server's trinary maps


class ProgramCase(unittest.TestCase):
    programs = None  # folder of the programs, set by main

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def run_program(self, name, *arguments):
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(self.folder), "LANG": "C.UTF-8"}
        environment.update({key: os.environ[key] for key in ("DISPLAY",) if key in os.environ})
        return subprocess.run([f"{self.programs}/{name}", *map(str, arguments)], cwd=self.folder, env=environment,
                              capture_output=True, text=True, timeout=120, check=False)

    def answer(self, name, *arguments, code=0):
        """The JSON object of the last line."""
        ended = self.run_program(name, *arguments)
        self.assertEqual(ended.returncode, code, ended.stdout + ended.stderr)
        return json.loads(ended.stdout.splitlines()[-1])

    def assert_refused(self, named, name, *arguments):
        """Exit code 2, a message that names what is wrong, nothing on the standard output."""
        ended = self.run_program(name, *arguments)
        self.assertEqual(ended.returncode, 2, ended.stdout + ended.stderr)
        self.assertIn(str(named), ended.stderr)
        self.assertEqual(ended.stdout, "")
        self.assertNotIn("terminate called", ended.stderr)

    def file(self, name, text):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path


def draw_rooms(width=320, height=220):
    """Grey map image of rooms off a corridor at 0.05 m, no two alike; first row at the largest y."""
    grid = numpy.full((height, width), UNSEEN, numpy.uint8)

    def room(x0, y0, x1, y1):
        grid[y0:y1, x0:x1] = FREE
    room(10, 100, 300, 132)                                   # corridor
    room(10, 20, 90, 96), room(94, 40, 190, 96), room(196, 12, 300, 96)   # above it
    room(20, 136, 130, 205), room(136, 136, 236, 190), room(242, 136, 300, 210)
    for x, y in ((40, 96), (130, 96), (250, 96), (60, 132), (170, 132), (262, 132)):
        room(x, y, x + 18, y + 4)
    for x0, y0, x1, y1 in ((70, 20, 90, 40), (110, 40, 140, 50), (280, 60, 300, 80), (20, 190, 45, 205),
                           (170, 140, 190, 154), (280, 136, 300, 150)):
        grid[y0:y1, x0:x1] = UNSEEN
    free = grid == FREE
    near = cv2.dilate(free.astype(numpy.uint8), numpy.ones((5, 5), numpy.uint8)) > 0
    grid[near & ~free] = OCCUPIED
    return grid


def write_map(folder, name, image, origin=(0.0, 0.0, 0.0), resolution=0.05):
    cv2.imwrite(str(folder / f"{name}.png"), image)
    path = folder / f"{name}.yaml"
    path.write_text(f"image: {name}.png\nresolution: {resolution}\norigin: [{origin[0]}, {origin[1]}, {origin[2]}]\n"
                    "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n")
    return path


def main():
    """usage: <test>.py FOLDER_OF_THE_PROGRAMS [SOURCE_DIR] [unittest arguments]"""
    import sys
    ProgramCase.programs = sys.argv.pop(1)
    if len(sys.argv) > 1 and os.path.isdir(sys.argv[1]):
        ProgramCase.source = Path(sys.argv.pop(1))
    unittest.main(argv=sys.argv, verbosity=2)
