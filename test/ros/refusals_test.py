#!/usr/bin/python3
"""A wrong parameter stops the start and is named: exit code 2 of a stand-alone node, a failed load in a manager."""
import sys
import unittest

import rospy

import chain
from programs import Node, load_parameters, parameters_of

# program, nodelet, config file, a key of it, what makes it complete
STAGES = (("trinocular_stereo", "TrinocularStereo", "stereo", "queue_size", {}),
          ("occupancy_mapper", "OccupancyMapper", "mapper", "tf_timeout_s", {}),
          ("registration", "Registration", "registration", "period_s", {}),
          ("simulator", "Simulator", "simulator", "rate_factor", {}))


def faults(config, key):
    """What is wrong, the changes that make it so, and what the message must name."""
    inner = "cameras" if config == "simulator" else {"stereo": "stereo", "mapper": "scan", "registration": "tracker"}[config]
    members = dict(parameters_of(config)[inner], surplus=1)
    return (("unknown", {"quue_size": 5}, "quue_size"), ("unknown inside", {inner: members}, "surplus"),
            ("missing", {key: None}, key), ("mistyped", {key: "many"}, key), ("not finite", {key: float("nan")}, key),
            ("not a map", {inner: 3}, inner))


class Refusals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("refusals_test")
        cls.programs = rospy.myargv()[1]

    def refused(self, program, named):
        node = Node(f"{self.programs}/{program}_node")
        self.assertEqual(node.wait(20), 2, node.text())
        self.assertIn(named, node.text())

    def test_stand_alone_nodes(self):
        for program, _, config, key, _ in STAGES:
            for what, changes, named in faults(config, key):
                with self.subTest(program=program, fault=what):
                    load_parameters(config, "/" + program, **changes)
                    self.refused(program, named)

    def test_no_parameters_at_all(self):
        for program, *_ in STAGES:
            with self.subTest(program=program):
                if rospy.has_param("/" + program):
                    rospy.delete_param("/" + program)
                self.refused(program, "no parameters")

    def test_values_out_of_range(self):
        cases = (("trinocular_stereo", "stereo", {"images": "image_color"}, "images"),
                 ("trinocular_stereo", "stereo", {"queue_size": 0}, "queue_size"),
                 ("occupancy_mapper", "mapper", {"input": "sonar"}, "input"),
                 ("occupancy_mapper", "mapper", {"tf_timeout_s": -1.0}, "tf_timeout_s"),
                 ("registration", "registration", {"robot": ""}, "robot"),
                 ("registration", "registration", {"period_s": 0.0}, "period_s"),
                 ("simulator", "simulator", {"world": "/nowhere.yaml"}, "/nowhere.yaml"),
                 ("simulator", "simulator", {"robots": ["nobody"]}, "nobody"))
        for program, config, changes, named in cases:
            with self.subTest(program=program, changes=changes):
                load_parameters(config, "/" + program, **changes)
                self.refused(program, named)

    def test_nodelets_in_a_manager(self):
        chain.wait_until(lambda: chain.publishers_of("/rosout") and self.manager_serves(), "the manager", 30)
        for _, nodelet, config, key, _ in STAGES:
            with self.subTest(nodelet=nodelet):
                load_parameters(config, "/loaded", **{key: "many"})
                loader = Node("/usr/lib/nodelet/nodelet", "load", f"cornerstone/{nodelet}", "manager", "__name:=loaded")
                self.assertNotEqual(loader.wait(30), 0, loader.text())
                self.assertIn("Failed to load", loader.text())
        # The manager has lived through all of them, and nothing half-started stays behind.
        self.assertTrue(self.manager_serves())
        self.assertEqual(chain.publishers_of("/disparity") + chain.publishers_of("/map"), [])

    @staticmethod
    def manager_serves():
        try:
            rospy.wait_for_service("/manager/load_nodelet", 1)
            return True
        except rospy.ROSException:
            return False


if __name__ == "__main__":
    import rostest
    rostest.rosrun("cornerstone", "refusals", Refusals, sys.argv)
