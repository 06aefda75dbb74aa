#!/usr/bin/env python3
"""A model of the benchmark in POV-Ray 3.7: in_povray.py MODEL.glb [--size 1280x720] [--threads 2] [--save PICTURE.png]

Serves bench.py (see serve.py); needs `povray`. POV-Ray asks every lamp at every hit and follows both ways at faces of glass, as terrell does, one sample to a pixel.
Each picture is a process; what counts is the time that it says it traced.
"""
import argparse
import math
import os
import re
import subprocess
import sys
import tempfile
import time

import numpy as np

from model import DEPTH, INDEX, MIRROR, Model
from serve import serve

SHARP = {
    "Mirror": f"texture {{ pigment {{ rgb 0 }} finish {{ ambient 0 diffuse 0 reflection {{ rgb {MIRROR} }} }} }}",
    "Glass": "texture { pigment { rgbf 1 } finish { ambient 0 diffuse 0 reflection { 0 1 fresnel on } conserve_energy } } "
    f"interior {{ ior {INDEX} }}",
}


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("model")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--save")
    return parser.parse_args()


def vector(values):
    return "<" + ",".join(f"{v:.8g}" for v in values) + ">"


def rows(values, form):
    return f"{len(values)},\n" + ",\n".join(form % tuple(row) for row in values.tolist())


def paint(number, name, color, png, folder):
    if name in SHARP:
        return SHARP[name]
    pigment = f"rgb {vector(color)}"
    if png:
        with open(os.path.join(folder, f"{number}.png"), "wb") as file:
            file.write(png)
        pigment = f'image_map {{ png "{number}.png" interpolate 2 }}'
    return f"texture {{ uv_mapping pigment {{ {pigment} }} finish {{ ambient 0 diffuse 1 }} }}"


def write(model, folder, size):
    """The scene as POV-Ray reads it: meshes once, objects as often as they are placed."""
    paints = [paint(number, *material, folder) for number, material in enumerate(model.materials())]
    with open(os.path.join(folder, "scene.pov"), "w") as file:
        file.write(f"#version 3.7;\nglobal_settings {{ assumed_gamma 1 max_trace_level {DEPTH + 1} }}\nbackground {{ rgb 0 }}\n")
        parts = {}
        for node, matrix in model.nodes("mesh"):
            index = node["mesh"]
            if index not in parts:
                parts[index] = 0
                for points, normals, uv, triangles, material in model.mesh(index):
                    uv = uv * (1, -1) + (0, 1)
                    file.write(
                        f"#declare M{index}_{parts[index]} = mesh2 {{\nvertex_vectors {{ {rows(points, '<%.7g,%.7g,%.7g>')} }}\n"
                        f"normal_vectors {{ {rows(normals, '<%.5g,%.5g,%.5g>')} }}\nuv_vectors {{ {rows(uv, '<%.6g,%.6g>')} }}\n"
                        f"face_indices {{ {rows(triangles, '<%d,%d,%d>')} }}\n{paints[material]} }}\n"
                    )
                    parts[index] += 1
            placed = ",".join(f"{v:.9g}" for v in matrix[:3].T.ravel())
            for part in range(parts[index]):
                file.write(f"object {{ M{index}_{part} matrix <{placed}> }}\n")
        for at, cd, color in model.lamps():
            # It fades as 2 / (1 + (r/d)²): with d = 0.01 that is 2e-4 / r².
            strength = vector(np.array(color) * cd / math.pi / model.white() / 2e-4)
            file.write(f"light_source {{ {vector(at)} rgb {strength} fade_distance 0.01 fade_power 2 }}\n")
        matrix, across, _ = model.camera()
        wide = 2 * math.tan(across / 2)
        right, up = matrix[:3, 0] * wide, matrix[:3, 1] * wide * size[1] / size[0]
        file.write(f"camera {{ location {vector(matrix[:3, 3])} direction {vector(-matrix[:3, 2])} up {vector(up)} right {vector(right)} }}\n")


def render(folder, size, threads):
    """A picture; the seconds that POV-Ray says it took, by what it did."""
    command = ["povray", "+Iscene.pov", "+Oscene.png", "+FN", "-D", "-A", f"+W{size[0]}", f"+H{size[1]}", f"+WT{threads}"]
    said = subprocess.run(command, cwd=folder, capture_output=True, text=True).stderr
    took = dict(re.findall(r"(\w+) Time:\s+.*?\((\d+\.\d+) seconds\)", said))
    spent = dict(re.findall(r"(\w+) Time:.*?\n\s+using \d+ thread\(s\) with (\d+\.\d+) CPU-seconds", said))
    if "Trace" not in took:
        sys.exit(said[-1500:])
    return {key: float(value) for key, value in took.items()}, float(spent.get("Trace", "nan"))


def main():
    a = arguments()
    size = tuple(int(side) for side in a.size.split("x"))
    model = Model(a.model)
    with tempfile.TemporaryDirectory() as folder:
        began = time.perf_counter()
        write(model, folder, size)
        written = time.perf_counter() - began
        took, _ = render(folder, size, a.threads)
        if a.save:
            os.replace(os.path.join(folder, "scene.png"), a.save)
        facts = {"libraries": written, "build": took.get("Parse", 0) + took.get("Bounding", 0), "first": took["Trace"]}

        def make(_):
            took, processor = render(folder, size, a.threads)
            return {"seconds": took["Trace"], "processor": processor}

        serve(facts, make)


if __name__ == "__main__":
    main()
