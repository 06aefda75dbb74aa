"""What a model of the benchmark says, for those who build its scene in another program: nodes, meshes, lamps, camera.

The materials called Mirror and Glass are a mirror of 0.9 and glass of index 1.5 in every program; all others are diffuse.
"""
import math
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "mitsuba"))
from gltf_meshes import Glb, local_matrix  # noqa: E402

MIRROR, INDEX, DEPTH = 0.9, 1.5, 5


class Model(Glb):
    """A .glb as scenes.py writes it."""

    def nodes(self, key):
        """The nodes that have this key, with their matrices; those of these files have no children."""
        return [(node, local_matrix(node)) for node in self.json["nodes"] if key in node]

    def mesh(self, index):
        """The mesh's parts, one for each material: points, normals, texture coordinates, triangles, the number of the material."""
        for part in self.json["meshes"][index]["primitives"]:
            read = lambda name: self._accessor(part["attributes"][name])
            triangles = self._accessor(part["indices"]).reshape(-1, 3)
            yield read("POSITION"), read("NORMAL"), read("TEXCOORD_0"), triangles, part["material"]

    def materials(self):
        """Name, colour, and the picture's PNG bytes or none, of each material."""
        for material in self.json["materials"]:
            pbr = material["pbrMetallicRoughness"]
            picture = pbr.get("baseColorTexture")
            yield material["name"], pbr.get("baseColorFactor", [1, 1, 1, 1])[:3], picture and self.png(picture)

    def png(self, texture):
        """The bytes of a texture's file."""
        image = self.json["images"][self.json["textures"][texture["index"]]["source"]]
        view = self.json["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        return self.blob[start : start + view["byteLength"]]

    def lamps(self, white=False):
        """Place, strength (cd to each side) and colour of each lamp; all of them white if asked for."""
        lights = self.json["extensions"]["KHR_lights_punctual"]["lights"]
        for node, matrix in self.nodes("extensions"):
            light = lights[node["extensions"]["KHR_lights_punctual"]["light"]]
            yield matrix[:3, 3], light["intensity"], [1, 1, 1] if white else light.get("color", [1, 1, 1])

    def camera(self):
        """Its matrix (it looks along -z), and its angles across and down, radians, at a width to height of `aspect`."""
        node, matrix = self.nodes("camera")[0]
        lens = self.json["cameras"][node["camera"]]["perspective"]
        across = 2 * math.atan(math.tan(lens["yfov"] / 2) * lens["aspectRatio"])
        return matrix, across, lens["yfov"]

    def white(self):
        """A luminance to be shown as white, cd/m2: that of something white, lit by all lamps, some way before the camera."""
        eye = self.camera()[0][:3, 3]
        before = eye + self.camera()[0][:3, :3] @ (0, 0, -np.linalg.norm(eye))
        return sum(cd / (math.pi * np.sum((at - before) ** 2)) for at, cd, _ in self.lamps())
