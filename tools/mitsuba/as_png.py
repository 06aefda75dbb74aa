#!/usr/bin/env python3
"""Writes copies of .glb files in which JPEG textures have become PNG: usage: as_png.py OUT_FOLDER FILE.glb ...

Decoders of JPEG differ in how they enlarge the half-size colour planes, by some per cent at edges in paint. With
PNG both renderers see the same texels."""
import io
import json
import os
import struct
import sys

from PIL import Image

JSON, BIN = 0x4E4F534A, 0x004E4942


def chunk(data, kind, fill):
    data += fill * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data


for path in sys.argv[2:]:
    data = open(path, "rb").read()
    length = struct.unpack("<I", data[12:16])[0]
    root, binary = json.loads(data[20:20 + length]), data[20 + length + 8:]
    views = root["bufferViews"]
    parts = [binary[v.get("byteOffset", 0):][:v["byteLength"]] for v in views]
    for image in root.get("images", []):
        png = io.BytesIO()
        Image.open(io.BytesIO(parts[image["bufferView"]])).convert("RGB").save(png, "PNG")
        parts[image["bufferView"]], image["mimeType"] = png.getvalue(), "image/png"
    binary = b""
    for view, part in zip(views, parts):
        binary += b"\0" * (-len(binary) % 4)
        view["byteOffset"], view["byteLength"] = len(binary), len(part)
        binary += part
    root["buffers"][0]["byteLength"] = len(binary) + -len(binary) % 4
    body = chunk(json.dumps(root).encode(), JSON, b" ") + chunk(binary, BIN, b"\0")
    with open(os.path.join(sys.argv[1], os.path.basename(path)), "wb") as out:
        out.write(struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body)
