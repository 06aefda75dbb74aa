"""A camera that walks through a gate of pillars, on an arm that swings (walk.glb), and where Blender sees things (walk.csv).

The camera has keys of its own (Bezier, exported as one key each frame), and hangs on an empty that turns and moves. walk.csv has for some
frames the pixel, in a picture of 640 x 360, at which Blender's own projection has each of the points: columns frame, x, y, z (glTF's axes), across, down.
"""
import math
import os

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

import kit

FRAMES, RATE = 48, 24
COLORS = [("Rust", (0.55, 0.12, 0.04)), ("Slate", (0.10, 0.14, 0.22)), ("Moss", (0.14, 0.30, 0.08)), ("Sand", (0.62, 0.50, 0.30))]
POINTS = [(-2.0, 3.0, 0.0), (2.0, 3.0, 2.5), (-2.0, 7.0, 2.5), (2.0, 7.0, 0.0), (0.3, 11.0, 1.2), (-0.7, 5.0, 3.0)]


def keyed(o, path, frames):
    for at, value in frames:
        setattr(o, path, value)
        o.keyframe_insert(path, frame=at)


def main():
    folder = kit.output_folder()
    kit.empty_scene()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 0, FRAMES, RATE
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 640, 360, 100
    materials = [kit.matte(name, color) for name, color in COLORS]
    for row in range(4):
        for side in (-1, 1):
            x, y = 2.0 * side, 2.0 + 3.0 * row
            kit.bevelled_box(f"Pillar{row}{'L' if side < 0 else 'R'}", (x - 0.3, y - 0.3, 0), (x + 0.3, y + 0.3, 2.8), 0.05, 1, materials[row])
    kit.bevelled_box("Floor", (-4, -6, -0.2), (4, 16, 0), 0.02, 1, kit.matte("Floor", (0.35, 0.35, 0.35)))

    arm = bpy.data.objects.new("Arm", None)
    scene.collection.objects.link(arm)
    keyed(arm, "location", [(0, (0, -4, 0)), (24, (0.6, 0, 0.2)), (FRAMES, (0, 6, 0))])
    keyed(arm, "rotation_euler", [(0, (0, 0, 0.2)), (30, (0, 0, -0.25)), (FRAMES, (0, 0, 0.1))])
    data = bpy.data.cameras.new("Camera")
    data.lens, data.sensor_width = 24, 36
    camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(camera)
    camera.parent = arm
    keyed(camera, "location", [(0, (0, 0, 1.6)), (20, (-0.8, 0.4, 1.9)), (FRAMES, (0.3, 0, 1.5))])
    keyed(camera, "rotation_euler", [(0, (math.radians(88), 0, 0)), (26, (math.radians(82), 0.1, 0.3)), (FRAMES, (math.radians(92), 0, -0.1))])
    still = bpy.data.objects.new("Still", bpy.data.cameras.new("Still"))
    still.location, still.rotation_euler = (3, -3, 2.2), (math.radians(80), 0, 0.5)
    scene.collection.objects.link(still)
    flat = bpy.data.cameras.new("Plan")
    flat.type = "ORTHO"
    plan = bpy.data.objects.new("Plan", flat)
    plan.location = (0, 5, 12)
    scene.collection.objects.link(plan)
    scene.camera = camera

    rows = []
    for at in range(0, FRAMES + 1, 4):
        scene.frame_set(at)
        for point in POINTS:
            seen = world_to_camera_view(scene, camera, Vector(point))
            if seen.z > 0:
                x, y, z = point
                rows.append(f"{at},{x:.9g},{z:.9g},{-y:.9g},{640 * seen.x:.6f},{360 * (1 - seen.y):.6f}")
    with open(os.path.join(folder, "walk.csv"), "w") as f:
        f.write("frame,x,y,z,across,down\n" + "\n".join(rows) + "\n")
    kit.export_glb(
        os.path.join(folder, "walk.glb"), export_animations=True, export_animation_mode="SCENE", export_force_sampling=True,
        export_optimize_animation_size=False,
    )


if __name__ == "__main__":
    main()
