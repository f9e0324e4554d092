#!/usr/bin/python3
"""The stand-alone nodes do what the nodelets do: simulator, stereo, mapper and registration, each a program."""
import unittest

import rospkg
import rospy
from std_msgs.msg import Bool
from stereo_msgs.msg import DisparityImage
from tf2_msgs.msg import TFMessage

import chain
from programs import Node, load_parameters, static_mounting

ROBOT = "a"


class StandAlone(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.nodes = []
        programs = rospy.myargv()[1]
        rospy.set_param("/use_sim_time", True)
        rospy.init_node("stand_alone_test")
        share = rospkg.RosPack().get_path("cornerstone")
        load_parameters("simulator", "/simulator", world=share + "/worlds/corridor_crossing.yaml", robots=[ROBOT], rate_factor=1.0)
        load_parameters("stereo", "/a/trinocular_stereo")
        load_parameters("mapper", "/a/occupancy_mapper", robot=ROBOT)
        load_parameters("registration", "/a/registration", robot=ROBOT, reference_robot=ROBOT)
        topics = dict(chain.robot_topics(ROBOT), **{"/tf": TFMessage, "/simulation_done": Bool, "/a/disparity": DisparityImage})
        cls.recorder = chain.Recorder(topics)
        cls.mounting = static_mounting(ROBOT)
        for name in ("trinocular_stereo", "occupancy_mapper", "registration"):
            cls.nodes.append(Node(f"{programs}/{name}_node", "__ns:=/a"))
        chain.wait_for_robots([ROBOT])
        cls.nodes.append(Node(f"{programs}/simulator_node"))

    @classmethod
    def tearDownClass(cls):
        codes = [node.stop() for node in cls.nodes]
        assert codes == [0] * len(codes), f"the nodes ended with {codes}"

    def test_the_whole_chain_runs(self):
        for topic in ("/a/disparity", "/a/stereo_scan", "/a/map", "/a/map_tiles", "/a/landmarks"):
            chain.wait_until(lambda t=topic: self.recorder.of(t), topic, 60)
        chain.wait_until(lambda: any(t.child_frame_id == "a/odom" and t.header.frame_id == "a/map"
                                     for m in self.recorder.of("/tf") for t in m.transforms), "tf a/map -> a/odom", 30)
        self.assertEqual([node.process.poll() for node in self.nodes], [None] * 4)

    def test_there_is_no_nodelet_manager(self):
        self.assertEqual(chain.publishers_of("/a/manager/bond"), [])
        self.assertEqual(chain.publishers_of("/a/map"), ["/a/occupancy_mapper"])


if __name__ == "__main__":
    chain.run("stand_alone", StandAlone)
