"""A die of side 1 m centred on the origin, with rounded edges and hollowed pips (die.glb), and a row of nine (dice.glb).

Opposite faces add up to seven; in glTF's axes 1 looks along +z, 2 along +x, 3 along +y. Each face's pips have a colour of their own, so that
in a picture of something fast one knows which face one is looking at.
The row stands 2 m apart along x, middle die at the origin, each turned a quarter more than the last; all share one mesh.
"""
import math
import os

import bpy
import numpy as np

import kit

IVORY = (0.78, 0.72, 0.58)
COLORS = {1: (0.70, 0.03, 0.03), 2: (0.02, 0.09, 0.50), 3: (0.02, 0.30, 0.08), 4: (0.60, 0.20, 0.01), 5: (0.25, 0.03, 0.42), 6: (0.02, 0.02, 0.03)}
# Blender axes: glTF +z is Blender -y, glTF +y is Blender +z.
NORMALS = {1: (0, -1, 0), 6: (0, 1, 0), 2: (1, 0, 0), 5: (-1, 0, 0), 3: (0, 0, 1), 4: (0, 0, -1)}
PIPS = {
    1: [(0, 0)], 2: [(-1, -1), (1, 1)], 3: [(-1, -1), (0, 0), (1, 1)], 4: [(-1, -1), (-1, 1), (1, -1), (1, 1)],
    5: [(-1, -1), (-1, 1), (1, -1), (1, 1), (0, 0)], 6: [(-1, -1), (-1, 0), (-1, 1), (1, -1), (1, 0), (1, 1)],
}
SPACING, RADIUS, DEPTH = 0.24, 0.088, 0.05


def pips(materials):
    """Balls that, taken away from the cube, leave the pips: each of them sinks DEPTH into its face."""
    ball = (RADIUS**2 + DEPTH**2) / (2 * DEPTH)
    made = []
    for number, normal in NORMALS.items():
        n = np.array(normal, float)
        a = np.roll(n, 1) * n.sum()
        b = np.cross(n, a)
        for i, j in PIPS[number]:
            at = n * (0.5 + ball - DEPTH) + SPACING * (i * a + j * b)
            bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=ball, location=tuple(at))
            o = bpy.context.object
            for m in materials:
                o.data.materials.append(m)
            o.data.polygons.foreach_set("material_index", np.full(len(o.data.polygons), number, np.int32))
            made.append(o)
    return kit.join(made, "Pips")


def die():
    """One die."""
    kit.empty_scene()
    materials = [kit.matte("Ivory", IVORY)] + [kit.matte(f"Pip{k}", COLORS[k]) for k in range(1, 7)]
    o = kit.bevelled_box("Die", (-0.5,) * 3, (0.5,) * 3, 0.09, 6)
    cutter = pips(materials)
    for m in materials:
        o.data.materials.append(m)
    # The exact solver numbers its vertices differently in each run; this one does not.
    kit.modify(o, "BOOLEAN", operation="DIFFERENCE", solver="MANIFOLD", object=cutter)
    bpy.data.objects.remove(cutter)
    kit.smooth_by_angle(o, 30)
    kit.modify(o, "WEIGHTED_NORMAL", weight=100, keep_sharp=True)
    kit.modify(o, "TRIANGULATE", keep_custom_normals=True)
    for layer in list(o.data.uv_layers):
        o.data.uv_layers.remove(layer)
    return o


def main():
    folder = kit.output_folder()
    o = die()
    kit.export_glb(os.path.join(folder, "die.glb"))
    middle = 4
    for i in range(9):
        copy = o if i == middle else kit.place(f"Die{i - middle:+d}", o.data, at=(2.0 * (i - middle), 0, 0))
        copy.rotation_euler = (0, 0, math.radians(90 * (i - middle)))
    kit.export_glb(os.path.join(folder, "dice.glb"))


if __name__ == "__main__":
    main()
