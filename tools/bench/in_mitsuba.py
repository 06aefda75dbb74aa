#!/usr/bin/env python3
"""A model of the benchmark in Mitsuba 3: in_mitsuba.py MODEL.glb [--variant llvm_ad_rgb] [--size 1280x720] [--samples 1] [--threads 2] [--white] [--pick] [--save PICTURE.npy]

Serves bench.py: says when the first picture is there, and then makes one for each line that it reads (see serve.py).
Mitsuba's own `direct` picks one of two lamps at random (and with two samples of them makes points twice as bright), and its `path` one of a face's two ways. Here every
hit asks every lamp, with a shadow ray each, and both ways of a face of glass are followed (--pick: one of them, at random), all by Mitsuba's own kernels.
"""
import argparse
import math
import sys
import tempfile
import time

from serve import serve

start = time.perf_counter()
import drjit as dr  # noqa: E402
import mitsuba as mi  # noqa: E402
import numpy as np  # noqa: E402

from model import DEPTH, INDEX, MIRROR, Model  # noqa: E402

FAINTEST = 0.001  # what carries less is not followed, as in terrell


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("model")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--samples", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--white", action="store_true")
    parser.add_argument("--pick", action="store_true")
    parser.add_argument("--save")
    return parser.parse_args()


# ---------------------------------------------------------------- the scene

def mesh(points, normals, uv, triangles, bsdf):
    properties = mi.Properties()
    properties["bsdf"] = bsdf
    made = mi.Mesh("mesh", len(points), len(triangles), properties, True, True)
    params = mi.traverse(made)
    params["vertex_positions"] = np.ascontiguousarray(points, np.float32).ravel()
    params["vertex_normals"] = np.ascontiguousarray(normals, np.float32).ravel()
    params["vertex_texcoords"] = np.ascontiguousarray(uv, np.float32).ravel()
    params["faces"] = np.ascontiguousarray(triangles, np.uint32).ravel()
    params.update()
    return made


def surface(name, color, png):
    if name == "Mirror":
        return mi.load_dict({"type": "conductor", "material": "none", "specular_reflectance": {"type": "rgb", "value": MIRROR}})
    if name == "Glass":
        return mi.load_dict({"type": "dielectric", "int_ior": INDEX, "ext_ior": 1.0})
    reflectance = {"type": "rgb", "value": list(color)}
    if png:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            file.write(png)
            file.flush()
            reflectance = {"type": "bitmap", "bitmap": mi.Bitmap(file.name), "filter_type": "bilinear"}
    return mi.load_dict({"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": reflectance}})


def scene_of(model, white):
    """The scene; what is placed more than once is instanced."""
    surfaces = [surface(*material) for material in model.materials()]
    placed = model.nodes("mesh")
    scene = {"type": "scene"}
    for number, (node, matrix) in enumerate(placed):
        index = node["mesh"]
        often = sum(other["mesh"] == index for other, _ in placed) > 1
        if often:
            group = f"group{index}"
            if group not in scene:
                parts = [mesh(p, n, uv, t, surfaces[m]) for p, n, uv, t, m in model.mesh(index)]
                scene[group] = {"type": "shapegroup", **{f"part{k}": part for k, part in enumerate(parts)}}
            scene[f"instance{number}"] = {"type": "instance", "to_world": mi.ScalarTransform4f(matrix), "group": {"type": "ref", "id": group}}
            continue
        for k, (points, normals, uv, triangles, material) in enumerate(model.mesh(index)):
            points = points @ matrix[:3, :3].T + matrix[:3, 3]
            normals = normals @ np.linalg.inv(matrix[:3, :3])
            scene[f"mesh{number}_{k}"] = mesh(points, normals / np.linalg.norm(normals, axis=1, keepdims=True), uv, triangles, surfaces[material])
    for number, (at, cd, color) in enumerate(model.lamps(white)):
        scene[f"lamp{number}"] = {"type": "point", "position": at.tolist(), "intensity": {"type": "rgb", "value": [cd * c for c in color]}}
    return mi.load_dict(scene)


# ---------------------------------------------------------------- the picture

class Camera:
    """Rays through one place of each pixel."""

    def __init__(self, model, size):
        self.width, self.height = size
        matrix, across, _ = model.camera()
        self.eye, self.axes, self.reach = matrix[:3, 3], matrix[:3, :3], math.tan(across / 2)

    def rays(self, dx, dy):
        # Opaque, or Mitsuba would compile its kernels anew for other numbers.
        dx, dy = dr.opaque(mi.Float, dx), dr.opaque(mi.Float, dy)
        index = dr.arange(mi.UInt32, self.width * self.height)
        x, y = mi.Float(index % self.width), mi.Float(index // self.width)
        right = self.reach * (2 * (x + dx) / self.width - 1)
        up = self.reach * (self.height - 2 * (y + dy)) / self.width
        column = lambda i: mi.Vector3f(*[float(c) for c in self.axes[:, i]])
        return index, mi.Ray3f(mi.Point3f(*[float(c) for c in self.eye]), dr.normalize(column(0) * right + column(1) * up - column(2)))


@dr.syntax
def through_glass(scene, si, place, active):
    """What part of a lamp's light comes straight on to a hit, less what faces of glass on the way reflect: as in terrell."""
    part, ray = dr.select(active, mi.Float(1), mi.Float(0)), si.spawn_ray_to(place)
    while active:
        hit = scene.ray_intersect(ray, active)
        active = active & hit.is_valid()
        clear = active & mi.has_flag(hit.bsdf().flags(), mi.BSDFFlags.DeltaTransmission)
        reflected = mi.fresnel(dr.abs(dr.dot(hit.n, ray.d)), INDEX)[0]
        part = dr.select(active, dr.select(clear, part * (1 - reflected), 0), part)
        active = active & clear
        ray = hit.spawn_ray_to(place)
    return part


def lit(scene, emitters, si, active, glass=False):
    """What diffuse surfaces send back of every lamp's light."""
    context, light = mi.BSDFContext(), mi.Color3f(0)
    bsdf = si.bsdf()
    active = active & si.is_valid() & mi.has_flag(bsdf.flags(), mi.BSDFFlags.DiffuseReflection)
    for emitter in emitters:
        sample, strength = emitter.sample_direction(si, mi.Point2f(0.5), active)
        towards = si.to_local(sample.d)
        facing = active & (towards.z * si.wi.z > 0)
        if glass:
            seen = through_glass(scene, si, sample.p, facing)
        else:
            seen = dr.select(facing & ~scene.ray_test(si.spawn_ray_to(sample.p), facing), mi.Float(1), 0)
        light += seen * strength * bsdf.eval(context, si, towards, facing)
    return light


def goes_on(si, lobe, number=0.5, active=True):
    """The ray that a mirror (lobe 0) or glass (0 or 1; -1 for one of them by the number) sends on, and what part of the light."""
    context = mi.BSDFContext()
    context.component = lobe & 0xFFFFFFFF
    sample, weight = si.bsdf().sample(context, si, mi.Float(number), mi.Point2f(0.5), active)
    return si.spawn_ray(si.to_world(sample.wo)), weight


def both_ways(scene, emitters, index, ray, light):
    """Level by level: all rays of one are traced before those that they send on."""
    part = mi.Color3f(1)
    for level in range(DEPTH + 1):
        si = scene.ray_intersect(ray)
        shining = part * lit(scene, emitters, si, mi.Bool(True), glass=True)
        for channel in range(3):
            dr.scatter_add(light[channel], shining[channel], index)
        if level == DEPTH:
            return
        sharp = si.is_valid() & mi.has_flag(si.bsdf().flags(), mi.BSDFFlags.Delta)
        onward = []
        for lobe in (0, 1):
            after, weight = goes_on(si, lobe, active=sharp)
            weight = part * weight
            kept = sharp & (dr.max(weight) > FAINTEST)
            dr.eval(after.o, after.d, weight, kept)
            which = dr.compress(kept)
            onward.append([dr.gather(type(a), a, which) for a in (after.o, after.d, weight, index)])
        join = lambda a, b: type(a)(*[dr.concat((a[k], b[k])) for k in range(3)])
        (o, d, w, i), (p, e, v, j) = onward
        if len(i) + len(j) == 0:
            return
        ray, part, index = mi.Ray3f(join(o, p), join(d, e)), join(w, v), dr.concat((i, j))


@dr.syntax
def one_way(scene, emitters, ray, chance):
    """One way at each face of glass, at random: a loop within one kernel."""
    light, part, level, active = mi.Color3f(0), mi.Color3f(1), mi.UInt32(0), mi.Bool(True)
    while active:
        si = scene.ray_intersect(ray, active)
        light += part * lit(scene, emitters, si, active, glass=True)
        active = active & si.is_valid() & mi.has_flag(si.bsdf().flags(), mi.BSDFFlags.Delta) & (level < DEPTH)
        after, weight = goes_on(si, -1, chance.next_float32(), active)
        ray, part = after, part * weight
        level += 1
    return light


class Picture:
    """Makes the picture, a sample of all pixels after another: that is faster than all samples at once."""

    def __init__(self, model, size, samples, white, pick):
        self.scene, self.camera = scene_of(model, white), Camera(model, size)
        self.emitters = self.scene.emitters()
        side = math.isqrt(samples)
        self.offsets = [((i + 0.5) / side, (j + 0.5) / side) for j in range(side) for i in range(side)]
        names = [name for name, _, _ in model.materials()]
        self.way = "lamps" if not {"Mirror", "Glass"} & set(names) else "one" if pick else "both"

    def make(self, number):
        light = dr.zeros(mi.Color3f, self.camera.width * self.camera.height)
        for k, offset in enumerate(self.offsets):
            light += self.sample(offset, number * len(self.offsets) + k)
            dr.eval(light)
        light /= len(self.offsets)
        dr.eval(light)
        dr.sync_thread()
        return light

    def sample(self, offset, seed):
        index, ray = self.camera.rays(*offset)
        if self.way == "lamps":
            return lit(self.scene, self.emitters, self.scene.ray_intersect(ray), mi.Bool(True))
        if self.way == "one":
            return one_way(self.scene, self.emitters, ray, mi.PCG32(size=len(index), initstate=dr.opaque(mi.UInt64, seed)))
        light = dr.zeros(mi.Color3f, len(index))
        both_ways(self.scene, self.emitters, index, ray, light)
        return light


def main():
    a = arguments()
    mi.set_variant(a.variant)
    dr.set_thread_count(a.threads)
    began = time.perf_counter()
    size = tuple(int(side) for side in a.size.split("x"))
    model = Model(a.model)
    picture = Picture(model, size, a.samples, a.white, a.pick)
    dr.sync_thread()
    built = time.perf_counter()
    first = picture.make(0)
    done = time.perf_counter()
    if a.save:
        np.save(a.save, np.array(first).T.reshape(size[1], size[0], 3))
    facts = {"libraries": began - start, "build": built - began, "first": done - built}
    serve(facts, lambda number: picture.make(number + 1))


if __name__ == "__main__":
    sys.exit(main())
