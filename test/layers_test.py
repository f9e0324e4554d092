#!/usr/bin/python3
"""Proves the layers: each area includes only what the table below lets it, and the core library knows no ROS.

usage: layers_test.py SOURCE_DIR CORE_LIBRARY
Debian keeps ROS headers in /usr/include, so a successful compile proves nothing.
"""
import re
import subprocess
import sys
from pathlib import Path

AREAS = {
    "base": [],
    "stereo": ["base"],
    "scan": ["base", "stereo"],
    "mapping": ["base", "scan"],
    "landmarks": ["base", "mapping"],
    "registration": ["base", "landmarks", "mapping"],
    "simulation": ["base", "stereo", "mapping"],
    "pipeline": ["base", "stereo", "scan", "mapping", "landmarks", "registration"],
}
ROS_HEADER = re.compile(r'#include [<"](ros|tf2|tf2_\w+|\w+_msgs|nodelet|pluginlib|rosbag|cv_bridge|image_transport|'
                        r'message_filters|diagnostic_updater|dynamic_reconfigure|std_srvs|XmlRpc)\b')
OWN_HEADER = re.compile(r'#include "cornerstone/(\w+)(/|\.h)')


def include_faults(source_dir):
    faults, files = [], 0
    for area, may in AREAS.items():
        for path in [*source_dir.glob(f"include/cornerstone/{area}/*.h"), *source_dir.glob(f"src/{area}/*")]:
            files += 1
            for number, line in enumerate(path.read_text().splitlines(), 1):
                own = OWN_HEADER.match(line)
                if own and own[1] != area and own[1] not in may:
                    faults.append(f"{path}:{number}: {area} may not include {own[1]}")
                if ROS_HEADER.match(line):
                    faults.append(f"{path}:{number}: {area} may not include ROS: {line}")
    if files < len(AREAS):
        faults.append(f"only {files} files found under {source_dir}: the check looked in the wrong place")
    return faults


def symbol_faults(library):
    symbols = subprocess.run(["nm", "-D", "--undefined-only", "-C", library], capture_output=True, text=True, check=True).stdout
    needed = subprocess.run(["readelf", "-d", library], capture_output=True, text=True, check=True).stdout
    faults = [f"{library} uses {s.strip()}" for s in symbols.splitlines() if re.search(r" (ros|tf2|tf2_ros|nodelet)::", s)]
    faults += [f"{library} links {lib}" for lib in re.findall(r"\[(libros\w+|libtf2\w*|libnodelet\w*)", needed)]
    return faults


def main():
    faults = include_faults(Path(sys.argv[1])) + symbol_faults(sys.argv[2])
    print("\n".join(faults) or "the layers hold")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
