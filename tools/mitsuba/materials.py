"""Render materials at rest with Mitsuba 3 and compare them with terrell's picture of them, in linear light.

usage: python materials.py [--folder FOLDER] [--picture SIDE_BY_SIDE.jpg] [--require PERCENT] MANIFEST.yaml ...

Both sides look through the middle of each pixel. Mitsuba's materials say what part of a lamp's light goes where, and where rays go on;
at glass both ways are followed, so that there is no noise on either side. Spectra are traced on both. See README.md.
"""
import argparse
import os
import sys

import numpy as np
from PIL import Image

from compare import difference, moved, read_exr, spread
from gltf_meshes import Glb
from manifest import Manifest, numbers, quantity

BANDS = np.arange(364.0, 836.0, 8.0)  # nm, the middles of bands of 8 nm
WAVELENGTHS = np.concatenate([BANDS, np.full(-len(BANDS) % 4, 1000.0)])  # Mitsuba traces four at a time
TABLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "src", "spectrum")
UNLIT = 100.0  # cd/m2
FAINTEST = 1e-4
DEPTH = 12
RGB_FROM_XYZ = np.linalg.inv(np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]))


def table(name):
    """Rows of a table of terrell's."""
    return np.loadtxt(os.path.join(TABLES, name + ".csv"), delimiter=",", comments="#")


def reflectance(rgb):
    """Linear sRGB as wavelengths and values."""
    primaries = table("primaries")
    return primaries[:, 0], primaries[:, 1:4] @ np.array(rgb, float)


def at_bands(curve):
    """A curve (nm, values) at all wavelengths."""
    return np.interp(WAVELENGTHS, *curve)


def spectrum(nm, values):
    """A piecewise linear spectrum in Mitsuba; what it does beyond its ends is no matter to the eye."""
    written = lambda numbers: ",".join(repr(float(x)) for x in numbers)
    return {"type": "irregular", "wavelengths": written(nm), "values": written(np.maximum(values, 0))}


class Body:
    """One mesh or shape in Mitsuba, and what Mitsuba's materials do not say."""

    def __init__(self, name):
        self.name = name
        self.glow = None  # what it emits, of D65 (nm, values)
        self.absorbs = None  # (nm, what is left after the distance), distance
        self.pane = None  # (nm, colour): a pane without thickness
        self.mirrors = False  # whether rays go on from it


class Peer:
    """The manifest's scene in Mitsuba."""

    def __init__(self, mi, manifest):
        self.mi, self.manifest = mi, manifest
        self.bodies, scene = [], {"type": "scene"}
        for body in manifest.bodies:
            for shape in self._shapes(body):
                scene[f"body{len(self.bodies) - 1}"] = shape
        for number, light in enumerate(manifest.lights):
            assert light.kind == "lamp" and light.spectrum[0] == "D65", "lamps of daylight only"
            scene[f"light{number}"] = {"type": "point", "position": light.at.tolist(), "intensity": {"type": "d65", "scale": light.strength}}
        self.scene = mi.load_dict(scene, parallel=False)
        self.lamps = self.scene.emitters()
        sky = manifest.written.get("surroundings")
        self.sky = float(quantity(sky["uniform"]["luminance"], "cd/m2")) if sky else 0.0

    def _shapes(self, body):
        known = body.file
        if isinstance(known, dict):
            self.bodies.append(Body(body.name))
            kind, size = ("sphere", known["sphere"]["radius"]) if "sphere" in known else ("cube", known["box"]["size"])
            half = np.broadcast_to(quantity(size, "m") / (1 if kind == "sphere" else 2), 3)
            to_world = self.mi.ScalarTransform4f(body.matrix @ np.diag([*half, 1]))
            yield {"type": kind, "to_world": to_world, "bsdf": self._written(body.material, self.bodies[-1])}
            return
        file = Glb(known)
        for primitive in file.primitives(body.node):
            mine = Body(body.name)
            self.bodies.append(mine)
            bsdf = self._written(body.material, mine) if body.material else self._from_file(primitive.material, file, mine)
            yield self._mesh(body, primitive, bsdf)

    def _mesh(self, body, primitive, bsdf):
        mi = self.mi
        matrix = body.matrix @ primitive.matrix
        points = primitive.points @ matrix[:3, :3].T + matrix[:3, 3]
        normals = primitive.normals @ np.linalg.inv(matrix[:3, :3])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        properties = mi.Properties()
        properties["bsdf"] = mi.load_dict(bsdf)
        mesh = mi.Mesh(f"body{len(self.bodies) - 1}", len(points), len(primitive.triangles), properties, True, primitive.uv is not None)
        params = mi.traverse(mesh)
        params["vertex_positions"] = np.ascontiguousarray(points, np.float32).ravel()
        params["faces"] = np.ascontiguousarray(primitive.triangles, np.uint32).ravel()
        params["vertex_normals"] = np.ascontiguousarray(normals, np.float32).ravel()
        if primitive.uv is not None:
            params["vertex_texcoords"] = np.ascontiguousarray(primitive.uv, np.float32).ravel()
        params.update()
        return mesh

    def _diffuse(self, rgb):
        return {"type": "diffuse", "reflectance": spectrum(*reflectance(rgb))}

    def _written(self, material, mine):
        """A material of the manifest's."""
        if "metal" in material:
            rows = table(material["metal"])
            rows = rows[(rows[:, 0] > 330) & (rows[:, 0] < 900)]
            index = {"eta": spectrum(rows[:, 0], rows[:, 1]), "k": spectrum(rows[:, 0], rows[:, 2])}
            roughness = material.get("roughness", 0)
            mine.mirrors = roughness == 0
            if roughness == 0:
                return {"type": "conductor", **index}
            return {"type": "roughconductor", "distribution": "ggx", "alpha": roughness**2, "sample_visible": False, **index}
        if "glass" in material:
            mine.mirrors = True
            return {"type": "dielectric", "int_ior": float(material["glass"]), "ext_ior": 1.0}
        value = material["diffuse"]
        rgb = numbers(value["rgb"]) if isinstance(value, dict) else np.full(3, float(value))
        return {"type": "twosided", "bsdf": self._diffuse(rgb)}

    def _from_file(self, material, file, mine):
        """A material of a model's."""
        extensions, pbr = material.get("extensions", {}), material["pbrMetallicRoughness"]
        color, metallic, roughness = pbr["baseColorFactor"], pbr["metallicFactor"], pbr["roughnessFactor"]
        if "KHR_materials_unlit" in extensions:
            assert material.get("doubleSided"), "what has no back lets light through from behind in terrell"
            mine.glow = reflectance(color[:3])
            return {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.0}}
        if "KHR_materials_transmission" in extensions:
            mine.mirrors = True
            volume = extensions.get("KHR_materials_volume")
            if volume:
                mine.absorbs = reflectance(volume["attenuationColor"]), volume["attenuationDistance"]
            else:
                mine.pane = reflectance(color[:3])
            index = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
            return {"type": "dielectric", "int_ior": index, "ext_ior": 1.0}
        if metallic == 1:
            base = spectrum(*reflectance(color[:3]))
            return {"type": "principled", "metallic": 1.0, "roughness": roughness, "base_color": base}
        if extensions.get("KHR_materials_specular", {}).get("specularFactor") != 0 or metallic != 0:
            raise SystemExit(f"{material['name']}: a gloss is another thing in Mitsuba")
        bsdf = self._diffuse(color[:3])
        if "normalTexture" in material:
            texels = file.texels(material["normalTexture"])[..., :3]
            bsdf = {"type": "normalmap", "normalmap": self._texels(texels), "bsdf": bsdf, "use_shadowing_function": False}
        if material.get("doubleSided"):
            bsdf = {"type": "twosided", "bsdf": bsdf}
        if material.get("alphaMode") == "MASK":
            there = file.texels(pbr["baseColorTexture"])[..., 3:] >= 255 * material["alphaCutoff"]
            return {"type": "mask", "opacity": self._texels(255 * there.astype(np.uint8)), "bsdf": bsdf}
        if material.get("alphaMode") == "BLEND":
            return {"type": "mask", "opacity": color[3], "bsdf": bsdf}
        return bsdf

    def _texels(self, texels):
        data = self.mi.Bitmap((np.ascontiguousarray(texels) / 255).astype(np.float32))
        return {"type": "bitmap", "bitmap": data, "raw": True, "filter_type": "nearest", "wrap_mode": "clamp"}

    # ------------------------------------------------------------ light

    def shape_numbers(self, si):
        import drjit as dr
        mi = self.mi
        number = lambda pointer: np.array(dr.reinterpret_array(mi.UInt32, pointer))
        shape, found = number(si.shape), np.full(np.shape(np.array(si.t)), -1)
        for s in self.scene.shapes():
            found[shape == number(mi.ShapePtr(s))[0]] = int(s.id().removeprefix("body"))
        return np.where(np.array(si.is_valid()), found, -1)

    def shadow(self, si, target):
        """What of a lamp's light arrives: masks and blends let it through. Second: whether glass is in the way."""
        import drjit as dr
        mi = self.mi
        ray, left = si.spawn_ray_to(target), np.ones(len(np.array(si.t)))
        glass = np.zeros(len(left), bool)
        mirrors = np.array([b.mirrors and b.name not in ("silver", "gold", "copper") for b in self.bodies] + [False])
        for _ in range(6):
            met = self.scene.ray_intersect(ray, si.is_valid())
            shape = self.shape_numbers(met)
            there = np.array(met.is_valid())
            if not there.any():
                break
            null = np.array(met.bsdf().eval_null_transmission(met, met.is_valid())).max(0)
            through = mirrors[shape] & there
            glass |= through & (left > 0)
            left = np.where(there, left * np.where(through, 1.0, null), left)
            onward = met.spawn_ray_to(target)
            ray = dr.select(met.is_valid(), onward, ray)
            ray.maxt = dr.select(met.is_valid(), ray.maxt, 0.0)
        return left, glass

    def trace(self):
        """Spectral radiance by pixel and band; and what part of it hangs on what lamps do through glass."""
        mi = self.mi
        width, height = self.manifest.size
        count = width * height
        d65 = self.daylight()
        total, doubtful = np.zeros((count, len(WAVELENGTHS)), np.float32), np.zeros(count)
        depth = min(DEPTH, int(self.manifest.written["picture"].get("depth", 8)))
        pixel = np.arange(count)
        o = np.broadcast_to(self.manifest.observer.at, (count, 3)).astype(np.float32)
        d = self.manifest.observer.directions(width, height).astype(np.float32)
        part, inside = np.ones((count, len(WAVELENGTHS)), np.float32), np.full(count, -1)
        for bounce in range(depth + 1):
            ray = mi.Ray3f(self.vector(mi.Point3f, o), self.vector(mi.Vector3f, d))
            si = self.scene.ray_intersect(ray)
            shape, valid = self.shape_numbers(si), np.array(si.is_valid())
            self.absorb(part, inside, np.where(valid, np.array(si.t), 0))
            light, unsure = self.direct(si, valid)
            light[~valid] = self.sky * d65
            for k, body in enumerate(self.bodies):
                if body.glow is not None:
                    light[shape == k] = UNLIT * d65 * at_bands(body.glow)
            np.add.at(total, pixel, light * part)
            np.add.at(doubtful, pixel, unsure * part.max(1))
            if bounce == depth:
                break
            pixel, o, d, part, inside = self.onward(si, shape, d, pixel, part, inside)
            keep = part.max(1) > FAINTEST
            pixel, o, d, part, inside = (a[keep] for a in (pixel, o, d, part, inside))
            if not len(pixel):
                break
        return total, doubtful

    def vector(self, kind, a):
        """Rows of three as Mitsuba has them."""
        return kind(*[self.mi.Float(np.ascontiguousarray(a[:, i], np.float32)) for i in range(3)])

    def each_four(self, si):
        """Sets the hit's wavelengths, four at a time; where they are among all."""
        import drjit as dr
        for first in range(0, len(WAVELENGTHS), 4):
            si.wavelengths = self.mi.Spectrum(*[self.mi.Float([float(w)]) for w in WAVELENGTHS[first : first + 4]])
            dr.make_opaque(si.wavelengths)
            yield slice(first, first + 4)

    def absorb(self, part, inside, way):
        for k, body in enumerate(self.bodies):
            if body.absorbs is not None and (inside == k).any():
                color, distance = body.absorbs
                part[inside == k] *= at_bands(color)[None, :] ** (way[inside == k, None] / distance)

    def direct(self, si, valid):
        """Lamps' light by Mitsuba's material; and how much of it arrives through glass."""
        mi = self.mi
        context, bsdf = mi.BSDFContext(), si.bsdf()
        light, unsure = np.zeros((len(valid), len(WAVELENGTHS)), np.float32), np.zeros(len(valid))
        for lamp in self.lamps:
            place = lamp.sample_direction(si, mi.Point2f(0.5, 0.5), si.is_valid())[0].p
            left, glass = self.shadow(si, place)
            left = np.where(valid, left, 0).astype(np.float32)
            for four in self.each_four(si):
                sample, strength = lamp.sample_direction(si, mi.Point2f(0.5, 0.5), si.is_valid())
                value = np.array(strength * bsdf.eval(context, si, si.to_local(sample.d), si.is_valid())).T
                value = np.where(valid[:, None], value, 0) * left[:, None]
                light[:, four] += value
                unsure += np.where(glass, value.max(1), 0)
        return light, unsure

    def onward(self, si, shape, d, pixel, part, inside):
        """The rays that go on: those through holes, and both kinds at smooth surfaces."""
        mi = self.mi
        context, bsdf, valid = mi.BSDFContext(), si.bsdf(), si.is_valid()
        states = []
        def add(which, direction, by, within):
            if which.any():
                start = np.array(si.spawn_ray(self.vector(mi.Vector3f, direction)).o).T
                by = by[which] if by.ndim == 2 and len(by) > 1 else by
                states.append((pixel[which], start[which], direction[which], part[which] * by.astype(np.float32), within[which]))
        null = np.array(bsdf.eval_null_transmission(si, valid)).T.max(1)
        add(np.array(valid) & (null > 0), d, null[:, None], inside)
        kinds = lambda of: np.array([of(b) for b in self.bodies] + [False])[shape]
        smooth, pane = kinds(lambda b: b.mirrors), kinds(lambda b: b.pane is not None)
        has = lambda sample, flag: (np.array(sample.sampled_type) & int(flag)) != 0
        # The first of its kinds of light, and its chance: for glass the part that is reflected.
        sample, by = bsdf.sample(context, si, 0.0, mi.Point2f(0.5, 0.5), valid)
        mirrored = smooth & has(sample, mi.BSDFFlags.DeltaReflection)
        chance = np.where(mirrored, np.array(sample.pdf), 0)
        away = np.array(si.to_world(sample.wo)).T
        reflected = np.zeros_like(part)
        for four in self.each_four(si):
            reflected[:, four] = np.array(bsdf.sample(context, si, 0.0, mi.Point2f(0.5, 0.5), valid)[1]).T * chance[:, None]
        add(mirrored, away, reflected, inside)
        sample, by = bsdf.sample(context, si, 1 - 1e-6, mi.Point2f(0.5, 0.5), valid)
        refracted = np.array(sample.pdf)[:, None] * np.array(by).T[:, :1]
        within = np.where(np.array(sample.wo.z) < 0, shape, -1)
        add(smooth & has(sample, mi.BSDFFlags.DeltaTransmission) & ~pane, np.array(si.to_world(sample.wo)).T, refracted, within)
        for k, body in enumerate(self.bodies):
            if body.pane is not None:  # glTF's: one face, and the rest straight on
                add(shape == k, d, (1 - chance)[:, None] * at_bands(body.pane)[None, :], inside)
        if not states:
            return [np.zeros((0, *a.shape[1:]), a.dtype) for a in (pixel, d, d, part, inside)]
        return [np.concatenate(column) for column in zip(*states)]

    def daylight(self):
        """D65 of 1 cd/m2, as Mitsuba has it."""
        import drjit as dr
        d65, si = self.mi.load_dict({"type": "d65"}), dr.zeros(self.mi.SurfaceInteraction3f)
        return np.concatenate([np.array(d65.eval(si)).reshape(4) for _ in self.each_four(si)])

    def rgb(self):
        """The picture in linear sRGB, and where it hangs on lamps behind glass."""
        mi = self.mi
        matching = np.array(mi.cie1931_xyz(mi.Float(WAVELENGTHS))) * (BANDS[1] - BANDS[0]) * mi.MI_CIE_Y_NORMALIZATION
        light, doubtful = self.trace()
        width, height = self.manifest.size
        rgb = light @ matching.T @ RGB_FROM_XYZ.T
        return rgb.reshape(height, width, 3), (doubtful > 2e-3 * light.sum(1)).reshape(height, width)


def even(picture):
    """Pixels about which a picture is smooth: no edge, of a body or of something seen in it."""
    level, bend = picture.max(-1), 0.0
    for axis in (0, 1):
        bend = np.maximum(bend, np.abs(moved(level, 1, axis) + moved(level, -1, axis) - 2 * level))
    edge = (bend > 0.03 * level) | (spread(level) > 0.25 * level)
    return ~edge & (spread(edge.astype(int)) == 0)


def first_bodies(peer):
    """The number of what each pixel shows first."""
    mi = peer.mi
    width, height = peer.manifest.size
    d = peer.manifest.observer.directions(width, height).astype(np.float32)
    ray = mi.Ray3f(mi.Point3f(*[float(x) for x in peer.manifest.observer.at]), mi.Vector3f(d[:, 0], d[:, 1], d[:, 2]))
    return peer.shape_numbers(peer.scene.ray_intersect(ray)).reshape(height, width)


def compare(mi, path, folder):
    """One manifest: prints the table; both pictures and the share within 2 %."""
    manifest = Manifest(path)
    peer = Peer(mi, manifest)
    theirs, doubtful = peer.rgb()
    exr = manifest.exr()
    if not exr:
        raise SystemExit(f"no picture of terrell's yet: cargo run --release -- render {path}")
    ours = read_exr(mi, exr)
    d, lit = difference(ours, theirs), theirs.max(-1) > 1e-3 * np.percentile(theirs.max(-1), 99)
    plain = even(theirs) & lit & ~doubtful
    print(f"{path}: {theirs.shape[1]} x {theirs.shape[0]}, Mitsuba {mi.__version__} {mi.variant()}")
    print(f"  {'pixels':42}{'number':>9}{'median':>12}{'99th pct':>12}{'largest':>12}{'within 2 %':>12}")
    def line(name, where):
        v = d[where]
        if len(v):
            print(f"  {name:42}{len(v):9d}{np.median(v):12.2e}{np.percentile(v, 99):12.2e}{v.max():12.2e}{100 * (v <= 0.02).mean():10.3f} %")
    line("all that show something", lit)
    line("of these, without lamps behind glass", lit & ~doubtful)
    line("and away from edges", plain)
    shape = first_bodies(peer)
    for name in dict.fromkeys(b.name for b in peer.bodies):
        line(f"    {name}", plain & np.isin(shape, [k for k, b in enumerate(peer.bodies) if b.name == name]))
    if folder:
        os.makedirs(folder, exist_ok=True)
        stem = os.path.join(folder, os.path.splitext(os.path.basename(path))[0])
        shown = np.clip(d / 0.1, 0, 1)[..., None] * np.ones(3)
        shown[~plain] *= (0.25, 0.35, 1.0)
        mi.util.write_bitmap(stem + "-difference.png", mi.Bitmap(shown.astype(np.float32)))
    return ours, theirs, (d[plain] <= 0.02).mean()


def side_by_side(pairs, path):
    """terrell on the left, Mitsuba on the right, a row for each manifest."""
    rows = []
    for ours, theirs in pairs:
        white = np.percentile(theirs.max(-1), 97)
        rows.append(np.concatenate([ours / white, np.ones((len(ours), 4, 3)), theirs / white], 1))
    linear = np.clip(np.concatenate(rows), 0, 1)
    stored = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    Image.fromarray(np.round(255 * stored).astype(np.uint8)).save(path, quality=88)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("manifests", nargs="+")
    arguments.add_argument("--folder", help="where numbers and difference pictures go; unless said, nowhere")
    arguments.add_argument("--picture", help="the two pictures side by side")
    arguments.add_argument("--require", type=float, default=99.0, help="percent of plain pixels that must agree within 2 %% (else exit code 1)")
    a = arguments.parse_args()
    import mitsuba as mi
    mi.set_variant("llvm_ad_spectral")
    found = [compare(mi, path, a.folder) for path in a.manifests]
    if a.picture:
        side_by_side([(ours, theirs) for ours, theirs, _ in found], a.picture)
    return 0 if all(100 * share >= a.require for *_, share in found) else 1


if __name__ == "__main__":
    sys.exit(main())
