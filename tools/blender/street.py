"""A lamp-lit street corner at night (street.glb), some 270,000 triangles shown from a tenth of that stored, by meshes used many times.

glTF's axes, y up: the main street runs along x, carriageway z from -4 to 4, pavements to 6.5, houses on both sides; a lane leaves it at
x = 0 towards -z. Seven lamp posts (`Lamp...`, points), two bracket lamps (`Spot...`) and the moon (`Moon`, directional) come as KHR_lights_punctual;
`Camera` stands on the carriageway and looks at the corner. Lamps: 12 W in Blender's terms are 652 cd, a real lantern of 8,000 lm.
Emission strengths are luminances in cd/m2, as glTF wants them (Blender itself would show them 683 times too bright beside the lamps).
"""
import math
import os

import bpy
import numpy as np
from mathutils import Vector

import kit
import street_parts as parts


# ---------------------------------------------------------------- surfaces

def brick_picture(n=512, across=8, courses=26):
    """Two metres of brickwork."""
    rng = np.random.default_rng(1)
    row, column = np.divmod(np.arange(4 * n * n).reshape(2 * n, 2 * n), 2 * n)
    v = row * courses / (2 * n)
    u = column * across / (2 * n) + 0.5 * (np.floor(v) % 2)
    tint = rng.random((courses, across))[np.floor(v).astype(int), np.floor(u).astype(int) % across][..., None]
    color = np.array((0.34, 0.105, 0.06)) * (1 - tint) + np.array((0.48, 0.20, 0.11)) * tint
    color = color * (0.75 + 0.5 * kit.noise(2 * n, (8, 64, 256), 2)[..., None])
    joint = ((u % 1) < 0.05) | ((v % 1) < 0.15)
    return kit.srgb(kit.shrink(np.where(joint[..., None], (0.36, 0.33, 0.28), color), 2))


def plaster_picture(color, seed, n=512):
    """Painted plaster, stained."""
    shade = 0.72 + 0.4 * kit.noise(n, (3, 7, 30), seed) + 0.25 * (kit.noise(n, (90, 170), seed + 1) - 0.5)
    return kit.srgb(np.array(color) * shade[..., None])


def roof_picture(n=256, across=10, courses=12):
    """Scalloped tiles."""
    rng = np.random.default_rng(3)
    row, column = np.divmod(np.arange(4 * n * n).reshape(2 * n, 2 * n), 2 * n)
    v = row * courses / (2 * n)
    u = column * across / (2 * n) + 0.5 * (np.floor(v) % 2)
    tint = rng.random((courses, across))[np.floor(v).astype(int), np.floor(u).astype(int) % across]
    edge = (v % 1) > 0.62 + 0.36 * np.sqrt(np.clip(1 - (2 * (u % 1) - 1) ** 2, 0, 1))
    shade = np.where(edge, 0.4, 0.7 + 0.5 * tint + 0.2 * (v % 1))
    return kit.srgb(kit.shrink(np.array((0.26, 0.11, 0.075)) * shade[..., None], 2))


def paving_picture(n=512):
    """Slabs of half a metre, 2 m to the tile."""
    rng = np.random.default_rng(5)
    row, column = np.divmod(np.arange(n * n).reshape(n, n), n)
    s = n // 4
    shift = (row // s % 2) * (s // 2)
    tint = rng.random((4, 4))[row // s, (column + shift) // s % 4]
    shade = (0.8 + 0.3 * tint) * (0.75 + 0.5 * kit.noise(n, (16, 128, 256), 6))
    joint = (row % s < 3) | ((column + shift) % s < 3)
    return kit.srgb(np.where(joint[..., None], 0.10, np.array((0.36, 0.35, 0.33)) * shade[..., None]))


def cobble_picture(n=256):
    """Granite of several tints."""
    t, fine = kit.noise(n, (6, 11), 7), kit.noise(n, (64, 128), 8)
    t = np.clip((t - 0.5) * 3 + 0.5, 0, 1)[..., None]
    return kit.srgb((np.array((0.30, 0.25, 0.21)) * t + np.array((0.19, 0.21, 0.25)) * (1 - t)) * (0.6 + 0.8 * fine[..., None]))


def materials():
    """Every material by name."""
    made = {}
    pictures = {
        "Brick": brick_picture(), "Roof": roof_picture(), "Paving": paving_picture(), "Cobble": cobble_picture(),
        "PlasterOchre": plaster_picture((0.66, 0.42, 0.17), 20), "PlasterGreen": plaster_picture((0.36, 0.50, 0.36), 30), "PlasterBlue": plaster_picture((0.34, 0.43, 0.56), 40),
    }
    for name, picture in pictures.items():
        made[name] = kit.matte(name, texture=kit.image(name.lower(), picture, quality=82))
    plain = {
        "Stone": (0.50, 0.47, 0.42), "Trim": (0.68, 0.66, 0.60), "Pane": (0.03, 0.035, 0.045), "Door": (0.05, 0.16, 0.10), "Shutter": (0.08, 0.20, 0.27), "Joint": (0.06, 0.055, 0.05),
        "Metal": (0.035, 0.04, 0.045), "AwningRed": (0.50, 0.05, 0.04), "AwningWhite": (0.72, 0.70, 0.64), "PaintRed": (0.48, 0.03, 0.03), "PaintCream": (0.62, 0.56, 0.42), "PaintBlue": (0.05, 0.16, 0.42),
        "Bark": (0.13, 0.09, 0.06), "Leaf": (0.10, 0.24, 0.05), "LeafDark": (0.06, 0.15, 0.05),
    }
    for name, color in plain.items():
        made[name] = kit.matte(name, color)
    shining = {
        "PaneLit": ((1.0, 0.66, 0.30), 30), "PaneDim": ((1.0, 0.50, 0.18), 8), "ShopGlow": ((1.0, 0.80, 0.55), 45), "Neon": ((0.08, 0.55, 1.0), 160),
        "Bulb": ((1.0, 0.72, 0.42), 900), "Headlight": ((1.0, 0.92, 0.8), 300), "Taillight": ((1.0, 0.03, 0.01), 60),
    }
    for name, (color, nits) in shining.items():
        made[name] = kit.matte(name, (0.5, 0.5, 0.5), glow=color, strength=nits)
    return made


# ---------------------------------------------------------------- the place

def houses(m):
    """Six kinds of house, set along both sides of the street and down the lane."""
    three, four = (3.5, 3.1, 3.1), (3.5, 3.0, 3.0, 2.8)
    kinds = [
        parts.house(m, "HouseOchre", 6.0, 9.0, three, "PlasterOchre", 1), parts.house(m, "HouseBrick", 6.0, 9.0, four, "Brick", 2),
        parts.house(m, "HouseGreen", 6.0, 9.0, three, "PlasterGreen", 3), parts.house(m, "HouseBlue", 6.0, 9.0, four, "PlasterBlue", 4),
    ]
    cafe = parts.house(m, "HouseCafe", 8.0, 9.0, four, "PlasterOchre", 5, shop=True, flank=True)
    corner = parts.house(m, "HouseCorner", 8.0, 9.0, four, "Brick", 6, flank=True)
    kit.place("HouseCafe", cafe, at=(4.5, 6.5, 0.1))
    kit.place("HouseCorner", corner, at=(-12.5, 6.5, 0.1))
    for k in range(5):
        kit.place(f"HouseNE{k}", kinds[(k + 2) % 4], at=(12.5 + 6 * k, 6.5, 0.1))
        kit.place(f"HouseNW{k}", kinds[(k + 3) % 4], at=(-18.5 - 6 * k, 6.5, 0.1))
    for k in range(14):
        kit.place(f"HouseS{k}", kinds[(3 * k + 1) % 4], at=(-36 + 6 * k, -6.5, 0.1), turn=(0, 0, 180))
    for k in range(4):
        kit.place(f"HouseLaneE{k}", kinds[(k + 1) % 4], at=(4.5, 21.5 + 6 * k, 0.1), turn=(0, 0, -90))
        kit.place(f"HouseLaneW{k}", kinds[(k + 2) % 4], at=(-4.5, 15.5 + 6 * k, 0.1), turn=(0, 0, 90))
    for k in range(2):
        kit.place(f"HouseEnd{k}", kinds[(k + 3) % 4], at=(-6 + 6 * k, 40.5, 0.1))


def ground(m):
    """Setts on the carriageways, paving beside them."""
    setts = parts.cobbles(m)
    for i in range(21):
        for j in range(2):
            kit.place(f"Setts{i}.{j}", setts, at=(-42 + 4 * i, -4 + 4 * j, 0))
    for j in range(9):
        kit.place(f"SettsLane{j}", setts, at=(-2, 4 + 4 * j, 0))
    p = parts.Pile(m)
    for low, high in (((-43, 4.21), (-2.21, 6.6)), ((2.21, 4.21), (43, 6.6)), ((-43, -6.6), (43, -4.21)), ((2.21, 6.6), (4.6, 40.6)), ((-4.6, 6.6), (-2.21, 40.6))):
        parts.pavement(p, low, high)
    kit.place("Pavements", p.mesh("Pavements"))
    kerb = parts.Pile(m)
    for k in range(4):
        kerb.box((k + 0.006, 0, -0.05), (k + 0.994, 0.22, 0.145), "Stone", "z")
    kerb = kerb.mesh("Kerb")
    for k in range(21):
        kit.place(f"KerbS{k}", kerb, at=(-42 + 4 * k, -4.22, 0))
        x = -42 + 4 * k
        if not -6 < x < 2:
            kit.place(f"KerbN{k}", kerb, at=(x, 4, 0))
    for k in range(9):
        kit.place(f"KerbLaneE{k}", kerb, at=(2.22, 4 + 4 * k, 0), turn=(0, 0, 90))
        kit.place(f"KerbLaneW{k}", kerb, at=(-2, 4 + 4 * k, 0), turn=(0, 0, 90))


def things(m):
    """Cars, trees, bollards."""
    red, cream, blue = (parts.car(m, f"Paint{c}", f"Car{c}") for c in ("Red", "Cream", "Blue"))
    for name, data, at, turn in (("CarRed", red, (9.5, 2.9, 0.02), 180), ("CarCream", cream, (-9.5, -2.9, 0.02), 0), ("CarBlue", blue, (-16, -2.9, 0.02), 0), ("CarBlue2", blue, (22, 2.9, 0.02), 180), ("CarCream2", cream, (17, -2.9, 0.02), 0)):
        kit.place(name, data, at=at, turn=(0, 0, turn))
    tree = parts.tree(m)
    for k, (x, y) in enumerate(((-8.5, 4.9), (-17.5, 4.9), (15.5, 4.9), (6.5, -5.0), (-4.5, -5.0), (-22, -5.0), (25, 4.9))):
        kit.place(f"Tree{k}", tree, at=(x, y, 0.1), turn=(0, 0, 67 * k), scale=(1 + 0.06 * (k % 3),) * 3)
    bollard = parts.bollard(m)
    for k in range(6):
        kit.place(f"Bollard{k}", bollard, at=(2.5 + 1.2 * (k // 2) if k % 2 else -2.5 - 1.2 * (k // 2), 4.5, 0.13))


def lamps(m):
    """Lights, each with the thing it shines from."""
    post, bracket = parts.lamp_post(m), parts.bracket_lamp(m)
    warm = (1.0, 0.70, 0.40)
    for k, (x, y) in enumerate(((-5.2, 4.6), (8.2, 4.6), (-14.5, 4.6), (20.5, 4.6), (1.5, -4.7), (-11.5, -4.7), (14.5, -4.7))):
        kit.place(f"LampPost{k}", post, at=(x, y, 0.13))
        light(f"Lamp{k}", "POINT", 12.0, warm, (x, y, 3.75))
    for k, (x, y, side) in enumerate(((4.5, 18.0, -90), (-4.5, 27.0, 90))):
        kit.place(f"Bracket{k}", bracket, at=(x, y, 4.0), turn=(0, 0, side))
        o = light(f"Spot{k}", "SPOT", 25.0, (1.0, 0.90, 0.75), (x - 0.9 * np.sign(x), y, 4.08))
        o.data.spot_size, o.data.spot_blend = math.radians(130), 0.5
    moon = light("Moon", "SUN", 0.0006, (0.65, 0.80, 1.0), (0, 0, 30))
    moon.rotation_euler = (math.radians(48), 0, math.radians(-25))


def light(name, kind, watts, color, at):
    """A lamp with no size: hard shadows, as terrell draws them."""
    data = bpy.data.lights.new(name, kind)
    data.energy, data.color = watts, color
    if kind != "SUN":
        data.shadow_soft_size = 0.0
    else:
        data.angle = 0.0
    return kit.place(name, data, at=at)


def camera():
    """On the carriageway, looking at the corner and into the lane."""
    data = bpy.data.cameras.new("Camera")
    data.angle = math.radians(75)
    o = kit.place("Camera", data, at=(-6.5, -3.2, 1.65))
    o.rotation_euler = (Vector((2.6, 9.0, 3.0)) - o.location).to_track_quat("-Z", "Y").to_euler()
    sc = bpy.context.scene
    sc.camera = o
    sc.render.resolution_x, sc.render.resolution_y = 1280, 720


def main():
    folder = kit.output_folder()
    kit.empty_scene()
    m = materials()
    houses(m)
    ground(m)
    things(m)
    lamps(m)
    camera()
    kit.export_glb(os.path.join(folder, "street.glb"))


if __name__ == "__main__":
    main()
