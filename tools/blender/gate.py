"""The gate of the paper's first scene, built of stone blocks (gate.glb).

glTF's axes, y up: pillars from x = 5 to 7 and from -7 to -5, y from 0 to 6.1; beam over them, x from -7 to 7, y from 6 to 8; all z from 0 to 2.
The blocks' faces lie in those planes; their edges are rounded, with narrow joints, backed by a core of mortar 4 cm inside.
Nodes `PillarLeft` (-x), `PillarRight` (+x), `Beam`.
"""
import os

import numpy as np

import kit

JOINT, BEVEL, CORE = 0.008, 0.03, 0.04


def stone_picture(n=1024):
    """Warm limestone, 4 m to the tile: broad stains of different tint, fine grain, pits."""
    broad, tint, fine = kit.noise(n, (4, 9, 21), 1), kit.noise(n, (3, 5), 2), kit.noise(n, (64, 128, 256, 512), 3)
    bands = kit.noise(n, (2, 30), 6)
    pits = np.clip((kit.noise(n, (120, 200), 4) - 0.68) * 9, 0, 1)
    warm, cool = np.array((0.66, 0.50, 0.33)), np.array((0.52, 0.52, 0.50))
    t = np.clip((tint - 0.5) * 3 + 0.5, 0, 1)[..., None]
    color = warm * t + cool * (1 - t)
    color = color * (0.55 + 0.5 * broad + 0.35 * (fine - 0.5) * 2 + 0.15 * bands)[..., None]
    color = color * (1 - 0.6 * pits)[..., None]
    return kit.srgb(color)


def rows(low, high, heights):
    """Cut [low, high] of z into courses of about these heights, in turn."""
    z, k, cuts = low, 0, [low]
    while z < high - 1e-6:
        z = min(z + heights[k % len(heights)], high)
        cuts.append(z)
        k += 1
    return list(zip(cuts, cuts[1:]))


def pillar_blocks(x0):
    """Courses of two blocks, split now across and now along."""
    for k, (a, b) in enumerate(rows(0, 6.0, (0.64, 0.56, 0.65, 0.55))):
        cut = 0.85 + 0.3 * ((k * 7) % 4) / 3
        if k % 2:
            yield (x0, -2, a), (x0 + cut, 0, b)
            yield (x0 + cut, -2, a), (x0 + 2, 0, b)
        else:
            yield (x0, -2, a), (x0 + 2, -cut, b)
            yield (x0, -cut, a), (x0 + 2, 0, b)


def beam_blocks():
    """Three courses of long blocks, joints staggered."""
    for (a, b), starts in zip(rows(6, 8, (0.72, 0.68, 0.60)), ([-7, -4.9, -2.6, -0.9, 0.9, 2.6, 4.9, 7], [-7, -5.8, -3.7, -1.8, 0, 1.8, 3.7, 5.8, 7], [-7, -4.7, -2.9, -1, 1, 2.9, 4.7, 7])):
        for x0, x1 in zip(starts, starts[1:]):
            yield (x0, -2, a), (x1, 0, b)


def wall(name, low, high, blocks, materials, seed):
    """A core and the blocks about it, as one mesh. Outer faces stay in the planes of low and high; joints only inside."""
    rng = np.random.default_rng(seed)
    low, high = np.array(low, float), np.array(high, float)
    parts = [kit.bevelled_box(name, low + CORE, high - CORE, material=materials[1])]
    kit.box_uv(parts[0], 4)
    for a, b in blocks:
        a, b = np.array(a, float), np.array(b, float)
        a = np.where(np.isclose(a, low), a, a + JOINT)
        b = np.where(np.isclose(b, high), b, b - JOINT)
        part = kit.bevelled_box(name, a, b, BEVEL, 2, materials[0])
        kit.box_uv(part, 4, rng.random(2))
        parts.append(part)
    return kit.join(parts, name)


def main():
    folder = kit.output_folder()
    kit.empty_scene()
    materials = [kit.matte("Stone", texture=kit.image("stone", stone_picture(), quality=85)), kit.matte("Mortar", (0.20, 0.18, 0.15))]
    wall("PillarLeft", (-7, -2, 0), (-5, 0, 6.1), pillar_blocks(-7), materials, 11)
    wall("PillarRight", (5, -2, 0), (7, 0, 6.1), pillar_blocks(5), materials, 12)
    wall("Beam", (-7, -2, 6), (7, 0, 8), beam_blocks(), materials, 13)
    kit.export_glb(os.path.join(folder, "gate.glb"))


if __name__ == "__main__":
    main()
