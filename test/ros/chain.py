"""What the system tests share: playing bags without a race at the start, keeping what was published, poses."""
import bisect
import math
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import xml.etree.ElementTree as ElementTree
import xmlrpc.client

import rosbag
import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry
from sensor_msgs.msg import LaserScan
from std_srvs.srv import SetBool

from cornerstone.msg import CornerArray, MapTiles

CALLER = "/system_test"


def wait_until(true, what, timeout_s=30.0, period_s=0.05):
    """By the wall clock: simulated time stands still while nothing plays."""
    end = time.monotonic() + timeout_s
    while time.monotonic() < end:
        value = true()
        if value:
            return value
        time.sleep(period_s)
    raise AssertionError(f"after {timeout_s} s still waiting for {what}")


def subscribers_of(topic):
    _, subscribers, _ = rosgraph.Master(CALLER).getSystemState()
    return [node for name, nodes in subscribers if name == topic for node in nodes]


def publishers_of(topic):
    publishers, _, _ = rosgraph.Master(CALLER).getSystemState()
    return [node for name, nodes in publishers if name == topic for node in nodes]


def connected(publisher, topic):
    """The nodes that a publishing node is connected to on a topic."""
    api = rosgraph.Master(CALLER).lookupNode(publisher)
    infos = xmlrpc.client.ServerProxy(api).getBusInfo(CALLER)[2]
    names = []
    for info in infos:
        if info[2] == "o" and info[4] == topic and (len(info) < 6 or info[5]):
            names.append(info[1])
    return names


class Player:
    """rosbag play, paused until everybody who has subscribed is connected."""

    def __init__(self, bags, rate, extra=()):
        self.name = "/player"
        self.topics = {"/clock"}
        for path in bags:
            with rosbag.Bag(path) as bag:
                self.topics |= set(bag.get_type_and_topic_info().topics)
        # rosrun becomes the player itself, and it ends with the test even when that is killed.
        command = ["setpriv", "--pdeathsig", "TERM", "rosrun", "rosbag", "play", "--clock", "--hz=100", "--pause", "--quiet",
                   "-r", str(rate), *extra, *bags, "__name:=player"]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL)

    def start(self, expected):
        """expected: {topic of the bags: names of the nodes that must be connected before the first message is played}."""
        expected = {topic: set(nodes) for topic, nodes in expected.items() if topic in self.topics}

        def all_there():
            if self.process.poll() is not None:
                raise AssertionError("rosbag play ended before it was started")
            try:
                return all(nodes <= set(connected(self.name, topic)) for topic, nodes in expected.items())
            except (rosgraph.MasterException, xmlrpc.client.Error, OSError):
                return False
        wait_until(all_there, f"connections of {expected}", 60)
        rospy.wait_for_service(self.name + "/pause_playback", 30)
        rospy.ServiceProxy(self.name + "/pause_playback", SetBool)(False)
        return self

    def wait(self, timeout_s):
        code = self.process.wait(timeout_s)
        if code != 0:
            raise AssertionError(f"rosbag play ended with code {code}")

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait(20)


class Recorder:
    """Every message of some topics, in order of arrival."""

    def __init__(self, topics):
        self.lock = threading.Lock()
        self.messages = {topic: [] for topic in topics}
        self.subscribers = [rospy.Subscriber(topic, kind, self._take, topic, queue_size=1000, buff_size=1 << 24)
                            for topic, kind in topics.items()]

    def _take(self, message, topic):
        with self.lock:
            self.messages[topic].append(message)

    def of(self, topic):
        with self.lock:
            return list(self.messages[topic])

    def last(self, topic):
        found = self.of(topic)
        return found[-1] if found else None


class Diagnostics:
    """The newest report of every stage, by name: "/a/mapper" -> {"message": ..., "level": ..., key: value}."""

    def __init__(self):
        self.lock = threading.Lock()
        self.newest = {}
        self.reports = {}  # how many have come
        self.complaints = {}  # every summary ever seen at level ERROR
        self.subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self._take, queue_size=100)

    def _take(self, message):
        with self.lock:
            for status in message.status:
                node = "/" + status.name.split(":")[0].strip("/")
                values = {value.key: value.value for value in status.values}
                self.newest[node] = dict(values, message=status.message, level=status.level)
                self.reports[node] = self.reports.get(node, 0) + 1
                if status.level == 2:
                    self.complaints.setdefault(node, set()).add(status.message)

    def of(self, node):
        with self.lock:
            return dict(self.newest.get(node, {}))

    def forget(self, node):
        """A node of the same name is about to start."""
        with self.lock:
            self.newest.pop(node, None)

    def complaints_of(self, node):
        with self.lock:
            return set(self.complaints.get(node, ()))

    def count(self, node, key):
        return int(float(self.of(node).get(key, 0)))

    def settled(self, node, keys):
        """The counts when two reports in a row agree: all that was played has come in, however busy the machine."""
        counts = []

        def agree():
            with self.lock:
                number, report = self.reports.get(node, 0), self.newest.get(node, {})
            if not counts or counts[-1][0] != number:
                counts.append((number, [int(float(report.get(key, 0))) for key in keys]))
            # The first report may be of before; the two after it are of now.
            return len(counts) > 2 and counts[-1][1] == counts[-2][1]
        wait_until(agree, f"{node} to settle", 60)
        return counts[-1][1]


class Pose2:
    """a_from_b in the plane, as the core has it."""

    def __init__(self, x, y, yaw):
        self.x, self.y, self.yaw = x, y, yaw

    def __mul__(self, other):
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(self.x + c * other.x - s * other.y, self.y + s * other.x + c * other.y, self.yaw + other.yaw)

    def inverse(self):
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(-c * self.x - s * self.y, s * self.x - c * self.y, -self.yaw)

    def distance_to(self, other):
        return math.hypot(self.x - other.x, self.y - other.y)

    def angle_to_deg(self, other):
        turn = self.yaw - other.yaw
        return math.degrees(abs(math.atan2(math.sin(turn), math.cos(turn))))


def yaw_of(q):
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


def pose_of_transform(transform):
    return Pose2(transform.translation.x, transform.translation.y, yaw_of(transform.rotation))


class Truth:
    """A robot's true pose in the world at any time of the recording."""

    def __init__(self, messages):
        self.times = [m.header.stamp.to_sec() for m in messages]
        self.poses = [Pose2(m.pose.pose.position.x, m.pose.pose.position.y, yaw_of(m.pose.pose.orientation)) for m in messages]

    def at(self, stamp_s):
        """The message nearest to the stamp; truth comes at 50 Hz."""
        i = bisect.bisect_left(self.times, stamp_s)
        near = [k for k in (i - 1, i) if 0 <= k < len(self.times)]
        return self.poses[min(near, key=lambda k: abs(self.times[k] - stamp_s))]


def relative_errors(tf, robots, truths, span_s):
    """[(m, degrees)] every half second: the second robot in the first one's body frame, by tf against the truth."""
    (first, second), (stamp, end), errors = robots, span_s, []
    while stamp < end:
        known = pose_of_transform(tf.lookup_transform(f"{first}/base_link", f"{second}/base_link", rospy.Time(stamp)).transform)
        true = truths[0].at(stamp).inverse() * truths[1].at(stamp)
        errors.append((known.distance_to(true), known.angle_to_deg(true)))
        stamp += 0.5
    return errors


def between_maps(tf_messages):
    """Every transform that links the two robots' maps, in any direction."""
    return [t for message in tf_messages for t in message.transforms
            if {t.header.frame_id, t.child_frame_id} == {"a/map", "b/map"}
            or (t.child_frame_id.endswith("/map") and t.header.frame_id.endswith("/map"))]


CAMERAS = ("reference", "right", "top")


def connections_of(robots, nodes=None):
    """What must be connected before a bag of these robots is played; nodes: {robot: node that takes its images}."""
    nodes = nodes or {robot: f"/{robot}/manager" for robot in robots}
    expected = {"/tf": set(nodes.values()) | {rospy.get_name()}, "/clock": set(nodes.values()) | {rospy.get_name()}}
    for robot in robots:
        for camera in CAMERAS:
            expected[f"/{robot}/{camera}/image_rect"] = {nodes[robot]}
            expected[f"/{robot}/{camera}/camera_info"] = {nodes[robot]}
        expected[f"/{robot}/ground_truth"] = {rospy.get_name()}
    return expected


def wait_for_robots(robots):
    """Until every nodelet of these robots has started: each advertises something that is its own."""
    for robot in robots:
        for topic in ("disparity", "map", "landmarks"):
            wait_until(lambda t=f"/{robot}/{topic}": publishers_of(t), f"a publisher of /{robot}/{topic}", 60)
        wait_until(lambda t=f"/{robot}/map_tiles": subscribers_of(t), f"a subscriber of /{robot}/map_tiles", 60)


def robot_topics(robot):
    return {f"/{robot}/map": OccupancyGrid, f"/{robot}/map_updates": OccupancyGridUpdate,
            f"/{robot}/map_metadata": MapMetaData, f"/{robot}/map_tiles": MapTiles,
            f"/{robot}/landmarks": CornerArray, f"/{robot}/stereo_scan": LaserScan,
            f"/{robot}/ground_truth": Odometry}


class _Result(unittest.TextTestResult):
    """Remembers what passed, so that the report names every test; rosunit's own loses faults of setUpClass."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.passed = []

    def addSuccess(self, test):
        super().addSuccess(test)
        self.passed.append(test)

    # At once, so that a test that hangs later does not hide it.
    def addFailure(self, test, err):
        super().addFailure(test, err)
        self.stream.writeln(self.failures[-1][1])

    def addError(self, test, err):
        super().addError(test, err)
        self.stream.writeln(self.errors[-1][1])


def run(name, case):
    """The main of a system test: runs the case and writes the report where rostest wants it."""
    target = next(word.split(":", 1)[1] for word in sys.argv if word.startswith("--gtest_output=xml:"))
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(case)
    result = unittest.TextTestRunner(verbosity=2, resultclass=_Result).run(suite)
    root = ElementTree.Element("testsuite", name=name, tests=str(result.testsRun), time="0",
                               errors=str(len(result.errors)), failures=str(len(result.failures)))
    outcomes = [(test, None, "") for test in result.passed]
    outcomes += [(test, "failure", text) for test, text in result.failures]
    outcomes += [(test, "error", text) for test, text in result.errors]
    for test, kind, text in outcomes:
        entry = ElementTree.SubElement(root, "testcase", classname=name, name=str(test).split(" ")[0], time="0")
        if kind:
            ElementTree.SubElement(entry, kind, type=kind, message=text.strip().splitlines()[-1]).text = text
    os.makedirs(os.path.dirname(target), exist_ok=True)
    ElementTree.ElementTree(root).write(target)
    sys.exit(0 if result.wasSuccessful() else 1)
