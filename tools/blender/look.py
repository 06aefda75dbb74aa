"""A quick Cycles picture of an exported .glb or .obj, to see what was made.

usage: python look.py MODEL PICTURE.png [EYE_X EYE_Y EYE_Z  AT_X AT_Y AT_Z]   (glTF axes, y up; without them: a view of everything)
Uses the file's own lamps and camera if it has any, else a sun and a sky.
"""
import math
import sys

import bpy
import numpy as np
from mathutils import Vector

import kit


def main():
    model, picture, *numbers = sys.argv[1:]
    kit.empty_scene()
    if model.endswith(".obj"):
        bpy.ops.wm.obj_import(filepath=model)
    else:
        bpy.ops.import_scene.gltf(filepath=model)
    sc = bpy.context.scene
    corners = np.array([o.matrix_world @ Vector(c) for o in sc.objects if o.type == "MESH" for c in o.bound_box])
    low, high = corners.min(0), corners.max(0)
    print("box in glTF axes:", low[[0, 2]], -high[1], "to", high[[0, 2]], -low[1])
    for m in bpy.data.materials:  # glTF's luminances beside Blender's watts
        m.node_tree.nodes["Principled BSDF"].inputs["Emission Strength"].default_value /= 683
    lamps = [o for o in sc.objects if o.type == "LIGHT"]
    sky(0.35 if not lamps else 0.0005)
    if not lamps:
        sun = kit.place("Sun", bpy.data.lights.new("Sun", "SUN"), turn=(50, 0, 35))
        sun.data.energy = 3
    cameras = [o for o in sc.objects if o.type == "CAMERA"]
    if numbers or not cameras:
        sc.camera = aim(low, high, [float(n) for n in numbers])
    else:
        sc.camera = cameras[0]
    sc.render.engine = "CYCLES"
    sc.cycles.samples = 48
    sc.cycles.use_denoising = False
    sc.render.resolution_x, sc.render.resolution_y = 960, 540
    sc.view_settings.view_transform = "Standard" if not lamps else "AgX"
    sc.view_settings.exposure = 0 if not lamps else 4.8
    sc.render.filepath = picture
    bpy.ops.render.render(write_still=True)


def sky(strength):
    w = bpy.data.worlds.new("Sky")
    bpy.context.scene.world = w
    w.use_nodes = True
    b = w.node_tree.nodes["Background"]
    b.inputs["Color"].default_value, b.inputs["Strength"].default_value = (0.75, 0.87, 1, 1), strength


def aim(low, high, numbers):
    if numbers:
        eye, at = [Vector((n[0], -n[2], n[1])) for n in (numbers[:3], numbers[3:6])]
    else:
        at = Vector((low + high) / 2)
        eye = at + Vector((0.45, -1, 0.4)).normalized() * float(np.linalg.norm(high - low)) * 1.3
    c = bpy.data.cameras.new("Look")
    c.angle = math.radians(50)
    o = kit.place("Look", c, at=eye)
    o.rotation_euler = (at - eye).to_track_quat("-Z", "Y").to_euler()
    return o


if __name__ == "__main__":
    main()
