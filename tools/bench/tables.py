"""What bench.py measured, as tables."""
import csv


def number(value, form="{:.3g}"):
    return "-" if value is None else form.format(value)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def against(ledger, scene, samples):
    """Both: by the clock, and by the processor in brackets."""
    ours = (scene, f"terrell rest {samples}")
    row = [scene, str(samples), number(ledger.median(*ours))]
    for peer in (f"mitsuba {samples}", f"mitsuba picks {samples}", f"povray {samples}"):
        theirs = (scene, peer)
        median = ledger.median(*theirs)
        row.append(number(median))
        row.append("-" if median is None else f"{number(ledger.ratio(ours, theirs))} ({number(ledger.ratio(ours, theirs, 'processor'))})")
    return row + ([number(ledger.median(scene, "cycles 2"))] if samples == 1 else ["-"])


def moving(ledger, scene):
    rest = (scene, "terrell rest 1")
    row = [scene, number(ledger.median(*rest))]
    for kind in ("together", "apart"):
        other = (scene, f"terrell {kind} 1")
        row.append(f"{number(ledger.ratio(other, rest))} ({number(ledger.ratio(other, rest, 'processor'))})")
    white = (scene, "terrell white 1")
    return row + [f"{number(ledger.ratio(rest, white))} ({number(ledger.ratio(rest, white, 'processor'))})"]


def first(ledger, scene):
    row = [scene]
    for program in ("terrell", "mitsuba", "cycles"):
        row.append(number(ledger.median(scene, f"{program} first")))
    for program in ("mitsuba", "cycles"):
        row.append(number(ledger.ratio((scene, "terrell first"), (scene, f"{program} first"))))
    for program in ("terrell", "mitsuba", "cycles"):
        row.append(number(ledger.median(scene, f"{program} first", key="megabytes"), "{:.0f}"))
    return row


def same(ledger, scene):
    found = ledger.rows.get((scene, "check", 0))
    return [scene] + ([number(100 * found[key], "{:.3g} %") for key in ("mean", "median", "share")] if found else ["-"] * 3)


def tables(ledger, scenes):
    """All of them as Markdown."""
    parts = [
        "Seconds a picture, load and trees left out (ratios: terrell's to theirs, in brackets by processor time):\n",
        table(
            ["scene", "samples", "terrell, 16 wavelengths", "Mitsuba, llvm RGB", "ratio", "Mitsuba, one way at glass", "ratio", "POV-Ray", "ratio", "Cycles, 2 samples"],
            [against(ledger, scene, samples) for scene in scenes for samples in (1, 16)],
        ),
        "In motion at 0.9 c against rest, and 16 wavelengths against 3:\n",
        table(["scene", "s at rest", "one velocity", "each its own", "16 wavelengths to 3"], [moving(ledger, scene) for scene in scenes]),
        "The first picture from the .glb: seconds, ratios, and the largest memory (MB):\n",
        table(
            ["scene", "terrell", "Mitsuba", "Blender", "to Mitsuba", "to Blender", "MB: terrell", "Mitsuba", "Blender"],
            [first(ledger, scene) for scene in scenes],
        ),
        "The same picture as Mitsuba's (white lamps):\n",
        table(["scene", "means differ by", "median of blocks", "pixels within 1 %"], [same(ledger, scene) for scene in scenes]),
    ]
    still, filmed = (ledger.median("mesh1m", f"terrell {kind}") for kind in ("still", "filmed"))
    if still:
        parts.append(f"Beside the tracing a picture of a film takes {1000 * still:.0f} ms to develop and write, {1000 * filmed:.0f} ms with its part of the video.\n")
    return "\n".join(parts)


def write_tables(ledger, scenes, path):
    """To `path`.md and, every measurement, `path`.csv; and shows them."""
    text = tables(ledger, scenes)
    with open(path + ".md", "w") as file:
        file.write(text)
    with open(path + ".csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "case", "run", "seconds", "processor", "megabytes"])
        for (scene, case, run), row in sorted(ledger.rows.items()):
            if "seconds" in row:
                writer.writerow([scene, case, run, *(f"{row[k]:.5f}" if k in row else "" for k in ("seconds", "processor", "megabytes"))])
    print(text)
