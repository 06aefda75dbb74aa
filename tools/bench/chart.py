"""Charts with logarithmic axes on a sheet, as SVG."""
import math
from dataclasses import dataclass
from html import escape

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM, HEAD, COLUMNS = 460, 300, 64, 20, 50, 44, 44, 2
# Told apart also by those who see fewer colours (Okabe and Ito, 2008).
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")


@dataclass
class Panel:
    """Lines of points, each with a name: what is across, and in what unit it is down."""

    title: str
    across: str
    down: str
    lines: list


class Axis:
    """Between two of 1, 2, 5, 10, 20 and so on that hold all values."""

    def __init__(self, values, start, end):
        steps = [m * 10.0**power for power in range(-9, 15) for m in (1, 2, 5)]
        low = max(step for step in steps if step <= min(values) * 1.0001)
        high = min(step for step in steps if step >= max(max(values) * 0.9999, 1.5 * low))
        self.low, self.high, self.start, self.end = low, high, start, end
        inside = [step for step in steps if low <= step <= high]
        self.ticks = inside if len(inside) <= 8 else [step for step in inside if f"{step:e}"[0] == "1"]

    def place(self, value):
        part = math.log(value / self.low) / math.log(self.high / self.low)
        return self.start + (self.end - self.start) * part


def label(value):
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if value >= size:
            return f"{value / size:g}{letter}"
    return f"{value:g}"


def text(x, y, words, anchor="middle", size=12, color="#000", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" fill="{color}"{more}>{escape(words)}</text>\n'


def drawn(panel):
    """A panel, its corner at 0, 0."""
    points = [point for _, line in panel.lines for point in line]
    across = Axis([x for x, _ in points], LEFT, WIDTH - RIGHT)
    down = Axis([y for _, y in points], HEIGHT - BOTTOM, TOP)
    out = text(LEFT, 18, panel.title, "start", 14)
    for tick in across.ticks:
        x = across.place(tick)
        out += f'<path d="M{x:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>\n' + text(x, HEIGHT - BOTTOM + 16, label(tick))
    for tick in down.ticks:
        y = down.place(tick)
        out += f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>\n' + text(LEFT - 7, y + 4, label(tick), "end")
    out += text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - BOTTOM + 34, panel.across)
    middle = (TOP + HEIGHT - BOTTOM) / 2
    out += text(16, middle, panel.down, more=f' transform="rotate(-90 16 {middle:.1f})"')
    x = LEFT
    for (name, line), color in zip(panel.lines, COLORS):
        places = [(across.place(a), down.place(b)) for a, b in line]
        path = "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in places)
        out += f'<path d="{path}" fill="none" stroke="{color}" stroke-width="1.5"/>\n'
        out += "".join(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3.5" fill="{color}"/>\n' for a, b in places)
        if name:
            out += f'<circle cx="{x + 5}" cy="36" r="4" fill="{color}"/>\n' + text(x + 14, 40, name, "start", color=color)
            x += 34 + 6.4 * len(name)
    return out


def sheet_of(title, panels):
    """All panels under a title."""
    wide, high = COLUMNS * WIDTH, HEAD + HEIGHT * math.ceil(len(panels) / COLUMNS)
    out = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" font-family="sans-serif">\n'
    out += '<rect width="100%" height="100%" fill="#fff"/>\n' + text(LEFT, 28, title, "start", 18)
    for number, panel in enumerate(panels):
        x, y = number % COLUMNS * WIDTH, HEAD + number // COLUMNS * HEIGHT
        out += f'<g transform="translate({x} {y})">\n{drawn(panel)}</g>\n'
    return out + "</svg>\n"
