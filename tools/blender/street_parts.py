"""Parts of the street: a builder of boxes and quads, houses, paving, lamps, cars, trees. Blender axes; every house faces -y with its foot at the origin."""
import numpy as np

import kit

TILE = {"Brick": 2.0, "PlasterOchre": 3.0, "PlasterGreen": 3.0, "PlasterBlue": 3.0, "Roof": 2.0, "Paving": 2.0, "Cobble": 2.0}


class Pile:
    """Quads and boxes of named materials, to become one mesh."""

    def __init__(self, materials):
        self.materials, self.vertices, self.faces, self.kinds, self.uv = materials, [], [], [], []

    def face(self, corners, material):
        """A flat face, counter-clockwise seen from outside; its UVs lie along the axis nearest to its normal."""
        c = np.array(corners, float)
        n = np.cross(c[1] - c[0], c[2] - c[0])
        axis = int(np.argmax(np.abs(n)))
        size = TILE.get(material, 1.0)
        u, v = [(1, 2), (0, 2), (0, 1)][axis]
        self.uv += [(p[u] / size, p[v] / size) for p in c]
        self.faces.append(tuple(range(len(self.vertices), len(self.vertices) + len(c))))
        self.vertices += [tuple(p) for p in c]
        self.kinds.append(material)

    def box(self, low, high, material, without=""):
        """A box; `without` names sides left out, of x X y Y z Z (small: the low side)."""
        (a, b, c), (d, e, f) = low, high
        sides = {
            "x": [(a, e, c), (a, b, c), (a, b, f), (a, e, f)], "X": [(d, b, c), (d, e, c), (d, e, f), (d, b, f)],
            "y": [(a, b, c), (d, b, c), (d, b, f), (a, b, f)], "Y": [(d, e, c), (a, e, c), (a, e, f), (d, e, f)],
            "z": [(a, e, c), (d, e, c), (d, b, c), (a, b, c)], "Z": [(a, b, f), (d, b, f), (d, e, f), (a, e, f)],
        }
        for name, corners in sides.items():
            if name not in without:
                self.face(corners, material)

    def tube(self, points, radii, material, sides=10):
        """A round tube along points, one radius each."""
        rings = []
        for k, p in enumerate(np.array(points, float)):
            way = np.array(points[min(k + 1, len(points) - 1)], float) - np.array(points[max(k - 1, 0)], float)
            way /= np.linalg.norm(way)
            a = np.cross(way, (0, 1, 0) if abs(way[1]) < 0.9 else (1, 0, 0))
            a /= np.linalg.norm(a)
            b = np.cross(way, a)
            turn = np.arange(sides) * 2 * np.pi / sides
            rings.append(p + radii[k] * (np.cos(turn)[:, None] * a + np.sin(turn)[:, None] * b))
        for r, s in zip(rings, rings[1:]):
            for i in range(sides):
                j = (i + 1) % sides
                self.face([r[i], r[j], s[j], s[i]], material)

    def turned(self, quarter_turns, shift):
        """A view of this pile that adds everything turned about z and moved."""
        return Turned(self, quarter_turns, shift)

    def mesh(self, name):
        """The finished mesh, as data that many objects may show."""
        import bpy
        used = sorted(set(self.kinds))
        o = kit.mesh_object(name, self.vertices, self.faces, [self.materials[m] for m in used], [used.index(k) for k in self.kinds], self.uv)
        data = o.data
        if not any(m in TILE for m in used):
            data.uv_layers.remove(data.uv_layers[0])
        bpy.data.objects.remove(o)
        return data


class Turned(Pile):
    """Writes into another pile through a quarter turn and a shift."""

    def __init__(self, pile, quarter_turns, shift):
        self.pile, self.shift = pile, np.array(shift, float)
        c, s = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarter_turns % 4]
        self.matrix = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]], float)

    def face(self, corners, material):
        self.pile.face([self.matrix @ np.array(p, float) + self.shift for p in corners], material)


# ---------------------------------------------------------------- houses

def facade(pile, width, floors, wall, rng, shop=None, door=True):
    """A wall in the plane y = 0, x from 0 to width: storeys of windows with reveals, frames, sills, lintels; a door or a shop below."""
    count = max(1, round(width / 2.1))
    pitch = width / count
    holes, z = [], 0.0
    for level, height in enumerate(floors):
        for k in range(count):
            x = (k + 0.5) * pitch
            if level == 0 and shop:
                continue
            if level == 0 and door and k == 0:
                holes.append((x - 0.55, x + 0.55, 0.0, 2.5, "door"))
            else:
                holes.append((x - 0.52, x + 0.52, z + 0.95, z + height - 0.45, "window"))
        if level == 0 and shop:
            holes.append((0.45, width - 1.9, 0.55, 2.9, "shop"))
            holes.append((width - 1.5, width - 0.45, 0.0, 2.6, "door"))
        z += height
    wall_with_holes(pile, width, z, holes, wall)
    for hole in holes:
        {"window": window, "door": entrance, "shop": shop_window}[hole[4]](pile, *hole[:4], rng)
    pile.box((-0.03, -0.06, 0), (width + 0.03, 0.0, 0.5), "Stone", "zY") if not shop else None
    pile.box((-0.05, -0.12, floors[0] - 0.12), (width + 0.05, 0, floors[0] + 0.05), "Stone", "Y")
    pile.box((-0.08, -0.22, z - 0.1), (width + 0.08, 0, z + 0.12), "Stone", "Y")
    pile.box((-0.04, -0.13, z - 0.28), (width + 0.04, 0, z - 0.1), "Stone", "YZ")
    for k in range(round(width / 0.42)):
        x = (k + 0.5) * width / round(width / 0.42)
        pile.box((x - 0.06, -0.2, z - 0.22), (x + 0.06, -0.1, z - 0.1), "Stone", "YZ")


def wall_with_holes(pile, width, height, holes, wall):
    """Cut the wall along every hole's edges and leave the cells inside holes out."""
    xs = sorted({0.0, width, *(v for h in holes for v in h[:2])})
    zs = sorted({0.0, height, *(v for h in holes for v in h[2:4])})
    for c, d in zip(zs, zs[1:]):
        for a, b in zip(xs, xs[1:]):
            if not any(h[0] < (a + b) / 2 < h[1] and h[2] < (c + d) / 2 < h[3] for h in holes):
                pile.face([(a, 0, c), (b, 0, c), (b, 0, d), (a, 0, d)], wall)


def reveal(pile, a, b, c, d, depth, material):
    """The four inner sides of a hole."""
    pile.face([(a, 0, c), (a, 0, d), (a, depth, d), (a, depth, c)], material)
    pile.face([(b, 0, d), (b, 0, c), (b, depth, c), (b, depth, d)], material)
    pile.face([(a, 0, d), (b, 0, d), (b, depth, d), (a, depth, d)], material)
    pile.face([(b, 0, c), (a, 0, c), (a, depth, c), (b, depth, c)], material)


def window(pile, a, b, c, d, rng):
    """Two casements of three panes, sill, lintel; some are lit, some have shutters."""
    reveal(pile, a, b, c, d, 0.22, "Trim")
    lit = rng.random()
    pane = "PaneLit" if lit < 0.22 else "PaneDim" if lit < 0.36 else "Pane"
    pile.face([(a, 0.2, c), (b, 0.2, c), (b, 0.2, d), (a, 0.2, d)], pane)
    w, m = 0.055, (a + b) / 2
    for x in (a, m - w / 2, b - w):
        pile.box((x, 0.13, c), (x + w, 0.2, d), "Trim", "YzZ")
    for z in (c, c + (d - c) / 3, c + 2 * (d - c) / 3, d - w):
        pile.box((a, 0.14, z), (b, 0.2, z + w * 0.8), "Trim", "YxX")
    pile.box((a - 0.1, -0.12, c - 0.09), (b + 0.1, 0.12, c), "Stone", "Y")
    pile.box((a - 0.14, -0.05, d), (b + 0.14, 0, d + 0.2), "Stone", "Y")
    pile.box(((a + b) / 2 - 0.09, -0.09, d - 0.03), ((a + b) / 2 + 0.09, 0, d + 0.26), "Stone", "Y")
    if rng.random() < 0.35:
        for x in (a - 0.5, b + 0.02):
            shutter(pile, x, c, d)


def shutter(pile, x, c, d):
    """A louvred shutter folded back on the wall."""
    pile.box((x, -0.035, c), (x + 0.48, 0, d), "Shutter", "Y")
    for k in range(9):
        z = c + 0.08 + k * (d - c - 0.16) / 9
        pile.face([(x + 0.05, -0.04, z), (x + 0.43, -0.04, z), (x + 0.43, -0.065, z + 0.1), (x + 0.05, -0.065, z + 0.1)], "Shutter")


def entrance(pile, a, b, c, d, rng):
    """A panelled door over a step, with a lit fanlight."""
    reveal(pile, a, b, c, d, 0.3, "Trim")
    pile.face([(a, 0.28, c), (b, 0.28, c), (b, 0.28, d - 0.45), (a, 0.28, d - 0.45)], "Door")
    pile.face([(a, 0.28, d - 0.45), (b, 0.28, d - 0.45), (b, 0.28, d), (a, 0.28, d)], "PaneDim")
    pile.box((a, 0.2, d - 0.5), (b, 0.28, d - 0.43), "Trim", "YxX")
    for k in range(2):
        for z0, z1 in ((c + 0.2, c + 0.8), (c + 0.95, d - 0.65)):
            x = a + 0.1 + k * (b - a - 0.1) / 2
            pile.box((x, 0.25, z0), (x + (b - a) / 2 - 0.15, 0.28, z1), "Door", "Y")
    pile.box((a - 0.15, -0.35, 0), (b + 0.15, 0.02, 0.14), "Stone", "zY")
    pile.box((a - 0.16, -0.06, c), (a, 0, d + 0.16), "Stone", "Yz")
    pile.box((b, -0.06, c), (b + 0.16, 0, d + 0.16), "Stone", "Yz")
    pile.box((a, -0.06, d), (b, 0, d + 0.16), "Stone", "YxX")


def shop_window(pile, a, b, c, d, rng):
    """A bright shop front with goods on shelves, a striped awning and a sign in dots of light."""
    reveal(pile, a, b, c, d, 0.9, "Trim")
    pile.face([(a, 0.9, c), (b, 0.9, c), (b, 0.9, d), (a, 0.9, d)], "ShopGlow")
    for x in np.linspace(a, b - 0.06, 4):
        pile.box((x, 0.0, c), (x + 0.06, 0.06, d), "Metal", "zZ")
    for z in (c + 0.5, c + 1.15):
        pile.box((a, 0.5, z), (b, 0.88, z + 0.04), "Trim", "xXY")
        for x in np.arange(a + 0.15, b - 0.3, 0.3):
            tall = 0.12 + 0.25 * rng.random()
            pile.box((x, 0.58, z + 0.04), (x + 0.1 + 0.1 * rng.random(), 0.75, z + 0.04 + tall), ("Door", "Shutter", "AwningRed")[int(rng.integers(3))], "z")
    stripes = round((b - a + 0.4) / 0.25)
    x = np.linspace(a - 0.2, b + 0.2, stripes + 1)
    for k in range(stripes):
        color = "AwningRed" if k % 2 else "AwningWhite"
        pile.face([(x[k], -1.1, d - 0.2), (x[k + 1], -1.1, d - 0.2), (x[k + 1], 0, d + 0.3), (x[k], 0, d + 0.3)], color)
        pile.face([(x[k], -1.1, d - 0.42), (x[k + 1], -1.1, d - 0.42), (x[k + 1], -1.1, d - 0.2), (x[k], -1.1, d - 0.2)], color)
    sign(pile, (a + b) / 2, d + 0.55)


LETTERS = {"C": ("111", "100", "100", "100", "111"), "A": ("111", "101", "111", "101", "101"), "F": ("111", "100", "110", "100", "100"), "E": ("111", "100", "110", "100", "111")}


def sign(pile, middle, z):
    """CAFE, in cubes of light on a dark board."""
    dot = 0.085
    x = middle - 7.5 * dot
    pile.box((x - 0.12, -0.1, z - 0.1), (x + 15 * dot + 0.12, 0, z + 5 * dot + 0.1), "Metal", "Y")
    for letter in "CAFE":
        for i, line in enumerate(LETTERS[letter]):
            for j, on in enumerate(line):
                if on == "1":
                    pile.box((x + j * dot, -0.14, z + (4 - i) * dot), (x + (j + 0.85) * dot, -0.1, z + (4.85 - i) * dot), "Neon", "Y")
        x += 4 * dot


def house(materials, name, width, depth, floors, wall, seed, shop=False, flank=False):
    """A house, its front in y = 0 from x = 0 to width; `flank` gives its sides windows too (for a corner)."""
    pile, rng = Pile(materials), np.random.default_rng(seed)
    height = sum(floors)
    facade(pile, width, floors, wall, rng, shop=shop)
    if flank:
        facade(pile.turned(1, (width, 0, 0)), depth, floors, wall, rng, door=False)
        facade(pile.turned(3, (0, depth, 0)), depth, floors, wall, rng, door=False)
        pile.box((0, 0, 0), (width, depth, height), wall, "xXyzZ")
    else:
        pile.box((0, 0, 0), (width, depth, height), wall, "yzZ")
    roof(pile, width, depth, height)
    return pile.mesh(name)


def roof(pile, width, depth, z):
    """A ridge along x, eaves in front, two dormers' worth of chimney."""
    ridge, over = z + 2.6, 0.3
    pile.face([(-0.05, -over, z), (width + 0.05, -over, z), (width + 0.05, depth / 2, ridge), (-0.05, depth / 2, ridge)], "Roof")
    pile.face([(width + 0.05, depth + over, z), (-0.05, depth + over, z), (-0.05, depth / 2, ridge), (width + 0.05, depth / 2, ridge)], "Roof")
    pile.face([(0, depth, z), (0, 0, z), (0, depth / 2, ridge - 0.08)], "Stone")
    pile.face([(width, 0, z), (width, depth, z), (width, depth / 2, ridge - 0.08)], "Stone")
    pile.box((width * 0.7, depth * 0.35, z + 1), (width * 0.7 + 0.8, depth * 0.35 + 0.6, ridge + 0.9), "Brick", "z")
    for k in range(3):
        x = width * 0.7 + 0.15 + 0.25 * k
        pile.tube([(x, depth * 0.35 + 0.3, ridge + 0.9), (x, depth * 0.35 + 0.3, ridge + 1.3)], [0.09, 0.07], "AwningRed", 8)


# ---------------------------------------------------------------- ground

def cobbles(materials, seed=4, size=4.0, across=16, along=20):
    """A square of rounded setts, their rows shifted; repeats in x and y."""
    rng = np.random.default_rng(seed)
    vertices, faces, uv = [], [], []
    dx, dy = size / across, size / along
    for j in range(along):
        for i in range(across):
            x, y = (i + 0.5 * (j % 2) - 0.25) * dx, j * dy
            gap, rise = 0.012 + 0.008 * rng.random(), 0.012 + 0.02 * rng.random()
            outer = [(x + gap, y + gap), (x + dx - gap, y + gap), (x + dx - gap, y + dy - gap), (x + gap, y + dy - gap)]
            m = 0.045
            inner = [(a + m * s, b + m * t) for (a, b), (s, t) in zip(outer, ((1, 1), (-1, 1), (-1, -1), (1, -1)))]
            n = len(vertices)
            tilt = rng.uniform(-0.006, 0.006, 4)
            vertices += [(a, b, -0.035) for a, b in outer] + [(a, b, rise + t) for (a, b), t in zip(inner, tilt)]
            faces += [(n + 4, n + 5, n + 6, n + 7)] + [(n + k, n + (k + 1) % 4, n + 4 + (k + 1) % 4, n + 4 + k) for k in range(4)]
            off = rng.random(2)
            place = {k: (vertices[k][0] / 2 + off[0], vertices[k][1] / 2 + off[1]) for k in range(n, n + 8)}
            uv += [place[k] for f in faces[-5:] for k in f]
    n = len(vertices)
    vertices += [(0, 0, -0.03), (size, 0, -0.03), (size, size, -0.03), (0, size, -0.03)]
    faces.append((n, n + 1, n + 2, n + 3))
    uv += [(0, 0)] * 4
    kinds = [0] * (len(faces) - 1) + [1]
    import bpy
    o = kit.mesh_object("Cobbles", vertices, faces, [materials["Cobble"], materials["Joint"]], kinds, uv, smooth=True)
    data = o.data
    bpy.data.objects.remove(o)
    return data


def pavement(pile, low, high):
    """Raised paving from corner to corner, with a kerb of stones along its rim on every side."""
    (a, b), (c, d) = low, high
    pile.box((a, b, -0.05), (c, d, 0.13), "Paving", "z")


# ---------------------------------------------------------------- things

def lamp_post(materials):
    """A lantern on a post 4 m high, open below its bulb, where the light hangs (0, 0, 3.62)."""
    p = Pile(materials)
    p.tube([(0, 0, 0), (0, 0, 0.25), (0, 0, 0.3), (0, 0, 0.9), (0, 0, 1.0), (0, 0, 3.25), (0, 0, 3.3), (0, 0, 3.36)], [0.16, 0.16, 0.1, 0.085, 0.06, 0.045, 0.09, 0.03], "Metal", 12)
    for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        p.tube([(0.06 * x, 0.06 * y, 3.32), (0.17 * x, 0.17 * y, 3.85)], [0.011, 0.011], "Metal", 5)
    p.tube([(0, 0, 3.83), (0, 0, 3.87), (0, 0, 4.02), (0, 0, 4.1), (0, 0, 4.18)], [0.27, 0.27, 0.1, 0.04, 0.01], "Metal", 12)
    p.face([(0.19, 0.19, 3.84), (0.19, -0.19, 3.84), (-0.19, -0.19, 3.84), (-0.19, 0.19, 3.84)], "Trim")
    p.tube([(0, 0, 3.83), (0, 0, 3.82), (0, 0, 3.76), (0, 0, 3.7), (0, 0, 3.68)], [0.03, 0.07, 0.09, 0.06, 0.001], "Bulb", 12)
    return p.mesh("LampPost")


def bracket_lamp(materials):
    """A shade on an arm from a wall in y = 0, for the spot at (0, -0.9, 0.1) shining down."""
    p = Pile(materials)
    p.tube([(0, 0, 0), (0, -0.15, 0.25), (0, -0.45, 0.42), (0, -0.78, 0.42), (0, -0.9, 0.3)], [0.025] * 5, "Metal", 8)
    p.tube([(0, -0.9, 0.32), (0, -0.9, 0.28), (0, -0.9, 0.2), (0, -0.9, 0.12)], [0.03, 0.07, 0.14, 0.26], "Metal", 16)
    p.tube([(0, -0.9, 0.24), (0, -0.9, 0.18), (0, -0.9, 0.14)], [0.05, 0.06, 0.001], "Bulb", 10)
    return p.mesh("BracketLamp")


def car(materials, paint, name):
    """A small car 4 m long along x, its wheels on z = 0."""
    p = Pile(materials)
    waist, roof_z, w = 0.92, 1.42, 0.84
    outline = [(-2.0, 0.35), (-2.02, 0.7), (-1.95, 0.86), (-1.1, waist), (0.95, waist), (1.55, 0.86), (1.98, 0.72), (2.02, 0.35)]
    for side in (-1, 1):
        ring = [(x, side * (w - 0.03 * (z > 0.8)), z) for x, z in outline]
        p.face(ring if side < 0 else ring[::-1], paint)
    for (x0, z0), (x1, z1) in zip(outline, outline[1:]):
        p.face([(x0, w, z0), (x0, -w, z0), (x1, -w, z1), (x1, w, z1)][::-1], paint)
    p.face([(-2.0, -w, 0.35), (-2.0, w, 0.35), (2.02, w, 0.35), (2.02, -w, 0.35)], "Metal")
    low, high, t = [(-1.75, waist - 0.02), (0.85, waist - 0.02)], [(-1.3, roof_z), (0.2, roof_z)], 0.66
    cabin = lambda y_low, y_high: [(low[0][0], y_low, low[0][1]), (low[1][0], y_low, low[1][1]), (high[1][0], y_high, high[1][1]), (high[0][0], y_high, high[0][1])]
    p.face(cabin(-w + 0.05, -t), "Pane")
    p.face(cabin(w - 0.05, t)[::-1], "Pane")
    (a, b, c, d), (e, f, g, h) = cabin(-w + 0.05, -t), cabin(w - 0.05, t)
    p.face([b, f, g, c], "Pane")
    p.face([a, d, h, e], "Pane")
    p.box((high[0][0], -t, roof_z - 0.02), (high[1][0], t, roof_z + 0.04), paint)
    for x in (-0.45,):
        for s in (-1, 1):
            p.tube([(x, s * (w - 0.04), waist), (x + 0.02, s * (t + 0.005), roof_z)], [0.03, 0.03], paint, 5)
    for u, v, s in ((a, d, 1), (b, c, 1), (e, h, 1), (f, g, 1)):
        p.tube([u, v], [0.035, 0.035], paint, 5)
    for x in (-1.25, 1.2):
        for s in (-1, 1):
            wheel(p, x, s * 0.76)
    for s in (-1, 1):
        p.tube([(1.94, s * 0.62, 0.64), (2.03, s * 0.62, 0.63), (2.035, s * 0.62, 0.63)], [0.1, 0.1, 0.001], "Headlight", 12)
        p.box((-2.04, s * 0.62 - 0.12, 0.62), (-1.98, s * 0.62 + 0.12, 0.74), "Taillight")
    return p.mesh(name)


def wheel(p, x, y):
    """Tyre and hub."""
    s = np.sign(y)
    p.tube([(x, y - 0.1 * s, 0.31), (x, y - 0.1 * s, 0.31), (x, y + 0.1 * s, 0.31), (x, y + 0.1 * s, 0.31)][1:3], [0.31, 0.31], "Metal", 18)
    turn = np.arange(18) * 2 * np.pi / 18
    for r, material, out in ((0.31, "Metal", 0.1), (0.19, "Stone", 0.11)):
        ring = [(x + r * np.cos(a), y + out * s, 0.31 + r * np.sin(a)) for a in turn]
        p.face(ring if s < 0 else ring[::-1], material)


def tree(materials, seed=9, leaves=1500):
    """A trunk, branches, and leaves scattered in a few clouds."""
    p, rng = Pile(materials), np.random.default_rng(seed)
    p.tube([(0, 0, 0), (0.02, 0.03, 0.8), (-0.04, 0.05, 1.7), (0.05, 0, 2.6)], [0.17, 0.13, 0.11, 0.08], "Bark", 9)
    clouds = []
    for k in range(9):
        a = k * 2.4
        r = 0.35 + 0.75 * rng.random()
        c = np.array((r * np.cos(a), r * np.sin(a), 2.7 + 1.5 * rng.random()))
        p.tube([(0.02, 0.02, 2.0 + 0.05 * k), tuple(c * (0.6, 0.6, 0.9)), tuple(c)], [0.05, 0.03, 0.01], "Bark", 5)
        clouds.append((c, 0.55 + 0.3 * rng.random()))
    for k in range(leaves):
        c, r = clouds[k % len(clouds)]
        d = rng.normal(size=3)
        d /= np.linalg.norm(d)
        at = c + d * r * rng.random() ** 0.35
        a = np.cross(d + 0.5 * rng.normal(size=3), rng.normal(size=3))
        a *= (0.09 + 0.06 * rng.random()) / np.linalg.norm(a)
        b = np.cross(a, d + 0.4 * rng.normal(size=3))
        b *= 0.6 * np.linalg.norm(a) / np.linalg.norm(b)
        p.face([at - a, at - b, at + a, at + b], "LeafDark" if k % 3 == 0 else "Leaf")
    return p.mesh("Tree")


def bollard(materials):
    """A cast iron bollard."""
    p = Pile(materials)
    p.tube([(0, 0, 0), (0, 0, 0.1), (0, 0, 0.12), (0, 0, 0.72), (0, 0, 0.76), (0, 0, 0.84), (0, 0, 0.9)], [0.11, 0.1, 0.07, 0.055, 0.08, 0.07, 0.001], "Metal", 12)
    return p.mesh("Bollard")
