#!/usr/bin/env python3
"""How terrell's time and memory grow: growth.py FOLDER [--quick] [--runs 5] [--terrell PROGRAM] [--only bodies,triangles,lamps,threads,pixels] [--chart]

  bodies     1 to 10,000 heads in the same part of the picture, each at 0.5 c its own way; and all at rest
  triangles  1k to 10M in one sheet
  lamps      1 to 64 over one head
  threads    1 to all that there are
  pixels     320 x 180 to 3840 x 2160

One sample, pictures of 320 x 180 for bodies, 640 x 360 otherwise. Goes on where it was stopped (FOLDER/growth.jsonl); leaves growth.csv and growth.svg.
--quick: the small half of each, one run. What takes more than a minute for a picture is not tried with more.
"""
import argparse
import csv
import math
import os
import sys

import numpy as np
import yaml

from chart import Panel, sheet_of
from clock import HERE, Ledger, Terrell
from manifests import COUNT, placement, three

sys.path.insert(0, os.path.join(HERE, "..", "import"))
import million  # noqa: E402

HEAD, STUDIO = (os.path.abspath(os.path.join(HERE, "..", "..", "assets", name)) for name in ("monkey.glb", "studio.glb"))
LIMIT = 60.0  # seconds a picture
ENOUGH = 1.0  # seconds of pictures that are timed


def manifest(assets, bodies, lamps, eye, direction, size):
    """A scene with an observer on a tiny ring, as those of manifests.py."""
    written = {
        "light_speed": "1 m/s",
        "assets": assets,
        "bodies": bodies,
        "lights": [{"lamp": {"intensity": f"{cd} cd"}, "at": f"{three(at)} m"} for at, cd in lamps],
        "observer": {
            "ring": {"centre": f"{three(eye)} m", "radius": "0.0001 m"},
            "direction": three(direction),
        },
        "exposures": {"at": "0 s", "count": COUNT},
        "picture": {"size": f"{size[0]} {size[1]}", "samples": 1, "filter": "box", "white": "40 cd/m2"},
        "film": {"rate": 24, "video": "off"},
        "output": "out",
    }
    return yaml.safe_dump(written, sort_keys=False, width=200)


LAMPS = [((6.0, 8.0, 6.0), 3000), ((-6.0, 5.0, 6.0), 1500)]


def heads(count, speed, size):
    """Heads in rows 12 m away, in all as large however many; each appears in its place."""
    side = math.ceil(math.sqrt(count))
    cell, eye = 8 / math.sqrt(count), np.array([0, 0, 12.0])
    bodies = []
    for number in range(count):
        at = np.array([(number % side - (side - 1) / 2) * cell, ((side - 1) / 2 - number // side) * cell * 0.56, 0])
        # Evenly over all directions (Fibonacci's sphere).
        y, turn = 1 - (2 * number + 1) / count, 2.399963 * number
        velocity = speed * np.array([math.sqrt(1 - y * y) * math.cos(turn), y, math.sqrt(1 - y * y) * math.sin(turn)])
        # The light that is seen at time 0 left its middle there.
        seen = placement(velocity, (-np.linalg.norm(at - eye), at))
        bodies.append({"asset": "head", "name": f"head{number}", "scale": cell * 0.25, **seen})
    return manifest({"head": HEAD}, bodies, LAMPS, eye, (0, 0, -1), size)


def sheet(folder, triangles, size):
    squares = round(math.sqrt(triangles / 2))
    path = os.path.join(folder, f"sheet{triangles}.glb")
    if not os.path.exists(path):
        million.write_glb(path, *million.sheet(squares))
    eye = np.array([0, 7.0, 7.0])
    body = {"asset": "sheet", "at": "-5 0 -5 m"}
    return manifest({"sheet": path}, [body], LAMPS, eye, (0, -1, -1), size)


def lit(count, size):
    """A head on its floor under lamps on a circle, together as bright as two."""
    ring = [((6 * math.cos(a), 5.0, 6 * math.sin(a)), 3000 / count) for a in (2 * math.pi * (k + 0.3) / count for k in range(count))]
    bodies = [{"asset": "head", "at": "0 1.05 0 m"}, {"asset": "floor"}]
    assets = {"head": HEAD, "floor": {"file": STUDIO, "lights": "off"}}
    return manifest(assets, bodies, ring, (0, 1.6, 6), (0, -0.1, -1), size)


def points(folder, quick):
    """Everything that is measured: kind, line, how many, manifest, flags."""
    up_to = lambda values, small: [v for v in values if not quick or v <= small]
    small, plain = (320, 180), (640, 360)
    for count in up_to((1, 10, 100, 1000, 10000), 100):
        yield "bodies", "each its own velocity", count, heads(count, 0.5, small), []
        yield "bodies", "at rest", count, heads(count, 0.0, small), []
    for count in up_to((1000, 10_000, 100_000, 1_000_000, 10_000_000), 100_000):
        yield "triangles", "", count, sheet(folder, count, plain), []
    for count in up_to((1, 2, 4, 8, 16, 32, 64), 8):
        yield "lamps", "", count, lit(count, plain), []
    threads = os.cpu_count() or 1
    for count in sorted({1, 2, threads} & set(range(1, threads + 1))):
        yield "threads", "", count, lit(2, plain), ["--threads", str(count)]
    for wide in up_to((320, 640, 1280, 1920, 3840), 640):
        size = wide, wide * 9 // 16
        yield "pixels", "", size[0] * size[1], lit(2, size), []


def measure(terrell, path, flags):
    """A picture's seconds, from as many as take a second; and those of the first, with all that comes before it."""
    one = terrell.one(path, *flags)
    film = terrell.film(path, 3, one, *flags)
    if film["seconds"] < ENOUGH / 2:
        film = terrell.film(path, min(COUNT, 2 + math.ceil(ENOUGH / max(film["seconds"], 1e-3))), one, *flags)
    return {**film, "megabytes": one["megabytes"], "first": one["seconds"]}


KINDS = ("bodies", "triangles", "lamps", "threads", "pixels")


def draw(ledger, path):
    """The chart and the numbers."""
    of = sorted({k[:-1] for k in ledger.rows}, key=lambda k: (KINDS.index(k[0]), k[1], k[2]))

    def lines(kind, key):
        names = dict.fromkeys(k[1] for k in of if k[0] == kind)
        return [(line, [(k[2], ledger.median(*k, key=key)) for k in of if k[:2] == (kind, line)]) for line in names]

    panels = [Panel(f"{kind}: a picture", kind, "s", lines(kind, "seconds")) for kind in KINDS if lines(kind, "seconds")]
    if lines("triangles", "first"):
        panels.append(Panel("triangles: from the file to the first picture", "triangles", "s", lines("triangles", "first")))
        panels.append(Panel("triangles: largest memory", "triangles", "MB", lines("triangles", "megabytes")))
    if lines("bodies", "megabytes"):
        panels.append(Panel("bodies: largest memory", "bodies", "MB", lines("bodies", "megabytes")))
    with open(path + ".svg", "w") as file:
        file.write(sheet_of("How time and memory grow", panels))
    with open(path + ".csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["kind", "line", "number", "seconds", "processor", "first", "megabytes"])
        for k in of:
            writer.writerow([*k, *(f"{ledger.median(*k, key=key):.5g}" for key in ("seconds", "processor", "first", "megabytes"))])


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--runs", type=int)
    parser.add_argument("--terrell", default=os.path.join(HERE, "..", "..", "target", "release", "terrell"))
    parser.add_argument("--only", default=",".join(KINDS))
    parser.add_argument("--chart", action="store_true")
    a = parser.parse_args()
    folder = os.path.join(os.path.abspath(a.folder), "growth-quick" if a.quick else "growth")
    os.makedirs(folder, exist_ok=True)
    ledger = Ledger(os.path.join(folder, "growth.jsonl"))
    terrell = Terrell(a.terrell, folder)
    for run in range(0 if a.chart else a.runs or (1 if a.quick else 5)):
        slow = {}
        for kind, line, count, text, flags in points(folder, a.quick):
            of = kind, line, count, run
            if kind not in a.only.split(",") or slow.get((kind, line), 0) > LIMIT:
                continue
            if not ledger.has(*of):
                path = os.path.join(folder, "scene.yaml")
                with open(path, "w") as file:
                    file.write(text)
                ledger.take(of, measure(terrell, path, flags))
            # Ten times as many may take ten times as long.
            slow[kind, line] = 10 * ledger.rows[of]["seconds"] if kind == "bodies" else ledger.rows[of]["seconds"]
    draw(ledger, os.path.join(folder, "growth"))


if __name__ == "__main__":
    main()
