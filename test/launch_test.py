#!/usr/bin/python3
"""Every launch file loads, with every switch: its nodes exist, their parameters are read, frames are the robot's."""
import itertools
import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import roslaunch.config
import roslaunch.xmlloader

SOURCE = Path(sys.argv.pop(1))
LAUNCH_FILES = sorted((SOURCE / "launch").glob("*.launch"))
REQUIRED = {"robot.launch": ["robot:=a"]}
NODELETS = {c.get("name") for c in ElementTree.parse(SOURCE / "nodelet_plugins.xml").iter("class")}


def load(file, *arguments):
    config = roslaunch.config.ROSLaunchConfig()
    loader = roslaunch.xmlloader.XmlLoader()
    loader.load(str(file), config, argv=[*REQUIRED.get(file.name, []), *arguments], verbose=False)
    config.assign_machines()
    if config.config_errors:
        raise AssertionError(f"{file.name}: {config.config_errors}")
    return config


def nodelets_of(config):
    """Node name -> nodelet type that it loads."""
    words = {n.namespace + n.name: n.args.split() for n in config.nodes if n.type == "nodelet"}
    return {name: args[1] for name, args in words.items() if args[0] in ("load", "standalone")}


class Launch(unittest.TestCase):
    def test_every_file_loads_and_its_nodes_exist(self):
        self.assertGreaterEqual(len(LAUNCH_FILES), 3)
        for file in LAUNCH_FILES:
            with self.subTest(file=file.name):
                config = load(file)
                self.assertTrue(config.nodes)
                for node in config.nodes:
                    found = [Path("/usr/lib", node.package, node.type), Path("/usr/bin", node.type)]
                    self.assertTrue(any(p.exists() for p in found), f"{node.package}/{node.type}")
                self.assertLessEqual(set(nodelets_of(config).values()), NODELETS)

    def test_required_arguments_are_required(self):
        with self.assertRaises(Exception):
            roslaunch.xmlloader.XmlLoader().load(str(SOURCE / "launch/robot.launch"), roslaunch.config.ROSLaunchConfig(),
                                                 argv=[], verbose=False)

    def test_every_nodelet_gets_all_of_its_file(self):
        config = load(SOURCE / "launch/demo.launch")
        for node, nodelet in nodelets_of(config).items():
            keys = [k for k in config.params if k.startswith(node + "/")]
            self.assertGreater(len(keys), 3, f"{node} ({nodelet})")

    def test_every_switch(self):
        for name, values in (("input", ("disparity", "depth", "scan")), ("images", ("image_rect", "image_raw")),
                             ("third_camera", ("true", "false")), ("publish_mounting", ("true", "false"))):
            for value in values:
                with self.subTest(switch=name, value=value):
                    load(SOURCE / "launch/robot.launch", f"{name}:={value}")
        for rviz, bag in itertools.product(("true", "false"), ("", "/tmp/x.bag")):
            load(SOURCE / "launch/demo.launch", f"rviz:={rviz}", f"bag:={bag}")

    def test_stereo_only_where_disparity_is_wanted(self):
        for kind, wanted in (("disparity", True), ("depth", False), ("scan", False)):
            nodelets = nodelets_of(load(SOURCE / "launch/robot.launch", f"input:={kind}")).values()
            self.assertEqual("cornerstone/TrinocularStereo" in nodelets, wanted)

    def test_lasers_get_their_own_values_over_those_of_a_camera(self):
        for kind, range_m in (("disparity", 8), ("depth", 8), ("scan", 15)):
            params = load(SOURCE / "launch/robot.launch", f"input:={kind}").params
            self.assertEqual(params["/a/mapper/mapper/grid/max_range_m"].value, range_m)
            self.assertEqual(params["/a/mapper/input"].value, kind)
            self.assertEqual(params["/a/mapper/mapper/grid/resolution_m"].value, 0.05)  # what the overlay leaves alone

    def test_names_follow_the_robot(self):
        config = load(SOURCE / "launch/robot.launch", "robot:=left", "reference_robot:=right")
        self.assertEqual(config.params["/left/mapper/robot"].value, "left")
        self.assertEqual(config.params["/left/registration/reference_robot"].value, "right")
        frames = [w for n in config.nodes if n.type == "static_transform_publisher" for w in n.args.split()[-2:]]
        self.assertEqual(set(frames), {"left/base_link", "left/reference", "left/reference_optical"})


if __name__ == "__main__":
    unittest.main(verbosity=2)
