"""Meshes and materials of a .glb, for compare.py (diffuse ones as Blender writes them) and materials.py.

Written apart from terrell's importer, so that a fault in either shows. Refuses what it does not know: Draco, sparse accessors, skins, non-diffuse materials.
"""
import io
import json
import struct

import numpy as np

TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Primitive:
    """Triangles of one material in one node's axes, with the matrix that brings them to the file's."""

    def __init__(self, matrix, points, normals, uv, triangles, material):
        self.matrix, self.points, self.normals, self.uv, self.triangles, self.material = matrix, points, normals, uv, triangles, material


class Material:
    """Diffuse reflectance: a linear colour, or a picture's bytes (sRGB)."""

    def __init__(self, name, color, picture):
        self.name, self.color, self.picture = name, color, picture


class File:
    """A .glb, opened."""

    def __init__(self, path):
        data = open(path, "rb").read()
        if data[:4] != b"glTF":
            raise SystemExit(f"{path}: not a .glb")
        length = struct.unpack("<I", data[12:16])[0]
        self.path, self.json, self.blob = path, json.loads(data[20 : 20 + length]), data[20 + length + 8 :]

    def primitives(self, node=None):
        """All triangles of the default scene, or only those of the node of this name and its children."""
        found = []
        scene = self.json["scenes"][self.json.get("scene", 0)]
        for root in scene["nodes"]:
            self._walk(root, np.eye(4), node, node is None, found)
        if not found:
            raise SystemExit(f"{self.path}: no triangles" + (f" in node {node}" if node else ""))
        return found

    def _walk(self, index, above, wanted, inside, found):
        node = self.json["nodes"][index]
        inside = inside or node.get("name") == wanted
        matrix = above @ local_matrix(node)
        if inside and "mesh" in node:
            found += [self._primitive(p, matrix) for p in self.json["meshes"][node["mesh"]]["primitives"]]
        for child in node.get("children", []):
            self._walk(child, matrix, wanted, inside, found)

    def _primitive(self, p, matrix):
        at = p["attributes"]
        points = self._accessor(at["POSITION"])
        triangles = self._accessor(p["indices"]).reshape(-1, 3) if "indices" in p else np.arange(len(points)).reshape(-1, 3)
        optional = lambda name: self._accessor(at[name]) if name in at else None
        return Primitive(matrix, points, optional("NORMAL"), optional("TEXCOORD_0"), triangles, self._material(p["material"]))

    def _accessor(self, index):
        a = self.json["accessors"][index]
        if "bufferView" not in a or "sparse" in a:
            raise SystemExit(f"{self.path}: accessor {index} is sparse or compressed")
        view = self.json["bufferViews"][a["bufferView"]]
        kind, width = np.dtype(TYPES[a["componentType"]]), WIDTHS[a["type"]]
        start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        step = view.get("byteStride", width * kind.itemsize)
        return np.ndarray((a["count"], width), kind, self.blob, start, (step, kind.itemsize)).copy()

    def _material(self, index):
        m = self.json["materials"][index]
        pbr = m.get("pbrMetallicRoughness", {})
        if pbr.get("metallicFactor", 1) != 0 or pbr.get("roughnessFactor", 1) != 1:
            raise SystemExit(f"{self.path}: material {m.get('name')} is not diffuse")
        picture = None
        if "baseColorTexture" in pbr:
            image = self.json["images"][self.json["textures"][pbr["baseColorTexture"]["index"]]["source"]]
            view = self.json["bufferViews"][image["bufferView"]]
            start = view.get("byteOffset", 0)
            picture = self.blob[start : start + view["byteLength"]]
        return Material(m.get("name", f"material {index}"), np.array(pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]), picture)


class Glb(File):
    """A .glb whose materials are handed on as they are written."""

    def _material(self, index):
        return self.json["materials"][index]

    def texels(self, info):
        """A texture's RGBA, 0 to 255, rows from the top."""
        from PIL import Image
        image = self.json["images"][self.json["textures"][info["index"]]["source"]]
        view = self.json["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        return np.array(Image.open(io.BytesIO(self.blob[start : start + view["byteLength"]])).convert("RGBA"))


def local_matrix(node):
    """A node's own 4 x 4 matrix."""
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    m = np.eye(4)
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    m[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    m[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), float)
    m[:3, 3] = node.get("translation", (0, 0, 0))
    return m
