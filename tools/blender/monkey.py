"""Suzanne, Blender's test head, smooth and brightly painted: monkey.glb, and monkey.obj with .mtl and .png.

The paint is a globe's: a chequer of longitude and latitude about the head, its hue going once round
the colour circle. Every patch is small and has a neighbour of another colour, so turning, shear and Doppler shift can
be read off a picture. Painted in space and stored through the UV map, so there are no seams.
Centred on the origin, 2.7 m wide; looks along +z in glTF's axes.
"""
import os

import bpy
import numpy as np

import kit

WHEEL = np.array([  # linear reflectances once round the head, none of them black in any channel
    (0.72, 0.06, 0.05), (0.80, 0.24, 0.03), (0.80, 0.55, 0.04), (0.25, 0.55, 0.06),
    (0.03, 0.42, 0.22), (0.03, 0.38, 0.55), (0.05, 0.12, 0.60), (0.28, 0.07, 0.55), (0.65, 0.07, 0.35),
])
CREAM = np.array((0.80, 0.76, 0.66))
INK = np.array((0.03, 0.03, 0.05))


def suzanne(level):
    """The head, subdivided; material index 1 marks the eyes."""
    kit.empty_scene()
    bpy.ops.mesh.primitive_monkey_add(size=2, calc_uvs=True)
    o = bpy.context.object
    o.name = o.data.name = "Monkey"
    mark_eyes(o.data)
    kit.modify(o, "SUBSURF", levels=level, render_levels=level)
    kit.only(o)
    bpy.ops.object.shade_smooth()
    return o


def mark_eyes(me):
    """The mesh is three loose parts; all but the largest are eyes."""
    label = list(range(len(me.vertices)))

    def root(i):
        while label[i] != i:
            i = label[i]
        return i

    for e in me.edges:
        a, b = map(root, e.vertices)
        label[max(a, b)] = min(a, b)
    roots = [root(i) for i in range(len(label))]
    head = max(set(roots), key=roots.count)
    for name in ("HeadMark", "EyeMark"):
        me.materials.append(bpy.data.materials.new(name))
    for p in me.polygons:
        p.material_index = int(roots[p.vertices[0]] != head)


def points_of_texels(o, n):
    """For each texel of an n x n UV map the point of the surface there, and whether it is an eye; rows from the top."""
    me = o.data
    me.calc_loop_triangles()
    tri = np.empty(3 * len(me.loop_triangles), np.int32)
    me.loop_triangles.foreach_get("loops", tri)
    eye = np.array([me.polygons[t.polygon_index].material_index for t in me.loop_triangles])
    uv = np.empty(2 * len(me.loops), np.float32)
    me.uv_layers.active.data.foreach_get("uv", uv)
    uv = uv.reshape(-1, 2) * n - 0.5
    vertex = np.empty(len(me.loops), np.int32)
    me.loops.foreach_get("vertex_index", vertex)
    co = np.empty(3 * len(me.vertices), np.float32)
    me.vertices.foreach_get("co", co)
    co = co.reshape(-1, 3)[vertex]
    where, kind = np.full((n, n, 3), np.nan), np.zeros((n, n), bool)
    for (a, b, c), e in zip(tri.reshape(-1, 3), eye):
        fill(where, kind, uv[[a, b, c]], co[[a, b, c]], e)
    spread(where, kind, 10)
    return where[::-1], kind[::-1]


def fill(where, kind, uv, co, eye):
    """Write one triangle's points into the map."""
    lo, hi = np.floor(uv.min(0)).astype(int), np.ceil(uv.max(0)).astype(int)
    x, y = np.meshgrid(np.arange(lo[0], hi[0] + 1), np.arange(lo[1], hi[1] + 1))
    (ax, ay), (bx, by), (cx, cy) = uv
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    if abs(area) < 1e-9:
        return
    v = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
    w = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
    inside = (v >= -1e-4) & (w >= -1e-4) & (v + w <= 1 + 1e-4)
    v, w = v[inside][:, None], w[inside][:, None]
    where[y[inside], x[inside]] = (1 - v - w) * co[0] + v * co[1] + w * co[2]
    kind[y[inside], x[inside]] = eye


def spread(where, kind, steps):
    """Let the islands grow a few texels, so that filtering at their rims finds the right colour."""
    for _ in range(steps):
        for shift, axis in ((1, 0), (-1, 0), (1, 1), (-1, 1)):
            near, near_kind = np.roll(where, shift, axis), np.roll(kind, shift, axis)
            hole = np.isnan(where[..., 0]) & ~np.isnan(near[..., 0])
            where[hole], kind[hole] = near[hole], near_kind[hole]


def paint(where, eye):
    """Linear reflectance at each point of the surface."""
    p = np.nan_to_num(where)
    x, y, z = p[..., 0], p[..., 1] + 0.1, p[..., 2] - 0.05
    longitude = np.arctan2(x, -y) / (2 * np.pi)
    latitude = np.arctan2(z, np.hypot(x, y)) / np.pi
    hue = (longitude % 1.0) * len(WHEEL)
    i = np.floor(hue).astype(int) % len(WHEEL)
    f = (hue - np.floor(hue))[..., None]
    bright = WHEEL[i] * (1 - f) + WHEEL[(i + 1) % len(WHEEL)] * f
    ear = (np.abs(p[..., 0]) > 0.84) & (p[..., 1] > -0.25) & ~eye
    a = np.where(ear, p[..., 0] * 9, longitude * 36)
    b = np.where(ear, p[..., 2] * 9, latitude * 18)
    squash = np.where(ear, 1.0, np.cos(latitude * np.pi))
    odd = (np.floor(a) + np.floor(b)) % 2
    color = np.where(odd[..., None] == 0, bright, CREAM)
    # A dot of the hue across the wheel in each patch: detail at half the size.
    dot = np.hypot((a % 1 - 0.5) * squash, b % 1 - 0.5) < 0.2
    across = WHEEL[(i + len(WHEEL) // 2) % len(WHEEL)]
    color = np.where((dot & (odd == 1))[..., None], across, color)
    color = np.where((dot & (odd == 0))[..., None], CREAM, color)
    return np.where(eye[..., None], paint_eyes(p, eye), color)


def paint_eyes(p, eye):
    """White with a blue iris and a black pupil, looking ahead."""
    color = np.broadcast_to(np.array((0.85, 0.85, 0.82)), p.shape).copy()
    for side in (1, -1):
        mine = eye & (np.sign(p[..., 0]) == side)
        middle = (p[mine].max(0) + p[mine].min(0)) / 2
        off = np.hypot(p[..., 0] - middle[0] + 0.02 * side, p[..., 2] - middle[2] + 0.01)
        color[mine & (off < 0.13)] = (0.05, 0.30, 0.60)
        color[mine & (off < 0.065)] = INK
    return color


def dress(o, texture):
    """One material for all, with the painted image."""
    o.data.materials.clear()
    o.data.materials.append(kit.matte("Skin", texture=texture))
    o.data.polygons.foreach_set("material_index", np.zeros(len(o.data.polygons), np.int32))


def painting(o, n):
    """The n x n picture for this head's UV map."""
    return kit.srgb(kit.shrink(paint(*points_of_texels(o, 2 * n)), 2))


def main():
    folder = kit.output_folder()
    o = suzanne(2)
    dress(o, kit.image("skin", painting(o, 1536)))
    kit.export_glb(os.path.join(folder, "monkey.glb"))
    o = suzanne(1)
    dress(o, kit.image("skin", painting(o, 512), file=os.path.join(folder, "monkey.png")))
    path = os.path.join(folder, "monkey.obj")
    bpy.ops.wm.obj_export(filepath=path, path_mode="STRIP")
    print(f"monkey.obj: {sum(len(p.vertices) - 2 for p in o.data.polygons)} triangles, {os.path.getsize(path)} bytes")


if __name__ == "__main__":
    main()
