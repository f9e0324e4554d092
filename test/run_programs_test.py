#!/usr/bin/python3
"""simulate_bag and evaluate_run from the outside."""
import hashlib

import rosbag

import program_case
from program_case import ProgramCase

SHORT = ("--duration", "1.5")
ROBOT_TOPICS = {"odom", "ground_truth", "collisions", *(f"{c}/{t}" for c in ("reference", "right", "top")
                                                        for t in ("image_rect", "camera_info"))}


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


class SimulateBag(ProgramCase):
    def setUp(self):
        super().setUp()
        self.world = self.source / "worlds/corridor_crossing.yaml"

    def simulate(self, name, *options):
        path = self.folder / name
        answer = self.answer("simulate_bag", self.world, "--out", path, *SHORT, *options)
        return path, answer

    def test_one_seed_gives_one_bag(self):
        first, _ = self.simulate("first.bag", "--seed", "4")
        again, _ = self.simulate("again.bag", "--seed", "4")
        other, _ = self.simulate("other.bag", "--seed", "5")
        self.assertEqual(digest(first), digest(again))
        self.assertNotEqual(digest(first), digest(other))

    def test_what_a_bag_holds(self):
        path, answer = self.simulate("run.bag", "--robots", "b")
        self.assertEqual(answer["frames"], {"b": 16})  # 10 Hz, first and last frame included
        with rosbag.Bag(str(path)) as bag:
            topics = bag.get_type_and_topic_info().topics
            frames = {t.header.frame_id for _, m, _ in bag.read_messages("/tf") for t in m.transforms}
        self.assertEqual(set(topics), {"/tf", "/world", "/simulation_done", *("/b/" + t for t in ROBOT_TOPICS)})
        self.assertEqual(topics["/b/top/image_rect"].message_count, 16)
        # tf holds what the robot's driver knows, never the truth.
        self.assertEqual(frames, {"b/odom"})

    def test_bad_worlds(self):
        text = self.world.read_text()
        cases = (("missing.yaml", None, "missing.yaml"), ("empty.yaml", "", "empty.yaml"),
                 ("broken.yaml", "name: [", "broken.yaml"), ("other.yaml", "image: map.png\n", "other.yaml"),
                 ("binary.yaml", bytes(range(256)), "binary.yaml"),
                 ("unknown.yaml", text + "\nwindows: 3\n", "windows"),
                 ("mistyped.yaml", text.replace("ceiling_m: 2.7", "ceiling_m: high"), "ceiling_m"),
                 ("nan.yaml", text.replace("ceiling_m: 2.7", "ceiling_m: .nan"), "ceiling_m"),
                 ("walled.yaml", text.replace("start_m_m_deg: [-4.5, 0.0, 0]", "start_m_m_deg: [-4.5, 1.1, 0]"), "'a'"),
                 ("material.yaml", text.replace("material: books", "material: jelly"), "jelly"))
        for name, content, named in cases:
            with self.subTest(world=name):
                path = self.folder / name if content is None else self.file(name, content)
                self.assert_refused(named, "simulate_bag", path, "--out", "left_behind.bag")
                self.assert_no_bag()

    def assert_no_bag(self):
        self.assertEqual([p.name for p in self.folder.iterdir() if ".bag" in p.name], [])

    def test_bad_arguments(self):
        out = ("--out", "left_behind.bag")
        for named, arguments in (("usage", ()), ("--out", (self.world,)), ("--speed", (self.world, *out, "--speed", "3")),
                                 ("--seed", (self.world, *out, "--seed", "one")),
                                 ("--seed", (self.world, *out, "--seed", "1e99")),
                                 ("--duration", (self.world, *out, "--duration", "-1")),
                                 ("nobody", (self.world, *out, "--robots", "nobody")),
                                 ("absent.yaml", (self.world, *out, "--params", "absent.yaml")),
                                 ("/nowhere/x.bag", (self.world, "--out", "/nowhere/x.bag"))):
            with self.subTest(arguments=arguments):
                self.assert_refused(named, "simulate_bag", *arguments)
                self.assert_no_bag()

    def test_bad_parameters(self):
        text = (self.source / "config/simulator.yaml").read_text()
        for old, new, named in (("seed: 1 ", "seeed: 1 ", "seed"), ("width_px: 160", "width_px: wide", "width_px"),
                                ("width_px: 160", "width_px: -160", "width_px"), ("supersampling: 3", "supersampling: 0", "supersampling"),
                                ("baseline_m: 0.12", "baseline_m: -0.12", "baseline_m")):
            with self.subTest(change=new):
                self.assertIn(old, text)
                path = self.file("simulator.yaml", text.replace(old, new))
                self.assert_refused(named, "simulate_bag", self.world, "--out", "left_behind.bag", "--params", path)
                self.assert_no_bag()


class EvaluateRun(ProgramCase):
    def test_bad_input(self):
        bag = self.folder / "short.bag"
        self.answer("simulate_bag", self.source / "worlds/corridor_crossing.yaml", "--out", bag, *SHORT)
        whole = bag.read_bytes()
        for path in (self.folder / "missing.bag", self.file("empty.bag", b""), self.file("text.bag", "no bag"),
                     self.file("truncated.bag", whole[:len(whole) // 2]), self.file("maimed.bag", whole[:5000] + b"\x00" * 5000), self.folder):
            with self.subTest(path=path.name):
                self.assert_refused(path, "evaluate_run", path)

    def test_bad_arguments(self):
        self.assert_refused("usage", "evaluate_run")
        self.assert_refused("--world", "evaluate_run", "x.bag", "--world", "y")
        self.assert_refused("--range", "evaluate_run", "x.bag", "--range", "0")

    def test_a_recording_without_the_chain_is_no_answer(self):
        bag = self.folder / "short.bag"
        self.answer("simulate_bag", self.source / "worlds/corridor_crossing.yaml", "--out", bag, *SHORT)
        answer = self.answer("evaluate_run", bag, code=3)
        self.assertFalse(answer["registered"])
        self.assertEqual(answer["frames"], 0)


if __name__ == "__main__":
    program_case.main()
