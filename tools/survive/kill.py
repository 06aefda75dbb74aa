#!/usr/bin/env python3
"""Kills terrell at random moments, again and again, and sees whether its films come out the same: kill.py [--kills 300] [--terrell PROGRAM] [--seed 1] [--manifest MANIFEST]

Each film is rendered by the same command until it ends by itself; by one process at a time, and then by two or three at once. Each process gets SIGKILL, SIGINT or
SIGTERM, or is left alone. After each round every file under a final name must have the bytes that an uninterrupted film has, and in the end nothing else may be there.
"""
import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SIGNALS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)
MANIFEST = os.path.join(HERE, "..", "..", "tests", "survive", "film.yaml")


def start(program, folder):
    return subprocess.Popen([program, "render", "film.yaml"], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def place(manifest):
    folder = tempfile.TemporaryDirectory()
    shutil.copy(manifest, os.path.join(folder.name, "film.yaml"))
    return folder


def contents(folder, hidden=True):
    out = os.path.join(folder, "out")
    names = [name for name in (os.listdir(out) if os.path.isdir(out) else []) if hidden or not name.startswith(".")]
    found = {}
    for name in names:
        with open(os.path.join(out, name), "rb") as file:
            found[name] = file.read()
    return found


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--terrell", default=os.path.join(HERE, "..", "..", "target", "release", "terrell"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--manifest", default=MANIFEST)
    a = parser.parse_args()
    random.seed(a.seed)
    program = os.path.abspath(a.terrell)
    with place(a.manifest) as folder:
        began = time.monotonic()
        start(program, folder).communicate()
        takes, whole = time.monotonic() - began, contents(folder)
    kills, films, wrong = 0, 0, []
    while kills < a.kills:
        at_once = films % 2  # One at a time, then several.
        with place(a.manifest) as folder:
            ended = False
            while not ended:
                processes = [start(program, folder) for _ in range(random.choice((2, 3)) if at_once else 1)]
                for process in processes:
                    time.sleep(random.uniform(0, takes / (4 if at_once else 2)))
                    if process.poll() is None and random.random() < 0.9:
                        process.send_signal(random.choice(SIGNALS))
                        kills += 1
                for process in processes:
                    said = process.communicate(timeout=60)[1]
                    ended |= process.returncode == 0
                    if process.returncode > 0:
                        wrong.append(said)
                wrong += [f"{name} is not whole" for name, bytes_ in contents(folder, hidden=False).items() if whole.get(name) != bytes_]
            films += 1
            if contents(folder) != whole:
                wrong.append(f"film {films} is another")
    print(f"{kills} kills, {films} films, {len(wrong)} faults")
    for line in wrong[:10]:
        print(line, file=sys.stderr)
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
