"""A hall to walk through and to fly through (hall.glb): 40 m long, painted in many colours.

glTF's axes, y up: x from -6 to 6, the nave goes from z = 0 to -40 between two rows of columns at x = -3 and 3, every 4 m, under a vault of radius 3 m whose
springing is at y = 4.2; aisles beside it, with a panel of another colour in each bay. The far end bears a rose of twelve colours, 4 m across,
its middle at y = 3.4. The near end is open. Floor squares of 1 m.
"""
import colorsys
import math
import os

import numpy as np

import kit

LENGTH, BAY, SPRING, NAVE, SIDE = 40, 4, 4.2, 3.0, 6.0


def floor_picture(n=512):
    """Two metres of marble, dark and light squares of a metre."""
    row, column = np.divmod(np.arange(4 * n * n).reshape(2 * n, 2 * n), 2 * n)
    vein = kit.noise(2 * n, (5, 13, 40, 90), 3)
    vein = np.abs(vein - 0.5)[..., None]
    light = np.array((0.70, 0.66, 0.58)) * (0.72 + 1.5 * vein)
    dark = np.array((0.05, 0.075, 0.08)) * (0.7 + 5 * vein)
    color = np.where((((row // n) + (column // n)) % 2)[..., None] == 0, light, dark)
    joint = (np.minimum(row % n, n - 1 - row % n) < 5) | (np.minimum(column % n, n - 1 - column % n) < 5)
    return kit.srgb(kit.shrink(np.where(joint[..., None], 0.25, color), 2))


def hue(part, dull=0.12):
    """A strong paint, linear."""
    return tuple(dull * 0.3 + (0.75 - dull * 0.3) * v ** 2.2 for v in colorsys.hsv_to_rgb(part, 0.92, 0.95))


def lathe(name, profile, material, sides=28):
    """A column turned from (radius, height) pairs."""
    turn = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    vertices = [(r * math.cos(a), r * math.sin(a), z) for r, z in profile for a in turn]
    faces = [
        (k * sides + i, k * sides + (i + 1) % sides, (k + 1) * sides + (i + 1) % sides, (k + 1) * sides + i)
        for k in range(len(profile) - 1) for i in range(sides)
    ]
    o = kit.mesh_object(name, vertices, faces, [material], smooth=True)
    return kit.smooth_by_angle(o, 40)


def arch(name, radius, thick, deep, material, steps=32):
    """A half ring over the nave: inner radius, thickness, and depth along the hall."""
    bend = np.linspace(0, np.pi, steps + 1)
    ring = lambda r, y: [(-r * math.cos(a), y, r * math.sin(a)) for a in bend]
    n = steps + 1
    vertices = ring(radius, -deep / 2) + ring(radius, deep / 2) + ring(radius + thick, -deep / 2) + ring(radius + thick, deep / 2)
    faces = []
    for k in range(steps):
        faces += [(k, k + 1, n + k + 1, n + k), (2 * n + k, 2 * n + k + 1, k + 1, k), (n + k, n + k + 1, 3 * n + k + 1, 3 * n + k)]
    return kit.mesh_object(name, vertices, faces, [material], smooth=False)


def main():
    folder = kit.output_folder()
    kit.empty_scene()
    stone, gold = kit.matte("Stone", (0.60, 0.55, 0.46)), kit.matte("Gold", (0.72, 0.50, 0.14))
    red, blue, cream = kit.matte("Red", (0.42, 0.075, 0.05)), kit.matte("Blue", (0.05, 0.12, 0.36)), kit.matte("Cream", (0.66, 0.60, 0.48))
    marble = kit.matte("Marble", texture=kit.image("marble", floor_picture(), quality=80))

    corners = [(-SIDE, 0, 0), (SIDE, 0, 0), (SIDE, LENGTH, 0), (-SIDE, LENGTH, 0)]
    kit.mesh_object("Floor", corners, [(0, 1, 2, 3)], [marble], uv=[(x / 2, y / 2) for x, y, _ in corners])

    profile = [(0.50, 0), (0.50, 0.25), (0.42, 0.30), (0.46, 0.38), (0.36, 0.46), (0.34, 1.2), (0.30, 3.5), (0.34, 3.55), (0.34, 3.65), (0.52, 4.0), (0.52, SPRING)]
    column = lathe("Column", profile, stone)
    column.location = (-NAVE, BAY / 2, 0)
    rib = arch("Rib", NAVE - 0.15, 0.25, 0.5, gold)
    rib.location = (0, BAY / 2, SPRING)
    for k in range(LENGTH // BAY):
        y = BAY / 2 + BAY * k
        if k:
            kit.place(f"ColumnL{k}", column.data, at=(-NAVE, y, 0))
            kit.place(f"Rib{k}", rib.data, at=(0, y, SPRING))
        kit.place(f"ColumnR{k}", column.data, at=(NAVE, y, 0))

    bend = np.linspace(0, np.pi, 33)
    vault = [(-NAVE * math.cos(a), y, SPRING + NAVE * math.sin(a)) for y in (0, LENGTH) for a in bend]
    kit.mesh_object("Vault", vault, [(k, k + 1, 34 + k, 33 + k) for k in range(32)], [blue], smooth=True)
    for side, name in ((-1, "L"), (1, "R")):
        inner, outer = side * NAVE, side * SIDE
        kit.mesh_object(f"Ceiling{name}", [(inner, 0, SPRING), (outer, 0, SPRING), (outer, LENGTH, SPRING), (inner, LENGTH, SPRING)], [(0, 1, 2, 3)], [cream])
        kit.mesh_object(f"Wall{name}", [(outer, 0, 0), (outer, LENGTH, 0), (outer, LENGTH, SPRING), (outer, 0, SPRING)], [(0, 1, 2, 3)], [red])
        for k in range(LENGTH // BAY):
            y, x = BAY * (k + 0.5), outer - side * 0.04
            part = (k + (0.5 if side > 0 else 0)) / (LENGTH // BAY)
            low, high, half = 0.9, 3.5, 1.2
            panel = kit.matte(f"Panel{name}{k}", hue(part))
            kit.mesh_object(f"Panel{name}{k}", [(x, y - half, low), (x, y + half, low), (x, y + half, high), (x, y - half, high)], [(0, 1, 2, 3)], [panel])
            edge = outer - side * 0.02
            m = 0.14
            kit.mesh_object(
                f"Edge{name}{k}", [(edge, y - half - m, low - m), (edge, y + half + m, low - m), (edge, y + half + m, high + m), (edge, y - half - m, high + m)],
                [(0, 1, 2, 3)], [gold],
            )
    top = [(-NAVE * math.cos(a), LENGTH, SPRING + NAVE * math.sin(a)) for a in bend]
    end = [(-SIDE, LENGTH, 0), (SIDE, LENGTH, 0), (SIDE, LENGTH, SPRING), *reversed(top), (-SIDE, LENGTH, SPRING)]
    kit.mesh_object("End", end, [tuple(range(len(end)))], [cream])
    rose, turn = (0, LENGTH - 0.05, 3.4), np.linspace(0, 2 * np.pi, 97)
    vertices = [rose] + [(2 * math.cos(a), rose[1], rose[2] + 2 * math.sin(a)) for a in turn[:-1]]
    faces = [(0, 1 + i, 1 + (i + 1) % 96) for i in range(96)]
    petals = [kit.matte(f"Petal{k}", hue(k / 12)) for k in range(12)]
    kit.mesh_object("Rose", vertices, faces, petals, [i // 8 for i in range(96)])
    kit.export_glb(os.path.join(folder, "hall.glb"))


if __name__ == "__main__":
    main()
