#!/usr/bin/python3
"""The package as users get it: installed, and used from the install space alone.

usage: install_space_test.py BUILD_DIR CONSUMER_DIR [unittest arguments]
"""
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

BUILD, CONSUMER = Path(sys.argv.pop(1)).resolve(), Path(sys.argv.pop(1)).resolve()
# Hidden, as rospack looks for programs in every folder below a package's source, where the build may be, too.
PREFIX = BUILD / ".install_test"
NODELETS = {"cornerstone/TrinocularStereo", "cornerstone/OccupancyMapper", "cornerstone/Registration", "cornerstone/Simulator"}
PROGRAMS = ("align_maps", "detect_corners", "stereo_match", "simulate_bag", "evaluate_run")


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class InstallSpace(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(PREFIX, ignore_errors=True)
        subprocess.run(["cmake", "--install", BUILD, "--prefix", PREFIX], check=True, stdout=subprocess.DEVNULL)
        cls.home = PREFIX / "home"
        cls.home.mkdir()
        # catkin writes the set-up scripts for the prefix given when configuring; here the paths are set as they do.
        cls.environment = {"PATH": f"{PREFIX}/bin:/usr/bin:/bin", "HOME": str(cls.home), "LANG": "C.UTF-8",
                           "CMAKE_PREFIX_PATH": f"{PREFIX}:/usr", "ROS_PACKAGE_PATH": f"{PREFIX}/share:/usr/share",
                           "LD_LIBRARY_PATH": f"{PREFIX}/lib", "PYTHONPATH": f"{PREFIX}/lib/python3/dist-packages",
                           "ROS_MASTER_URI": f"http://127.0.0.1:{free_port()}", "ROS_ETC_DIR": "/etc/ros", "ROS_DISTRO": "Debian",
                           "ROS_HOME": str(cls.home), "ROS_LOG_DIR": str(cls.home / "log")}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(PREFIX, ignore_errors=True)

    def run_here(self, *command, timeout=60, **changes):
        return subprocess.run([str(word) for word in command], env={**self.environment, **changes}, cwd=self.home,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=timeout, check=False)

    def test_the_package_is_found_where_it_was_installed(self):
        self.assertEqual(self.run_here("rospack", "find", "cornerstone").stdout.strip(), f"{PREFIX}/share/cornerstone")

    def test_programs_run_without_any_environment(self):
        for name in PROGRAMS:
            with self.subTest(program=name):
                ended = subprocess.run([PREFIX / "lib/cornerstone" / name], env={"PATH": "/usr/bin:/bin"},
                                       capture_output=True, text=True, timeout=30, check=False)
                self.assertEqual(ended.returncode, 2, ended.stderr)
                self.assertIn("usage", ended.stderr)

    def test_nothing_links_into_the_build(self):
        files = [*PREFIX.glob("lib/*.so"), *(p for p in (PREFIX / "lib/cornerstone").iterdir() if p.is_file())]
        self.assertGreater(len(files), 8)
        for file in files:
            dynamic = subprocess.run(["readelf", "-d", file], capture_output=True, text=True, check=True).stdout
            self.assertNotIn(str(BUILD / "devel"), dynamic, file.name)

    def test_rosrun_finds_the_programs(self):
        ended = self.run_here("rosrun", "cornerstone", "align_maps")
        self.assertEqual(ended.returncode, 2, ended.stdout + ended.stderr)

    def test_pluginlib_finds_the_nodelets(self):
        # What pluginlib asks for; the demo below loads them.
        listed = self.run_here("rospack", "plugins", "--attrib=plugin", "nodelet")
        files = dict(line.split() for line in listed.stdout.splitlines())
        self.assertEqual(files.get("cornerstone"), f"{PREFIX}/share/cornerstone/nodelet_plugins.xml", listed.stderr)
        text = Path(files["cornerstone"]).read_text(encoding="utf-8")
        self.assertEqual({c.get("name") for c in ElementTree.fromstring(text).iter("class")}, NODELETS)

    def test_launch_files_load(self):
        for name, arguments in (("demo.launch", ()), ("robot.launch", ("robot:=a",)), ("rviz.launch", ())):
            with self.subTest(file=name):
                ended = self.run_here("roslaunch", "--nodes", "cornerstone", name, *arguments)
                self.assertEqual(ended.returncode, 0, ended.stderr)
                self.assertTrue(ended.stdout.strip())

    def test_the_demo_runs(self):
        launch = subprocess.Popen(["roslaunch", "-p", self.environment["ROS_MASTER_URI"].rsplit(":", 1)[1], "cornerstone", "demo.launch"],
                                  env=self.environment, cwd=self.home, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
        try:
            for robot in ("a", "b"):
                self.wait_for_tf(launch, robot)
        finally:
            os.killpg(launch.pid, signal.SIGINT)
            output, _ = launch.communicate(timeout=60)
        self.assertNotIn("refused to start", output)
        self.assertNotIn("has died", output)

    def wait_for_tf(self, launch, robot):
        end = time.monotonic() + 60
        while time.monotonic() < end and launch.poll() is None:
            seen = self.run_here("timeout", "10", "rostopic", "echo", "-n", "1", f"/{robot}/stereo_scan/header/frame_id")
            if f"{robot}/base_link" in seen.stdout:
                return
        self.fail(f"no stereo_scan of robot {robot}: {launch.poll()}")

    def test_a_package_compiles_against_it(self):
        build = self.home / "consumer"
        changes = {"CMAKE_PREFIX_PATH": f"{PREFIX}:/usr"}
        configured = self.run_here("cmake", "-S", CONSUMER, "-B", build, "-DCMAKE_BUILD_TYPE=Release", timeout=120, **changes)
        self.assertEqual(configured.returncode, 0, configured.stdout + configured.stderr)
        built = self.run_here("cmake", "--build", build, timeout=200, **changes)
        self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
        ran = subprocess.run([build / "consumer"], env={"PATH": "/usr/bin:/bin"}, capture_output=True, text=True, check=False)
        self.assertEqual(ran.stdout, "4 2 0 0\n", ran.stderr)

    def test_message_classes_are_installed(self):
        ended = self.run_here("/usr/bin/python3", "-c", "from cornerstone.msg import MapRegistration; from cornerstone.srv import MapFile")
        self.assertEqual(ended.returncode, 0, ended.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
