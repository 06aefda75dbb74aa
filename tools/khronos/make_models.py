"""Small models, one for each feature of glTF's materials: makes tests/models/khronos/*.glb.

usage: python make_models.py [FOLDER]

Each is a scene of its own, named after what it shows. Nothing but Python's standard library is needed, and the same bytes come
out everywhere but for the last digits of the sines.
"""
import json
import math
import os
import struct
import sys
import zlib

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests", "models", "khronos")
MATT = {"KHR_materials_specular": {"specularFactor": 0}}  # no reflection but the diffuse one
NEAREST = {"magFilter": 9728, "minFilter": 9728, "wrapS": 33071, "wrapT": 33071}
F32, U16 = 5126, 5123


def png(rows):
    """An RGBA picture from rows of (r, g, b, a), 0 to 255."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    raw = b"".join(b"\0" + bytes(channel for texel in row for channel in texel) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")


class Model:
    """A glTF file in the making."""

    def __init__(self):
        self.blob = b""
        self.json = {"asset": {"version": "2.0", "generator": "make_models.py"}, "scene": 0, "scenes": [{"nodes": []}]}

    def add(self, kind, entry):
        """Appends to one of the file's lists; its number there."""
        entries = self.json.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def view(self, data):
        self.blob += b"\0" * (-len(self.blob) % 4)
        self.blob += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.blob) - len(data), "byteLength": len(data)})

    def floats(self, kind, rows, bounds=False):
        data = struct.pack(f"<{sum(map(len, rows))}f", *(x for row in rows for x in row))
        entry = {"bufferView": self.view(data), "componentType": F32, "type": kind, "count": len(rows)}
        if bounds:
            stored = list(struct.iter_unpack("<3f", data))
            entry |= {"min": [min(c) for c in zip(*stored)], "max": [max(c) for c in zip(*stored)]}
        return self.add("accessors", entry)

    def texture(self, rows):
        """A texture of hard texels."""
        image = self.add("images", {"bufferView": self.view(png(rows)), "mimeType": "image/png"})
        if "samplers" not in self.json:
            self.add("samplers", NEAREST)
        return {"index": self.add("textures", {"source": image, "sampler": 0})}

    def material(self, name, color=(1, 1, 1), metallic=0, roughness=1, extensions=None, pbr=None, **others):
        """A material; `pbr` and `others` add keys, `extensions` names those that it uses."""
        base = {"baseColorFactor": [*color, *([1] if len(color) == 3 else [])], "metallicFactor": metallic, "roughnessFactor": roughness}
        entry = {"name": name, "pbrMetallicRoughness": base | (pbr or {}), **others}
        if extensions:
            entry["extensions"] = extensions
            used = self.json.setdefault("extensionsUsed", [])
            used += [e for e in extensions if e not in used]
        return self.add("materials", entry)

    def mesh(self, shape):
        """A mesh without a material: what its nodes have in common."""
        positions, normals, uvs, triangles, others = shape
        attributes = {"POSITION": self.floats("VEC3", positions, True), "NORMAL": self.floats("VEC3", normals)}
        if uvs:
            attributes["TEXCOORD_0"] = self.floats("VEC2", uvs)
        for name, (kind, rows) in others.items():
            attributes[name] = self.floats(kind, rows)
        flat = [i for triangle in triangles for i in triangle]
        view = self.view(struct.pack(f"<{len(flat)}H", *flat))
        indices = self.add("accessors", {"bufferView": view, "componentType": U16, "type": "SCALAR", "count": len(flat)})
        return {"attributes": attributes, "indices": indices}

    def node(self, name, mesh, material, at=(0, 0, 0), **others):
        number = self.add("meshes", {"name": name, "primitives": [mesh | {"material": material}]})
        entry = {"name": name, "mesh": number, "translation": list(at), **others}
        self.json["scenes"][0]["nodes"].append(self.add("nodes", entry))

    def bytes(self):
        """As a .glb."""
        blob = self.blob + b"\0" * (-len(self.blob) % 4)
        self.json["buffers"] = [{"byteLength": len(blob)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


# ---------------------------------------------------------------- shapes: positions, normals, texture coordinates, triangles, other attributes

def quad(half=1.0, height=None, **others):
    """A rectangle that faces +z, its picture upright."""
    w, h = half, height or half
    positions = [(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)]
    return positions, [(0, 0, 1)] * 4, [(0, 1), (1, 1), (1, 0), (0, 0)], [(0, 1, 2), (0, 2, 3)], others


def sphere(around=32, down=16):
    """A unit ball with smooth normals, its poles at +y and -y, a corner at each end of the axes."""
    def corner(i, j):
        sin, cos = math.sin(math.pi * j / down), math.cos(math.pi * j / down)
        return tuple(round(x, 12) + 0.0 for x in (sin * math.sin(math.tau * i / around), cos, sin * math.cos(math.tau * i / around)))
    # All the way round the last column is the first; a pole is one corner for each column.
    points = [corner(i, j) for j in range(down + 1) for i in range(around)]
    triangles = []
    for j in range(down):
        for i in range(around):
            a, b = j * around + i, j * around + (i + 1) % around
            c, d = a + around, b + around
            triangles += ([(a, c, d)] if j < down - 1 else []) + ([(a, d, b)] if 0 < j else [])
    return points, points, None, triangles, {}


def prism(apex=math.pi / 3, side=2.0, length=4.0):
    """A prism along z with its edge up, its flat sides each with corners of their own."""
    half, height = side * math.sin(apex / 2), side * math.cos(apex / 2)
    a, b, c = (0, height / 2), (-half, -height / 2), (half, -height / 2)
    positions, normals, triangles = [], [], []
    def face(corners, normal):
        start = len(positions)
        positions.extend(corners)
        normals.extend([normal] * len(corners))
        triangles.extend((start, start + i, start + i + 1) for i in range(1, len(corners) - 1))
    z = length / 2
    for p, q in ((a, b), (b, c), (c, a)):
        dx, dy = q[0] - p[0], q[1] - p[1]
        long = math.hypot(dx, dy)
        face([(*p, z), (*p, -z), (*q, -z), (*q, z)], (dy / long, -dx / long, 0))
    face([(*a, z), (*b, z), (*c, z)], (0, 0, 1))
    face([(*a, -z), (*c, -z), (*b, -z)], (0, 0, -1))
    return positions, normals, None, triangles, {}


# ---------------------------------------------------------------- the models

def metal_rough():
    """A row of metal balls from smooth to rough; above, a square half of metal, by its texture."""
    m = Model()
    ball = m.mesh(sphere(48, 24))
    for i, roughness in enumerate((0.2, 0.4, 0.6, 0.8, 1.0)):
        material = m.material(f"Metal{i}", (0.9, 0.5, 0.2), metallic=1, roughness=roughness)
        m.node(f"Ball{i}", ball, material, (2.5 * i - 5, 0, 0))
    # Roughness in green, metalness in blue; what red says is for others.
    texture = m.texture([[(255, 128, 255, 255), (0, 204, 0, 255)]])
    material = m.material("Textured", (0.9, 0.5, 0.2), 1, 1, pbr={"metallicRoughnessTexture": texture})
    m.node("Textured", m.mesh(quad()), material, (0, 3, 0))
    return m


def normal_map(tangents):
    """Two squares, one of them a mirror image; their texels lean to the right and up. With tangents, which lie along y: up and to the left."""
    m = Model()
    texture = m.texture([[(204, 128, 230, 255), (128, 204, 230, 255)]])
    material = m.material("Leaning", (0.8, 0.8, 0.8), extensions=MATT, normalTexture=texture | {"scale": 1})
    shape = quad(TANGENT=("VEC4", [(0, 1, 0, 1)] * 4)) if tangents else quad()
    mesh = m.mesh(shape)
    m.node("Plain", mesh, material, (-1.5, 0, 0))
    m.node("Mirrored", mesh, material, (1.5, 0, 0), scale=[-1, 1, 1])
    return m


def emissive_strength():
    """A square that shines by a picture, forty times as bright as a factor can say."""
    m = Model()
    texture = m.texture([[(255, 255, 255, 255), (188, 99, 0, 255)]])
    strength = {"KHR_materials_emissive_strength": {"emissiveStrength": 40}}
    m.node("Panel", m.mesh(quad()), m.material("Glow", (0, 0, 0), extensions=strength | MATT, emissiveFactor=[1, 0.5, 0.25], emissiveTexture=texture))
    return m


def wall(m, z=-2, half=4.0, name="Wall", color=(0.8, 0.8, 0.8), extensions=None):
    m.node(name, m.mesh(quad(half)), m.material(name, color, extensions=extensions or MATT, doubleSided=True), (0, 0, z))


def alpha_mask():
    """A checkered square with holes before a wall. Its alphas are neither 0 nor 1."""
    m = Model()
    there, hole = (255, 255, 255, 150), (255, 255, 255, 100)
    texture = m.texture([[there if (i + j) % 2 == 0 else hole for i in range(4)] for j in range(4)])
    m.node("Lattice", m.mesh(quad()), m.material("Lattice", (0.6, 0.3, 0.1), extensions=MATT, doubleSided=True, alphaMode="MASK", alphaCutoff=0.5, pbr={"baseColorTexture": texture}))
    wall(m)
    return m


def alpha_blend():
    """A square a quarter of which is there, before a wall."""
    m = Model()
    m.node("Gauze", m.mesh(quad()), m.material("Gauze", (0.8, 0.4, 0.2, 0.25), extensions=MATT, doubleSided=True, alphaMode="BLEND"))
    wall(m)
    return m


def sides():
    """A square that has no back, one that has, and a wall that faces their backs."""
    m = Model()
    square = m.mesh(quad())
    m.node("Single", square, m.material("Single", (0.8, 0.2, 0.2), extensions=MATT), (-1.5, 0, 0))
    m.node("Double", square, m.material("Double", (0.2, 0.8, 0.2), extensions=MATT, doubleSided=True), (1.5, 0, 0))
    wall(m, z=2, name="Wall", extensions={"KHR_materials_unlit": {}})
    return m


def balls(kinds):
    """A row of balls 2.5 m apart, each with a material: its name, and what it is."""
    m = Model()
    ball = m.mesh(sphere())
    for i, (name, what) in enumerate(kinds):
        m.node(name, ball, m.material(name, **what), (2.5 * i, 0, 0))
    return m


def ior():
    """Black balls with a gloss, of several indices."""
    kinds = [(f"Ior{n}", {"color": (0, 0, 0), "roughness": 0.5, "extensions": {"KHR_materials_ior": {"ior": n}}}) for n in (1.0, 1.33, 1.5, 2.4)]
    return balls(kinds)


def specular():
    """Black balls whose gloss is weaker, coloured, or both."""
    say = lambda **what: {"color": (0, 0, 0), "roughness": 0.5, "extensions": {"KHR_materials_specular": what}}
    color = [1, 0.3, 0.1]
    return balls([("Half", say(specularFactor=0.5)), ("Tinted", say(specularColorFactor=color)), ("Both", say(specularFactor=0.5, specularColorFactor=color))])


def clearcoat():
    """A red ball without and with a coat."""
    coat = {"KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.4}}
    return balls([("Bare", {"color": (0.7, 0.1, 0.05), "extensions": MATT}), ("Coated", {"color": (0.7, 0.1, 0.05), "extensions": MATT | coat})])


def unlit():
    """A square that shows its colour in any light and in none."""
    m = Model()
    m.node("Sign", m.mesh(quad()), m.material("Sign", (0.5, 0.25, 1), extensions={"KHR_materials_unlit": {}}, doubleSided=True))
    return m


def clear(color=(1, 1, 1), **others):
    return {"color": color, "roughness": 0, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, **others}}


def transmission():
    """A green pane before a wall, white on the left and grey on the right."""
    m = Model()
    m.node("Pane", m.mesh(quad()), m.material("Pane", **clear((0.4, 0.9, 0.6)), doubleSided=True))
    half = m.mesh(quad(2, 4))
    for name, x, grey in (("Left", -2, 1), ("Right", 2, 0.2)):
        m.node(name, half, m.material(name, (grey,) * 3, extensions={"KHR_materials_unlit": {}}), (x, 0, -2))
    return m


def volume():
    """A ball of amber before a white wall."""
    m = Model()
    amber = {"thicknessFactor": 2, "attenuationDistance": 1.5, "attenuationColor": [0.9, 0.5, 0.2]}
    m.node("Ball", m.mesh(sphere(64, 32)), m.material("Amber", **clear(KHR_materials_volume=amber, KHR_materials_ior={"ior": 1.5})))
    m.node("Wall", m.mesh(quad(20)), m.material("Wall", extensions={"KHR_materials_unlit": {}}), (0, 0, -3))
    return m


def dispersion():
    """A prism, and a screen that is the brighter the lower."""
    m = Model()
    glass = clear(KHR_materials_volume={"thicknessFactor": 1}, KHR_materials_ior={"ior": 1.5168}, KHR_materials_dispersion={"dispersion": 2})
    m.node("Prism", m.mesh(prism()), m.material("Flint", **glass))
    ramp = [(c, c, c, 1.0) for c in (1.0, 1.0, 0.0, 0.0)]
    m.node("Screen", m.mesh(quad(10, COLOR_0=("VEC4", ramp))), m.material("Screen", extensions={"KHR_materials_unlit": {}}, doubleSided=True), (10, 0, 0), rotation=[0, -math.sqrt(0.5), 0, math.sqrt(0.5)])
    return m


MODELS = {
    "metal_rough": metal_rough(),
    "normal_map": normal_map(False),
    "normal_map_tangents": normal_map(True),
    "emissive_strength": emissive_strength(),
    "alpha_mask": alpha_mask(),
    "alpha_blend": alpha_blend(),
    "sides": sides(),
    "ior": ior(),
    "specular": specular(),
    "clearcoat": clearcoat(),
    "unlit": unlit(),
    "transmission": transmission(),
    "volume": volume(),
    "dispersion": dispersion(),
}


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else FOLDER
    os.makedirs(folder, exist_ok=True)
    for name, model in MODELS.items():
        with open(os.path.join(folder, f"{name}.glb"), "wb") as file:
            file.write(model.bytes())


if __name__ == "__main__":
    main()
