#!/usr/bin/env python3
"""The benchmark's models, made in Blender: scenes.py FOLDER [--quick] writes mesh1m.glb, inst100.glb and spheres.glb there.

  mesh1m   four textured heads as one mesh, 1,007,616 triangles, on a floor of two
  inst100  one head of 62,976 triangles, placed a hundred times: 6.3 million seen
  spheres  a ball of mirror and one of glass (65,024 triangles each, smooth normals), a head, a floor and a wall

Each file has two lamps without size, the second of them yellowish, and the camera. --quick makes the heads 64 (mesh1m) and 4 times coarser.
"""
import math
import os
import sys

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "blender"))
import kit  # noqa: E402

SQUARES = 8  # of the floor's picture, along each side


def checks(n=1024):
    """Light and dark squares."""
    y, x = np.mgrid[0:n, 0:n] * SQUARES // n
    return np.where(((x + y) % 2)[..., None] == 0, (0.85, 0.85, 0.85), (0.12, 0.16, 0.22))


def waves(n=2048):
    """Bands of colour with grain, so that a look-up of the picture cannot be saved."""
    y, x = np.mgrid[0:n, 0:n] / n
    bands = (0.5 + 0.4 * np.sin(40 * x + 6 * np.sin(9 * y)), 0.5 + 0.4 * np.sin(31 * y + 2), 0.45 + 0.3 * np.sin(25 * (x + y)))
    grain = np.random.default_rng(7).uniform(-0.06, 0.06, (n, n, 1))
    return np.clip(np.stack(bands, -1) + grain, 0.02, 0.95)


def picture(name, values):
    """A Blender image, packed as PNG: decoders agree about those to the last bit."""
    made = bpy.data.images.new(name, values.shape[1], values.shape[0])
    pixels = np.ones((*values.shape[:2], 4), np.float32)
    pixels[..., :3] = values
    made.pixels.foreach_set(pixels[::-1].ravel())
    made.file_format = "PNG"
    made.pack()
    return made


def square(name, side, material, at=(0, 0, 0), turn=(0, 0, 0)):
    """A textured square; its picture repeats every 7.5 m or so."""
    half, repeats = 0.5 * side, round(side / 7.5)
    corners = [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)]
    uv = [(0, 0), (repeats, 0), (repeats, repeats), (0, repeats)]
    made = kit.mesh_object(name, corners, [(0, 1, 2, 3)], [material], uv=uv)
    made.location, made.rotation_euler = at, turn
    return made


def head(level, material):
    """Blender's monkey, subdivided: 3,936 triangles at level 1, four times as many at each further one."""
    bpy.ops.mesh.primitive_monkey_add(size=2, calc_uvs=True)
    made = bpy.context.object
    made.name = made.data.name = "Head"
    kit.modify(made, "SUBSURF", levels=level, render_levels=level)
    kit.modify(made, "TRIANGULATE")
    bpy.ops.object.shade_smooth()
    made.data.materials.append(material)
    return made


def ball(name, at, material):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128, radius=1.8, location=at)
    made = bpy.context.object
    made.name = made.data.name = name
    made.data.materials.append(material)
    kit.modify(made, "TRIANGULATE")
    bpy.ops.object.shade_smooth()
    return made


def light_and_camera(eye, target, watts):
    """Two lamps of that many watts, and a camera that is 40 mm from a film of 36."""
    for number, (at, power, color) in enumerate(zip(((5, -6, 8), (-7, -4, 5)), watts, ((1, 1, 1), (1, 0.8, 0.6)))):
        lamp = bpy.data.lights.new(f"Lamp{number}", "POINT")
        lamp.energy, lamp.color, lamp.shadow_soft_size = power, color, 0.0
        kit.place(f"Lamp{number}", lamp, at)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 1280, 720
    camera = bpy.data.cameras.new("Camera")
    camera.lens = 40
    scene.camera = kit.place("Camera", camera, eye)
    scene.camera.rotation_euler = (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()


def start():
    """An empty scene, and the two paints."""
    kit.empty_scene()
    return kit.matte("Skin", texture=picture("skin", waves())), kit.matte("Floor", texture=picture("checks", checks()))


def mesh1m(level):
    skin, floor = start()
    square("Floor", 60, floor)
    heads = []
    for x, y, turn in ((-3.3, 0, 20), (-1.1, 1.2, -10), (1.1, 0, 15), (3.3, 1.2, -25)):
        made = head(level, skin)
        made.location, made.rotation_euler = (x, y, 1), (0, 0, math.radians(turn))
        heads.append(made)
    kit.join(heads, "Heads")
    light_and_camera((0, -11, 4.2), (0, 0.5, 1), (2500, 1200))


def inst100(level):
    skin, floor = start()
    square("Floor", 80, floor)
    first = head(level, skin)
    chance = np.random.default_rng(3).uniform
    for number in range(100):
        made = first if number == 0 else kit.place("Head", first.data)
        made.location = (number % 10 - 4.5) * 2.6, (number // 10 - 4.5) * 2.6, 1
        made.rotation_euler = chance(-0.3, 0.3), chance(-0.3, 0.3), chance(0, 2 * math.pi)
        made.scale = [chance(0.7, 1.1)] * 3
        made.name = f"Head{number:02}"
    light_and_camera((0, -26, 13), (0, 1, 0), (9000, 6000))


def spheres(level):
    skin, floor = start()
    square("Floor", 60, floor)
    square("Wall", 60, floor, at=(0, 14, 0), turn=(math.pi / 2, 0, 0))
    ball("MirrorBall", (-2.2, 0, 1.8), kit.matte("Mirror", (0.9, 0.9, 0.9)))
    ball("GlassBall", (2.2, -1, 1.8), kit.matte("Glass", (1, 1, 1)))
    head(level, skin).location = 0.6, 3.5, 1.2
    light_and_camera((0, -12, 4), (0, 0, 1.5), (2500, 1200))


def main():
    folder, quick = os.path.abspath(sys.argv[1]), "--quick" in sys.argv[2:]
    os.makedirs(folder, exist_ok=True)
    for make, level in ((mesh1m, 4), (inst100, 3), (spheres, 3)):
        make(level - (3 if make is mesh1m else 1) * quick)
        kit.export_glb(os.path.join(folder, make.__name__ + ".glb"))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main()
