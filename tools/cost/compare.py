#!/usr/bin/env python3
"""What `terrell check` says of time and memory beside what rendering takes: compare.py [--size 320x180] [MANIFEST ...]

Prints a table, and ends with 1 if anything is off by more than --within (0.3). Both are run one after the other on a machine that
should have nothing else to do. Without manifests: all of manifests/.
"""
import argparse
import glob
import os
import re
import subprocess
import sys
import tempfile
import time

TOP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0}
BYTES = {"MB": 1e6, "GB": 1e9}


def told(program, manifest, size):
    """Seconds and bytes that check says."""
    command = [program, "check", manifest, "--set", "picture.size=" + size.replace("x", " ")]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    span, unit = re.search(r"^  time +about ([\d.]+) (s|min|h) ", text, re.M).groups()
    memory, of = re.search(r"^  memory +about ([\d.]+) (MB|GB)", text, re.M).groups()
    return float(span) * SECONDS[unit], float(memory) * BYTES[of]


def taken(program, manifest, size, busy):
    """Seconds and bytes that rendering takes."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "render", manifest, "--size", size, "--out", folder]
        began = time.monotonic()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        took = time.monotonic() - began
    if status:
        sys.exit(f"{' '.join(command)} failed")
    if busy:
        took = (usage.ru_utime + usage.ru_stime) / os.cpu_count()
    return took, usage.ru_maxrss * 1024.0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("manifests", nargs="*")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--within", type=float, default=0.3)
    parser.add_argument("--busy", action="store_true", help="compare with the processor's time, where others use the machine")
    parser.add_argument("--program", default=os.path.join(TOP, "target", "release", "terrell"))
    given = parser.parse_args()
    manifests = given.manifests or sorted(glob.glob(os.path.join(TOP, "manifests", "*.yaml")))
    print(f"| manifest ({given.size}) | time told, s | taken, s | told / taken | memory told, MB | taken, MB | told / taken |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    worst = 1.0
    for manifest in manifests:
        says, does = told(given.program, manifest, given.size), taken(given.program, manifest, given.size, given.busy)
        ratios = [one / other for one, other in zip(says, does)]
        worst = max([worst] + [max(ratio, 1 / ratio) for ratio in ratios])
        name = os.path.splitext(os.path.basename(manifest))[0]
        print(f"| {name} | {says[0]:.3g} | {does[0]:.3g} | {ratios[0]:.2f} | {says[1] / 1e6:.0f} | {does[1] / 1e6:.0f} | {ratios[1]:.2f} |", flush=True)
    print(f"\nat worst off by a factor of {worst:.2f}")
    return worst > 1 + given.within


if __name__ == "__main__":
    sys.exit(main())
