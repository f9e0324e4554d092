#!/usr/bin/python3
"""A wrong parameter stops the start and is named: exit code 2 of a stand-alone node, a failed load in a manager."""
import unittest

import rospkg
import rospy

import chain
from programs import Node, load_parameters, parameters_of

OFFICE = rospkg.RosPack().get_path("cornerstone") + "/worlds/office.yaml"
# program, nodelet, config file, a numeric key of it
STAGES = (("trinocular_stereo", "TrinocularStereo", "stereo", "queue_size"),
          ("occupancy_mapper", "OccupancyMapper", "mapper", "tf_timeout_s"),
          ("registration", "Registration", "registration", "period_s"),
          ("simulator", "Simulator", "simulator", "rate_factor"))


LEVEL = {"name": "obstacles", "z_min_m": 0.15, "z_max_m": 1.5}
BAD_LEVELS = (([], "levels: at least one"), (3, "'levels' is not a list"), ([3], "'levels[0]' is not a map"),
              ([LEVEL, LEVEL], "levels[1]/name 'obstacles' is there twice"), ([dict(LEVEL, name="Up there")], "levels[0]/name"),
              ([dict(LEVEL, z_max_m=0.1)], "levels[0]/z_max_m"), ([{"name": "a", "z_min_m": 0.1}], "levels[0]: parameter 'z_max_m' is missing"),
              ([dict(LEVEL, zmax=2)], "levels[0]: unknown parameter 'zmax'"))


def faults(config, key):
    """Changes that make the parameters wrong, and what the message must name."""
    inner = "cameras" if config == "simulator" else {"stereo": "stereo", "mapper": "scan", "registration": "tracker"}[config]
    members = dict(parameters_of(config)[inner], surplus=1)
    return (({"quue_size": 5}, "quue_size"), ({inner: members}, "surplus"), ({key: None}, key), ({key: "many"}, key),
            ({key: float("nan")}, key), ({inner: 3}, inner))


class Refusals(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        rospy.init_node("refusals_test")
        cls.programs = rospy.myargv()[1]

    def fault_of(self, program, named):
        """What is wrong with the refusal, in words; None when it is as it should be."""
        node = Node(f"{self.programs}/{program}_node")
        try:
            code = node.wait(20)
        except AssertionError as error:
            return str(error)
        return None if code == 2 and named in node.text() else f"code {code}, '{named}' expected:\n{node.text()}"

    def assert_all_refused(self, cases):
        """cases: program, config file or None for no parameters, changes, name that the message must hold."""
        found = []
        for program, config, changes, named in cases:
            if config:
                load_parameters(config, "/" + program, **changes)
            elif rospy.has_param("/" + program):
                rospy.delete_param("/" + program)
            fault = self.fault_of(program, named)
            if fault:
                found.append(f"{program} with {changes}: {fault}")
        self.assertEqual(found, [])

    def test_stand_alone_nodes(self):
        self.assert_all_refused([(program, config, changes, named) for program, _, config, key in STAGES
                                 for changes, named in faults(config, key)])

    def test_no_parameters_at_all(self):
        self.assert_all_refused([(program, None, {}, "no parameters") for program, *_ in STAGES])

    def test_values_out_of_range(self):
        self.assert_all_refused([
            ("trinocular_stereo", "stereo", {"images": "image_color"}, "images"),
            ("trinocular_stereo", "stereo", {"queue_size": 0}, "queue_size"),
            ("occupancy_mapper", "mapper", {"input": "sonar"}, "input"),
            ("occupancy_mapper", "mapper", {"tf_timeout_s": -1.0}, "tf_timeout_s"),
            ("occupancy_mapper", "mapper", {"load_map": "/nowhere/map"}, "'load_map': /nowhere/map.yaml"),
            *[("occupancy_mapper", "mapper", {"scan": dict(parameters_of("mapper")["scan"], levels=levels)}, named)
              for levels, named in BAD_LEVELS],
            ("registration", "registration", {"robot": ""}, "robot"),
            ("registration", "registration", {"period_s": 0.0}, "period_s"),
            ("registration", "registration", {"registration": dict(parameters_of("registration")["registration"], robot_radius_m=-0.1)},
             "robot_radius_m"),
            ("simulator", "simulator", {"world": "/nowhere.yaml"}, "/nowhere.yaml"),
            ("simulator", "simulator", {"robots": ["nobody"], "world": OFFICE}, "nobody")])

    def test_nodelets_in_a_manager(self):
        chain.wait_until(lambda: chain.publishers_of("/rosout") and self.manager_serves(), "the manager", 30)
        for _, nodelet, config, key in STAGES:
            load_parameters(config, "/loaded", **{key: "many"})
            loader = Node("/usr/lib/nodelet/nodelet", "load", f"cornerstone/{nodelet}", "manager", "__name:=loaded")
            self.assertNotEqual(loader.wait(30), 0, nodelet + loader.text())
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
    chain.run("refusals", Refusals)
