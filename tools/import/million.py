#!/usr/bin/env python3
"""Writes a wavy sheet of a million triangles, to time the import: million.py FOLDER, then
`time terrell inspect FOLDER/million.glb` and `time terrell inspect FOLDER/million.obj`. Needs numpy."""
import json
import struct
import sys

import numpy as np


def sheet(squares):
    """Places, texture coordinates and triangles of a sheet of 10 m, so many squares along each side."""
    n = squares + 1
    u, v = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    place = np.stack([10 * u, np.sin(20 * u) * np.cos(17 * v), 10 * v], -1).reshape(-1, 3).astype("<f4")
    uv = np.stack([u, v], -1).reshape(-1, 2).astype("<f4")
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + n, i + 1], -1), np.stack([i + 1, i + n, i + n + 1], -1)]).astype("<u4")
    return place, uv, faces


def write_glb(path, place, uv, faces):
    parts = [place.tobytes(), uv.tobytes(), faces.tobytes()]
    offsets = np.cumsum([0] + [len(p) for p in parts]).tolist()
    root = {
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
        "buffers": [{"byteLength": offsets[-1]}],
        "bufferViews": [{"buffer": 0, "byteOffset": o, "byteLength": len(p)} for o, p in zip(offsets, parts)],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(place), "type": "VEC3",
             "min": place.min(0).tolist(), "max": place.max(0).tolist()},
            {"bufferView": 1, "componentType": 5126, "count": len(uv), "type": "VEC2"},
            {"bufferView": 2, "componentType": 5125, "count": faces.size, "type": "SCALAR"}],
    }
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", offsets[-1], 0x004E4942) + b"".join(parts)
    with open(path, "wb") as out:
        out.write(struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body)


def write_obj(path, place, uv, faces):
    with open(path, "w") as out:
        np.savetxt(out, place, "v %.6f %.6f %.6f")
        np.savetxt(out, uv, "vt %.6f %.6f")
        np.savetxt(out, np.repeat(faces + 1, 2, 1), "f %d/%d %d/%d %d/%d")


if __name__ == "__main__":
    made = sheet(708)  # 1,002,528 triangles
    write_glb(f"{sys.argv[1]}/million.glb", *made)
    write_obj(f"{sys.argv[1]}/million.obj", *made)
