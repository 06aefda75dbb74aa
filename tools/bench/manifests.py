"""The benchmark's scenes as terrell's manifests, at rest and in motion.

  rest      as the model has it, each of its nodes a body; the lamps and the observer at rest in the lab
  white     the same with both lamps white: three wavelengths suffice
  still     the same by one observer: one picture serves for all, so what it takes is developing and writing
  together  everything at 0.9 c with one velocity, the observer and the lamps too: the picture is that of rest
  apart     every body at 0.9 c its own way, each up to 25 degrees off, the observer and the lamps at 0.9 c another: bodies appear where they do at rest

Exposures are by a ring of observers, all at rest in the observer's frame and a tenth of a millimetre from its middle: each is traced anew, and none costs more than another.
"""
import math
import os

import numpy as np
import yaml

from model import DEPTH, INDEX, MIRROR, Model

KINDS = ("rest", "white", "still", "together", "apart")
SPEED = 0.9
COUNT = 1000  # exposures; as many are rendered as are asked for
MATERIALS = {"Mirror": {"mirror": MIRROR}, "Glass": {"glass": INDEX}}


def along(degrees):
    """0.9 c in the horizontal, so many degrees from +x towards -z."""
    return SPEED * np.array([math.cos(math.radians(degrees)), 0, -math.sin(math.radians(degrees))])


def lab_event(velocity, t, x):
    """Time and place in the lab of what a frame that moves so, its axes the boosted ones of the lab's, has at t and x."""
    velocity, x = np.asarray(velocity, float), np.asarray(x, float)
    speed2 = velocity @ velocity
    if speed2 == 0:
        return t, x
    gamma = 1 / math.sqrt(1 - speed2)
    forward = velocity @ x
    return gamma * (t + forward), x + velocity * ((gamma - 1) * forward / speed2 + gamma * t)


def three(values):
    return " ".join(repr(float(v)) for v in values)


def placement(velocity, origin):
    """The keys that place a body's origin at an event (time, place)."""
    keys = {"at": f"{three(origin[1])} m", "at_time": f"{float(origin[0])!r} s"}
    return keys if not np.any(velocity) else {**keys, "velocity": f"{three(velocity)} c"}


def body_velocity(number, name):
    """The velocity of a body by its number: floor and wall stay in their planes, the others fan out."""
    if name in ("Floor", "Wall"):
        return along(0)
    return along(50 * ((number * 0.6180339887498949) % 1) - 25)


def bodies(model, kind, observer):
    """The bodies and their assets."""
    assets, made = {}, []
    eye = model.camera()[0][:3, 3]
    names = [name for name, _, _ in model.materials()]
    for number, (node, matrix) in enumerate(model.nodes("mesh")):
        name = node["name"]
        assets[name] = {"file": os.path.basename(model.path), "node": name}
        velocity, origin = observer, (0.0, np.zeros(3))
        if kind == "apart":
            velocity, at = body_velocity(number, name), matrix[:3, 3]
            # The light that the observer sees at time 0 left this event; where the node stands in the body's frame, that is where it was.
            left = lab_event(observer, -np.linalg.norm(at - eye), at)
            offset = lab_event(velocity, 0.0, at)
            origin = left[0] - offset[0], left[1] - offset[1]
        body = {"asset": name, **placement(velocity, origin)}
        used = names[next(model.mesh(node["mesh"]))[-1]]
        made.append({**body, "material": MATERIALS[used]} if used in MATERIALS else body)
    return assets, made


def manifest(model, kind, size=(1280, 720), samples=1):
    """A scene as the text of a manifest."""
    observer = along(0 if kind == "together" else 12) if kind in ("together", "apart") else np.zeros(3)
    assets, made = bodies(model, kind, observer)
    lamps = [
        {"lamp": {"intensity": f"{cd!r} cd", **({} if color == [1, 1, 1] else {"spectrum": {"rgb": three(color)}})}, **placement(observer, lab_event(observer, 0.0, at))}
        for at, cd, color in model.lamps(white=kind == "white")
    ]
    matrix, across, _ = model.camera()
    eye = f"{three(matrix[:3, 3])} m"
    place = {"at": eye} if kind == "still" else {**placement(observer, (0.0, np.zeros(3))), "ring": {"centre": eye, "radius": "0.0001 m"}}
    written = {
        "light_speed": "1 m/s",
        "assets": assets,
        "bodies": made,
        "lights": lamps,
        "observer": {
            **place,
            "direction": three(-matrix[:3, 2]),
            "up": three(matrix[:3, 1]),
            "field_of_view": f"{math.degrees(across)!r} deg",
        },
        "exposures": {"from": "0 s", "to": "1 s", "count": COUNT} if kind == "still" else {"at": "0 s", "count": COUNT},
        "picture": {"size": f"{size[0]} {size[1]}", "samples": samples, "filter": "box", "depth": DEPTH, "white": f"{model.white():.6g} cd/m2"},
        "film": {"rate": 24, "video": "off"},
        "output": {"folder": f"out/{os.path.basename(model.path)[:-4]}-{kind}", "exr": "off"},
    }
    return yaml.safe_dump(written, sort_keys=False, width=200)


def write_all(folder, name, **picture):
    """Writes the manifests of one model beside it; their paths by kind."""
    model = Model(os.path.join(folder, name + ".glb"))
    paths = {kind: os.path.join(folder, f"{name}-{kind}.yaml") for kind in KINDS}
    for kind, path in paths.items():
        with open(path, "w") as file:
            file.write(manifest(model, kind, **picture))
    return paths
