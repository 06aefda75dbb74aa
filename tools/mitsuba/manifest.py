"""The part of terrell's manifests that compare.py understands: bodies at rest, lamps, spots and suns, an observer at rest.

Anything else is refused, so that a comparison can't silently leave something out.
"""
import os

import numpy as np
import yaml

KEYS = {
    "manifest": {"assets", "bodies", "lights", "observer", "picture", "output", "surroundings"},
    "body": {"asset", "name", "at", "rotation", "scale", "material"},
    "light": {"lamp", "spot", "sun", "at"},
    "observer": {"at", "look_at", "direction", "field_of_view", "up"},
}


class Manifest:
    """A manifest, read; lengths in metres, angles in radians."""

    def __init__(self, path):
        self.folder = os.path.dirname(os.path.abspath(path))
        self.written = known(yaml.safe_load(open(path)), "manifest")
        width, height = str(self.written["picture"]["size"]).split()
        self.size = int(width), int(height)
        self.assets = {name: self._asset(a) for name, a in self.written["assets"].items()}
        self.bodies = [Body(b, self.assets) for b in self.written["bodies"]]
        self.lights = [Light(x) for x in self.written["lights"]]
        self.observer = Observer(self.written["observer"])

    def _asset(self, written):
        written = {"file": written} if isinstance(written, str) else written
        if "file" not in written:
            return written, None
        return os.path.join(self.folder, written["file"]), written.get("node")

    def exr(self):
        """Where terrell leaves its picture: the newest .exr of the output folder."""
        output = self.written["output"]
        folder = os.path.join(self.folder, output["folder"] if isinstance(output, dict) else output)
        found = [os.path.join(at, f) for at, _, files in os.walk(folder) for f in files if f.endswith(".exr")]
        return max(found, key=os.path.getmtime, default=None)


class Body:
    """A copy of an asset: file, node, matrix; the material of its own as written, and its reflectance if that is one number."""

    def __init__(self, written, assets):
        known(written, "body")
        self.file, self.node = assets[written["asset"]]
        self.name = written.get("name", written["asset"])
        m = np.eye(4)
        m[:3, :3] = rotation(written.get("rotation")) * np.broadcast_to(numbers(written.get("scale", 1)), 3)
        m[:3, 3] = quantity(written.get("at", "0 0 0 m"), "m")
        self.matrix = m
        self.material = written.get("material")
        value = (self.material or {}).get("diffuse")
        self.reflectance = float(value) if isinstance(value, (int, float)) else None


class Light:
    """A lamp, spot or sun: its strength in cd or lx, and its spectrum as (kind, temperature)."""

    def __init__(self, written):
        known(written, "light")
        self.kind = next(k for k in ("lamp", "spot", "sun") if k in written)
        w = written[self.kind]
        self.at = quantity(written.get("at", "0 0 0 m"), "m")
        self.strength = float(quantity(w["illuminance"], "lx") if self.kind == "sun" else quantity(w["intensity"], "cd"))
        self.direction = unit(numbers(w.get("direction", "0 -1 0")))
        self.half_angle = np.radians(quantity(w["cone"], "deg")) / 2 if self.kind == "spot" else None
        if "inner" in w and w["inner"] != w["cone"]:
            raise SystemExit("spots are compared with hard cones: the renderers' soft ones differ by definition (leave `inner` out)")
        s = w.get("spectrum", "D65")
        self.spectrum = ("black_body", float(quantity(s["black_body"], "K"))) if isinstance(s, dict) else (s, None)


class Observer:
    """A pinhole at rest."""

    def __init__(self, written):
        known(written, "observer")
        self.at = quantity(written.get("at", "0 0 0 m"), "m")
        ahead = quantity(written["look_at"], "m") - self.at if "look_at" in written else numbers(written.get("direction", "0 0 -1"))
        self.forward = unit(ahead)
        self.right = unit(np.cross(self.forward, numbers(written.get("up", "0 1 0"))))
        self.up = np.cross(self.right, self.forward)
        self.angle = np.radians(float(quantity(written.get("field_of_view", "50 deg"), "deg")))

    def directions(self, width, height):
        """Unit vectors through the middles of the pixels, rows from the top."""
        t = np.tan(self.angle / 2)
        x = (2 * (np.arange(width) + 0.5) / width - 1) * t
        y = (1 - 2 * (np.arange(height) + 0.5) / height) * t * height / width
        d = self.forward + x[None, :, None] * self.right + y[:, None, None] * self.up
        return (d / np.linalg.norm(d, axis=-1, keepdims=True)).reshape(-1, 3)


def known(written, what):
    """Refuse keys that would be left out."""
    odd = set(written) - KEYS[what]
    if odd:
        raise SystemExit(f"{what}: not understood by this comparison: {', '.join(sorted(odd))}")
    return written


def numbers(text):
    """A number or several."""
    return np.array([float(t) for t in str(text).split()])


def quantity(text, unit_name):
    """Numbers with this unit; one number comes as a scalar."""
    *values, written = str(text).split()
    if written != unit_name:
        raise SystemExit(f"`{text}`: this comparison wants {unit_name}")
    values = np.array([float(v) for v in values])
    return values if len(values) > 1 else values[0]


def unit(v):
    return v / np.linalg.norm(v)


def rotation(text):
    """`20 deg about 0 1 0` as a matrix (Rodrigues)."""
    if not text:
        return np.eye(3)
    angle, axis = text.split("about")
    a, (x, y, z) = np.radians(float(quantity(angle.strip(), "deg"))), unit(numbers(axis))
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(a) * k + (1 - np.cos(a)) * (k @ k)
