"""The side of a peer: it makes pictures when asked to, and says what each took."""
import json
import os
import resource
import sys
import time


def megabytes():
    """The largest memory of this process or of one that it started."""
    return max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)) / 1024


def quietly():
    """Keeps the real output for ourselves: what libraries print goes nowhere."""
    ours = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return ours


def serve(facts, make, out=None):
    """Says the facts (and the largest memory so far, MB); then, for each line read, makes a picture and says its seconds, by the clock and of the processor.
    What `make` returns, if it is a map, knows them better."""
    out = out or sys.stdout
    say = lambda said: print(json.dumps(said), file=out, flush=True)
    say({**facts, "megabytes": megabytes()})
    for number, _ in enumerate(sys.stdin):
        wall, processor = time.perf_counter(), time.process_time()
        made = make(number)
        said = {"seconds": time.perf_counter() - wall, "processor": time.process_time() - processor}
        said = made if isinstance(made, dict) and "seconds" in made else said
        say({**said, "megabytes": megabytes()})
