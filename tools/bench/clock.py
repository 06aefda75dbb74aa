"""Timing terrell and its peers in turn, and keeping what was measured."""
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))


def largest_memory(pid):
    """The largest memory of a process so far, MB. (What `wait4` says counts what Python had when it started the process.)"""
    try:
        with open(f"/proc/{pid}/status") as file:
            return next((int(line.split()[1]) / 1024 for line in file if line.startswith("VmHWM")), 0.0)
    except OSError:
        return 0.0


def run(command):
    """Runs a command to its end: seconds by the clock and of the processor, and the largest memory in MB."""
    began = time.perf_counter()
    with tempfile.TemporaryFile("w+") as said:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=said)
        megabytes, pid = 0.0, 0
        while pid == 0:
            megabytes = max(megabytes, largest_memory(process.pid))
            time.sleep(0.005)
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        seconds = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            said.seek(0)
            raise SystemExit(f"{' '.join(command)}\n{said.read()[-2000:]}")
    return {"seconds": seconds, "processor": usage.ru_utime + usage.ru_stime, "megabytes": megabytes}


class Terrell:
    """The program. Pictures of a film are timed by when their files were written: reading, trees and the first picture are left out, developing and writing (beside
    the tracing of the next) are not."""

    def __init__(self, program, folder):
        if not shutil.which(program):
            raise SystemExit(f"{program} is not there: cargo build --release, or --terrell PROGRAM")
        self.program, self.out = program, os.path.join(folder, "pictures")

    def one(self, manifest, *more):
        """The first picture, from the files to the file."""
        shutil.rmtree(self.out, ignore_errors=True)
        return run([self.program, "render", manifest, "--out", self.out, "--to", "0", *more])

    def film(self, manifest, count, one, *more, samples=1):
        """A picture's part of a film of so many; `one` is what the first alone took, with one sample."""
        shutil.rmtree(self.out, ignore_errors=True)
        whole = run([self.program, "render", manifest, "--out", self.out, "--to", str(count - 1), *more])
        pictures = sorted(name for name in os.listdir(self.out) if name.endswith(".png"))
        written = [os.stat(os.path.join(self.out, pictures[k])).st_mtime_ns * 1e-9 for k in (0, -1)]
        seconds = (written[1] - written[0]) / (count - 1)
        processor = (whole["processor"] - one["processor"]) / (count - 1 / samples)
        return {"seconds": seconds, "processor": processor, "megabytes": whole["megabytes"]}


class Peer:
    """Another program, kept ready; it makes a picture when told to (serve.py)."""

    def __init__(self, script, *arguments):
        command = [sys.executable, os.path.join(HERE, script), *arguments]
        began = time.perf_counter()
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.facts = self._hear()
        self.facts["whole"] = time.perf_counter() - began

    def _hear(self):
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit(f"{' '.join(self.process.args)}\nstopped; run it by itself to see why")
        return json.loads(line)

    def picture(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return self._hear()

    def close(self):
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait()


class Ledger:
    """What was measured, one line each in a file, so that a run which was stopped goes on where it was."""

    def __init__(self, path):
        self.path, self.rows = path, {}
        if os.path.exists(path):
            with open(path) as file:
                for row in map(json.loads, file):
                    self.rows[tuple(row["of"])] = row

    def has(self, *of):
        return of in self.rows

    def take(self, of, measured):
        row = {"of": list(of), **measured}
        self.rows[of] = row
        with open(self.path, "a") as file:
            file.write(json.dumps(row) + "\n")
        print(*of, {key: round(value, 4) for key, value in measured.items()}, file=sys.stderr, flush=True)
        return row

    def values(self, *of, key="seconds"):
        """Of all runs, in their order."""
        found = sorted((k[-1], row[key]) for k, row in self.rows.items() if k[:-1] == of)
        return [value for _, value in found]

    def median(self, *of, key="seconds"):
        values = self.values(*of, key=key)
        return statistics.median(values) if values else None

    def ratio(self, one, other, key="seconds"):
        """The median of the ratios within each run."""
        pairs = [(a, b) for a, b in zip(self.values(*one, key=key), self.values(*other, key=key)) if b > 0]
        return statistics.median(a / b for a, b in pairs) if pairs else None
