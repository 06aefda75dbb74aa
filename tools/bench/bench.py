#!/usr/bin/env python3
"""terrell against Mitsuba, Cycles and POV-Ray, and in motion against itself at rest.

usage: bench.py FOLDER [--quick] [--runs 5] [--terrell PROGRAM] [--scenes mesh1m,inst100,spheres] [--without cycles,povray]
       [--cases "terrell rest 1,mitsuba 1"] [--table]

Makes the models and manifests in FOLDER if they are not there, sees that terrell and Mitsuba make the same picture, and times all programs in turn, --runs times.
Goes on where it was stopped (FOLDER/bench.jsonl); leaves bench.csv and bench.md there. --quick: coarse models, 640 x 360, two runs, in FOLDER/quick.
--cases: only these, as bench.csv names them. --table: only the tables, of what was measured.
"""
import argparse
import os
import subprocess
import sys

import manifests
from clock import HERE, Ledger, Peer, Terrell
from tables import write_tables

SCENES = ("mesh1m", "inst100", "spheres")


def arguments():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--runs", type=int)
    parser.add_argument("--terrell", default=os.path.join(HERE, "..", "..", "target", "release", "terrell"))
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--without", default="")
    parser.add_argument("--cases")
    parser.add_argument("--table", action="store_true")
    a = parser.parse_args()
    a.folder = os.path.join(a.folder, "quick") if a.quick else a.folder
    a.runs = a.runs or (2 if a.quick else 5)
    a.size, a.scenes, a.without = (640, 360) if a.quick else (1280, 720), a.scenes.split(","), a.without.split(",")
    return a


class Bench:
    """One scene's programs, and what was measured of them."""

    def __init__(self, a, scene, ledger):
        self.a, self.scene, self.ledger = a, scene, ledger
        self.model = os.path.join(a.folder, scene + ".glb")
        self.manifest = manifests.write_all(a.folder, scene, size=a.size)
        self.terrell = Terrell(a.terrell, a.folder)
        self.size = ["--size", f"{a.size[0]}x{a.size[1]}"]
        self.peers, self.singles = {}, {}

    def ours(self, kind, samples):
        """A picture's part of a film."""
        if kind not in self.singles:
            self.singles[kind] = self.terrell.one(self.manifest[kind])
        count = 9 if samples == 1 else 2
        return self.terrell.film(self.manifest[kind], count, self.singles[kind], "--samples", str(samples), samples=samples)

    def film(self, video):
        """Of a still film each picture but the first is developed and written (and encoded), and nothing else."""
        more = ["--set", "exposures.count=48", "--set", f"film.video={video}"]
        one = self.terrell.one(self.manifest["still"])
        return self.terrell.film(self.manifest["still"], 48, one, *more)

    def peer(self, script, *more):
        key = (script, *more)
        if key not in self.peers:
            self.peers[key] = Peer(script, self.model, *self.size, *more)
        return self.peers[key].picture()

    def first(self, script):
        """The first picture from the file, counted from when the libraries are loaded."""
        peer = Peer(script, self.model, *self.size)
        peer.close()
        return {"seconds": peer.facts["build"] + peer.facts["first"], **{k: peer.facts[k] for k in ("build", "first", "whole", "megabytes")}}

    def cases(self):
        """What is measured in turn, by name."""
        has = lambda peer: peer not in self.a.without
        all_ = {f"terrell {kind} {samples}": lambda kind=kind, samples=samples: self.ours(kind, samples) for kind, samples in
                (("rest", 1), ("rest", 16), ("white", 1), ("together", 1), ("apart", 1))}
        all_["terrell first"] = lambda: self.singles.get("rest") or self.terrell.one(self.manifest["rest"])
        if self.scene == "mesh1m":
            all_["terrell still"] = lambda: self.film("off")
            all_["terrell filmed"] = lambda: self.film("on")
        if has("mitsuba"):
            for samples in (1, 16):
                all_[f"mitsuba {samples}"] = lambda samples=samples: self.peer("in_mitsuba.py", "--samples", str(samples))
            if self.scene == "spheres":
                all_["mitsuba picks 1"] = lambda: self.peer("in_mitsuba.py", "--pick")
                all_["mitsuba picks 16"] = lambda: self.peer("in_mitsuba.py", "--pick", "--samples", "16")
            all_["mitsuba first"] = lambda: self.first("in_mitsuba.py")
        if has("povray"):
            all_["povray 1"] = lambda: self.peer("in_povray.py")
        if has("cycles"):
            all_["cycles 2"] = lambda: self.peer("in_cycles.py", "--samples", "2")
            all_["cycles first"] = lambda: self.first("in_cycles.py")
        wanted = self.a.cases.split(",") if self.a.cases else all_
        return {name: measure for name, measure in all_.items() if name in wanted}

    def check(self):
        """Whether terrell and Mitsuba make the same picture, with white lamps (coloured ones differ by what spectra are); by a process that has Mitsuba."""
        out = os.path.join(self.a.folder, "check-" + self.scene)
        terrell = Terrell(self.a.terrell, out)
        terrell.one(self.manifest["white"], "--set", "output.exr=on")
        theirs = os.path.join(out, "mitsuba.npy")
        Peer("in_mitsuba.py", self.model, *self.size, "--white", "--save", theirs).close()
        same = [sys.executable, os.path.join(HERE, "same.py")]
        said = subprocess.run([*same, os.path.join(terrell.out, "0000.exr"), theirs], capture_output=True, text=True, check=True).stdout
        mean, median, share = map(float, said.split())
        self.ledger.take((self.scene, "check", 0), {"mean": mean, "median": median, "share": share})

    def run(self):
        if "mitsuba" not in self.a.without and not self.ledger.has(self.scene, "check", 0):
            self.check()
        cases = self.cases()
        for turn in range(self.a.runs):
            for name, measure in cases.items():
                if not self.ledger.has(self.scene, name, turn):
                    self.ledger.take((self.scene, name, turn), measure())
            self.singles.clear()
        for peer in self.peers.values():
            peer.close()


def main():
    a = arguments()
    os.makedirs(a.folder, exist_ok=True)
    ledger = Ledger(os.path.join(a.folder, "bench.jsonl"))
    if not a.table:
        if not all(os.path.exists(os.path.join(a.folder, scene + ".glb")) for scene in a.scenes):
            subprocess.run([sys.executable, os.path.join(HERE, "scenes.py"), a.folder] + ["--quick"] * a.quick, check=True, stdout=subprocess.DEVNULL)
        for scene in a.scenes:
            Bench(a, scene, ledger).run()
    write_tables(ledger, a.scenes, os.path.join(a.folder, "bench"))


if __name__ == "__main__":
    main()
