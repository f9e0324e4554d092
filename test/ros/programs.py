"""Nodes as programs of a test: parameters of config/ with changes, start, output, end."""
import copy
import math
import os
import signal
import subprocess
import tempfile

import rospkg
import rospy
import tf2_ros
import yaml
from geometry_msgs.msg import TransformStamped


def parameters_of(name, **changes):
    """config/<name>.yaml with top-level keys changed; None takes a key away."""
    with open(f"{rospkg.RosPack().get_path('cornerstone')}/config/{name}.yaml", encoding="utf-8") as file:
        parameters = copy.deepcopy(yaml.safe_load(file))
    for key, value in changes.items():
        if value is None:
            del parameters[key]
        else:
            parameters[key] = value
    return parameters


def load_parameters(name, node, **changes):
    if rospy.has_param(node):
        rospy.delete_param(node)
    rospy.set_param(node, parameters_of(name, **changes))


def rotation(roll, pitch, yaw):
    """Quaternion (x, y, z, w) of a turn about fixed x, y, z."""
    cr, sr, cp, sp, cy, sy = (f(angle / 2) for angle in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy)


def static_mounting(robot, height_m=0.4):
    """The mounting that launch/robot.launch publishes."""
    def stamped(parent, child, z, q):
        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = parent, child
        transform.transform.translation.z = z
        r = transform.transform.rotation
        r.x, r.y, r.z, r.w = q
        return transform
    broadcaster = tf2_ros.StaticTransformBroadcaster()
    broadcaster.sendTransform([
        stamped(f"{robot}/base_link", f"{robot}/reference", height_m, (0, 0, 0, 1)),
        stamped(f"{robot}/reference", f"{robot}/reference_optical", 0, rotation(-math.pi / 2, 0, -math.pi / 2))])
    return broadcaster


class Node:
    """A program with its output in a file."""

    def __init__(self, *command):
        self.output = tempfile.TemporaryFile(mode="w+", encoding="utf-8", errors="replace")
        self.process = subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *command], stdin=subprocess.DEVNULL, stdout=self.output, stderr=subprocess.STDOUT)

    def text(self):
        self.output.seek(0)
        return self.output.read()

    def wait(self, timeout_s):
        """Exit code; a program that goes on running is an AssertionError."""
        try:
            return self.process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            self.stop()
            raise AssertionError(f"still running after {timeout_s} s:\n{self.text()}") from None

    def stop(self):
        if self.process.poll() is None:
            os.kill(self.process.pid, signal.SIGINT)
            try:
                self.process.wait(20)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        return self.process.returncode
