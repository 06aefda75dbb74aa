"""A place to photograph things in (studio.glb): `Floor`, 40 m x 40 m at y = 0 about the origin, and `Backdrop` behind it.

The floor is chequered in squares of 1 m; each bears two digits, its metres along x and along z within a block of ten, and
thin lines mark every metre, red ones every 5 m along x, blue ones along z. The backdrop rises from the floor's edge at z = -20 m in a quarter circle
of 4 m and stands to 14 m: hue changes along it, lines every metre, so it can be measured too.
"""
import os

import numpy as np

import kit

FONT = [  # digits, 3 x 5 dots each
    ["111", "101", "101", "101", "111"], ["010", "110", "010", "010", "111"], ["111", "001", "111", "100", "111"], ["111", "001", "111", "001", "111"],
    ["101", "101", "111", "001", "001"], ["111", "100", "111", "001", "111"], ["111", "100", "111", "101", "111"], ["111", "001", "001", "010", "010"],
    ["111", "101", "111", "101", "111"], ["111", "101", "111", "001", "111"],
]


def floor_picture(side=120):
    """A block of 10 m x 10 m, `side` pixels to the metre, painted twice as large."""
    s = 2 * side
    n = 10 * s
    row, column = np.divmod(np.arange(n * n).reshape(n, n), n)
    i, j = column // s, row // s
    grain = kit.noise(n, (20, 40, 160), 5)[..., None] - 0.5
    light = np.array((0.62, 0.60, 0.56)) * (1 + 0.10 * grain)
    dark = np.array((0.115, 0.125, 0.145)) * (1 + 0.25 * grain)
    odd = ((i + j) % 2)[..., None]
    color = np.where(odd == 0, light, dark)
    color = np.where(numbers(s)[..., None], np.where(odd == 0, (0.36, 0.345, 0.32), (0.24, 0.255, 0.285)), color)
    near = lambda v, width: np.minimum(v % s, s - 1 - v % s) < width * s / 2
    color = np.where((near(column, 0.03) | near(row, 0.03))[..., None], (0.30, 0.30, 0.30), color)
    five = lambda v: np.minimum(v % (5 * s), 5 * s - 1 - v % (5 * s)) < 0.03 * s
    color = np.where(five(row)[..., None], (0.05, 0.16, 0.55), color)
    color = np.where(five(column)[..., None], (0.62, 0.07, 0.04), color)
    return kit.srgb(kit.shrink(color, 2))


def numbers(s):
    """True where a digit is: square (i, j) shows i and then j, small, in its near left corner."""
    page = np.zeros((10 * s, 10 * s), bool)
    dot = s // 28
    glyph = [np.kron(np.array([[c == "1" for c in line] for line in g]), np.ones((dot, dot), bool)) for g in FONT]
    for i in range(10):
        for j in range(10):
            for k, digit in enumerate((i, j)):
                x, y = i * s + (2 + 4 * k) * dot + dot, (j + 1) * s - 8 * dot
                page[y : y + 5 * dot, x : x + 3 * dot] = glyph[digit]
    return page


def backdrop_picture(n=1024):
    """Over its whole width the hue goes from warm to cool; upwards it darkens a little."""
    t = (np.arange(2 * n) + 0.5) / (2 * n)
    stops = np.array([(0.62, 0.30, 0.16), (0.66, 0.52, 0.28), (0.45, 0.55, 0.40), (0.25, 0.46, 0.52), (0.20, 0.28, 0.52), (0.38, 0.22, 0.46)])
    along = np.stack([np.interp(t, np.linspace(0, 1, len(stops)), stops[:, k]) for k in range(3)], -1)
    up = (1 - 0.55 * t[::-1])[:, None, None]
    color = along[None] * up
    metre = lambda length: np.abs((t * length + 0.5) % 1 - 0.5) * 2 * n / length < 3
    line = metre(40)[None, :] | metre(LENGTH)[::-1][:, None]
    color = np.where(line[..., None], color * 1.35 + 0.05, color)
    return kit.srgb(kit.shrink(color, 2))


RADIUS, TOP, STEPS = 4.0, 14.0, 24
LENGTH = 0.5 * np.pi * RADIUS + TOP - RADIUS


def floor(material):
    """One square; the picture repeats every 10 m and its block starts at the origin."""
    corners = [(-20, -20, 0), (20, -20, 0), (20, 20, 0), (-20, 20, 0)]
    kit.mesh_object("Floor", corners, [(0, 1, 2, 3)], [material], uv=[(x / 10, y / 10) for x, y, _ in corners])


def backdrop(material):
    """A strip bent up from the floor."""
    bend = np.linspace(0, np.pi / 2, STEPS + 1)
    profile = [(20 + RADIUS * np.sin(a), RADIUS * (1 - np.cos(a)), RADIUS * a) for a in bend] + [(20 + RADIUS, TOP, LENGTH)]
    vertices = [(x, y, z) for y, z, _ in profile for x in (-20, 20)]
    faces, uv = [], []
    for k in range(len(profile) - 1):
        faces.append((2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2))
        low, high = profile[k][2] / LENGTH, profile[k + 1][2] / LENGTH
        uv += [(0, low), (1, low), (1, high), (0, high)]
    kit.mesh_object("Backdrop", vertices, faces, [material], uv=uv, smooth=True)


def main():
    folder = kit.output_folder()
    kit.empty_scene()
    floor(kit.matte("FloorTiles", texture=kit.image("floor", floor_picture(), quality=86)))
    backdrop(kit.matte("BackdropPaint", texture=kit.image("backdrop", backdrop_picture(), quality=86)))
    kit.export_glb(os.path.join(folder, "studio.glb"))


if __name__ == "__main__":
    main()
