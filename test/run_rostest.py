#!/usr/bin/python3
"""Runs one rostest and makes sure that a test which could not start, or ended without a result, is a failure.

usage: run_rostest.py BUILD_DIR TEST_FILE [ARG:=VALUE ...]

Each test has a master of its own (rostest picks a free port) and its own home for logs and results under
BUILD_DIR/test_results/<name>, so that tests neither meet one another nor write into the user's ~/.ros.
"""
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def environment(build, home):
    """The environment of the devel space and nothing that the caller's shell carries along."""
    clean = {"PATH": "/usr/bin:/bin", "HOME": str(home), "LANG": "C.UTF-8"}
    script = f'. "{build}/devel/setup.sh" && env -0'
    out = subprocess.run(["sh", "-c", script], env=clean, capture_output=True, check=True).stdout.decode()
    variables = dict(entry.split("=", 1) for entry in out.split("\0") if "=" in entry)
    variables.update(ROS_HOME=str(home), ROS_LOG_DIR=str(home / "log"), PYTHONUNBUFFERED="1",
                     PYTHONDONTWRITEBYTECODE="1", ROS_TEST_RESULTS_DIR=str(home / "results"))
    return variables


def judge(results):
    """What is wrong with the result files: a list of texts, empty when every test passed."""
    files = sorted(results.rglob("*.xml"))
    faults, tests = [], 0
    for file in files:
        root = ElementTree.parse(file).getroot()
        # A fault outside of a test (in setUpClass) is counted without a test case.
        if int(root.get("errors", 0)) + int(root.get("failures", 0)) > 0:
            faults.append(f"{file.name}: {root.get('errors')} errors, {root.get('failures')} failures")
            faults += [text for text in map(str.strip, root.itertext()) if text]
        for case in root.iter("testcase"):
            tests += 1
            print(f"  {case.get('classname')}.{case.get('name')}")
    # rostest's own file tells only whether the test program ran; the tests are in that program's file.
    if len(files) < 2 or tests < 2:
        faults.append(f"only {tests} test cases in {len(files)} result files: the test did not run")
    return faults


def main():
    build, test_file = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    home = build / "test_results" / test_file.stem
    shutil.rmtree(home, ignore_errors=True)
    home.mkdir(parents=True)
    command = ["rostest", "--results-base-dir", str(home / "results"), "--results-filename", test_file.stem + ".xml",
               "--pkgdir", str(test_file.parents[2]), "--package", "cornerstone", str(test_file), *sys.argv[3:]]
    code = subprocess.run(command, env=environment(build, home), stdin=subprocess.DEVNULL, check=False).returncode
    faults = judge(home / "results")
    if code != 0:
        faults.append(f"rostest ended with code {code}")
    for fault in faults:
        print("FAULT " + fault)
    if faults:
        for log in sorted((home / "log").rglob("*test*.log"))[-3:]:
            print(f"--- end of {log}\n" + "\n".join(log.read_text(errors="replace").splitlines()[-40:]))
    return 1 if faults else 0


if __name__ == "__main__":
    os.umask(0o022)
    sys.exit(main())
