"""Render a manifest at rest with Mitsuba 3 and compare it with terrell's picture of it, in linear light.

usage: python compare.py MANIFEST.yaml [--spectral] [--exr PICTURE.exr] [--mitsuba-only] [--folder FOLDER] [--require PERCENT]

Both sides look through the middle of each pixel (so no noise and no filter on either), light is counted from every lamp without
sampling, surfaces are Lambert's on both sides, shadows hard. Compared are R, G, B in cd/m2 of D65 white. See README.md.
"""
import argparse
import os
import sys
import tempfile

import numpy as np

from gltf_meshes import File
from manifest import Manifest

WAVELENGTHS = np.arange(362.0, 830.0, 4.0)  # nm, the middles of bands of 4 nm: 117, filled up to a multiple of 4


# ---------------------------------------------------------------- the scene in Mitsuba

class Peer:
    """The manifest's scene in Mitsuba."""

    def __init__(self, mi, manifest, spectral):
        self.mi, self.manifest, self.spectral = mi, manifest, spectral
        self.folder = tempfile.mkdtemp()
        self.bodies = []
        scene = {"type": "scene"}
        if "surroundings" in manifest.written:
            raise SystemExit("surroundings are not understood here")
        for number, body in enumerate(manifest.bodies):
            if isinstance(body.file, dict) or (body.material is not None and body.reflectance is None):
                raise SystemExit(f"body {body.name}: only model files, and `material: {{ diffuse: NUMBER }}`, are understood here (see materials.py)")
            for k, primitive in enumerate(File(body.file).primitives(body.node)):
                scene[f"shape{number}_{k}"] = self._mesh(body, primitive)
                self.bodies.append(body.name)
        for number, light in enumerate(manifest.lights):
            scene[f"light{number}"] = self._light(light)
        self.scene = mi.load_dict(scene, parallel=False)
        self.emitters = self.scene.emitters()

    def _mesh(self, body, primitive):
        """Vertices are brought to the lab here, in double precision, so that Mitsuba only sees a finished mesh."""
        mi = self.mi
        matrix = body.matrix @ primitive.matrix
        points = primitive.points @ matrix[:3, :3].T + matrix[:3, 3]
        bsdf = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": self._reflectance(body, primitive.material)}}
        has_normals, has_uv = primitive.normals is not None, primitive.uv is not None
        properties = mi.Properties()
        properties["bsdf"] = mi.load_dict(bsdf)
        mesh = mi.Mesh(body.name, len(points), len(primitive.triangles), properties, has_normals, has_uv)
        params = mi.traverse(mesh)
        params["vertex_positions"] = np.ascontiguousarray(points, np.float32).ravel()
        params["faces"] = np.ascontiguousarray(primitive.triangles, np.uint32).ravel()
        if has_normals:
            normals = primitive.normals @ np.linalg.inv(matrix[:3, :3])
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            params["vertex_normals"] = np.ascontiguousarray(normals, np.float32).ravel()
        if has_uv:
            params["vertex_texcoords"] = np.ascontiguousarray(primitive.uv, np.float32).ravel()
        params.update()
        return mesh

    def _reflectance(self, body, material):
        if body.reflectance is not None:
            return {"type": "uniform", "value": body.reflectance} if self.spectral else {"type": "rgb", "value": [body.reflectance] * 3}
        if material.picture is None:
            return {"type": "rgb", "value": material.color.tolist()}
        if not np.allclose(material.color, 1):
            raise SystemExit(f"{material.name}: a picture with a factor is not understood")
        path = os.path.join(self.folder, f"{len(os.listdir(self.folder))}.jpg")
        with open(path, "wb") as file:
            file.write(material.picture)
        return {"type": "bitmap", "filename": path, "filter_type": "bilinear", "wrap_mode": "repeat"}

    def _light(self, light):
        mi = self.mi
        strength = self._emission(light)
        if light.kind == "lamp":
            return {"type": "point", "position": light.at.tolist(), "intensity": strength}
        if light.kind == "sun":
            return {"type": "directional", "direction": light.direction.tolist(), "irradiance": strength}
        up = [1, 0, 0] if abs(light.direction[0]) < 0.9 else [0, 1, 0]
        half = float(np.degrees(light.half_angle))
        to_world = mi.ScalarTransform4f().look_at(light.at.tolist(), (light.at + light.direction).tolist(), up)
        return {"type": "spot", "to_world": to_world, "intensity": strength, "cutoff_angle": half, "beam_width": half * 0.999999}

    def _emission(self, light):
        """Mitsuba's white of value 1 is what terrell calls 1 cd (or lx) of D65."""
        kind, temperature = light.spectrum
        if not self.spectral:
            if kind != "D65":
                raise SystemExit(f"a lamp of spectrum {kind} needs --spectral")
            return {"type": "rgb", "value": [light.strength] * 3}
        if kind == "D65":
            return {"type": "d65", "scale": light.strength}
        grid = np.arange(360.0, 831.0, 1.0)
        values = np.ones_like(grid) if kind == "E" else planck(grid, 2856.0 if kind == "A" else temperature)
        y = np.array(self.mi.cie1931_xyz(self.mi.Float(grid)))[1]
        values *= light.strength / (np.trapz(values * y, grid) * self.mi.MI_CIE_Y_NORMALIZATION)
        return {"type": "regular", "wavelength_min": 360.0, "wavelength_max": 830.0, "values": ",".join(repr(float(v)) for v in values)}

    def look(self):
        """Trace the pixel middles once: what is seen there, and by which lamps it is lit."""
        mi = self.mi
        width, height = self.manifest.size
        directions = self.manifest.observer.directions(width, height).astype(np.float32)
        origin = self.manifest.observer.at
        self.ray = mi.Ray3f(mi.Point3f(*[float(x) for x in origin]), mi.Vector3f(directions[:, 0], directions[:, 1], directions[:, 2]))
        self.hit = self.scene.ray_intersect(self.ray)
        return self

    def radiance(self, wavelengths=None):
        """Direct light at the hits, summed over lamps; numpy (pixels, channels)."""
        import drjit as dr
        mi, si = self.mi, self.hit
        if wavelengths is not None:
            si.wavelengths = mi.Spectrum(*[float(w) for w in wavelengths])
        bsdf, context = si.bsdf(), mi.BSDFContext()
        total = mi.Spectrum(0.0)
        for emitter in self.emitters:
            sample, spectrum = emitter.sample_direction(si, mi.Point2f(0.5, 0.5), si.is_valid())
            dark = self.scene.ray_test(si.spawn_ray_to(sample.p), si.is_valid())
            value = bsdf.eval(context, si, si.to_local(sample.d), si.is_valid())
            total += dr.select(si.is_valid() & ~dark, spectrum * value, 0.0)
        return np.array(total).T

    def rgb(self):
        """The picture in linear sRGB."""
        if not self.spectral:
            return self.radiance()
        mi = self.mi
        padded = np.concatenate([WAVELENGTHS, np.full(-len(WAVELENGTHS) % 4, 1000.0)])
        xyz = 0.0
        for four in padded.reshape(-1, 4):
            matching = np.array(mi.cie1931_xyz(mi.Float(four)))
            xyz = xyz + self.radiance(four) @ matching.T * 4.0 * mi.MI_CIE_Y_NORMALIZATION
        return xyz @ np.linalg.inv(np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])).T

    def facts(self):
        """For finding edges: body, depth, normals, reflectance, and for each lamp whether it reaches the pixel (2: only one of the two normals says so)."""
        import drjit as dr
        mi, si = self.mi, self.hit
        valid = np.array(si.is_valid())
        number = lambda pointer: np.array(dr.reinterpret_array(mi.UInt32, pointer))
        shape = np.full(len(valid), -1)
        for k, s in enumerate(self.scene.shapes()):
            shape[number(si.shape) == number(mi.ShapePtr(s))[0]] = k
        normal, flat = np.array(si.sh_frame.n).T, np.array(si.n).T
        view = -np.array(self.ray.d).T
        if self.spectral:
            si.wavelengths = mi.Spectrum(450, 530, 600, 660)
        reach = []
        for emitter in self.emitters:
            sample, spectrum = emitter.sample_direction(si, mi.Point2f(0.5, 0.5), si.is_valid())
            lit = np.array(~self.scene.ray_test(si.spawn_ray_to(sample.p), si.is_valid())) & (np.array(spectrum).max(0) > 0)
            way = np.array(sample.d).T
            side = lambda n: np.sign((n * way).sum(1)) * np.sign((n * view).sum(1))
            disagree = side(normal) != side(flat)
            reach.append(np.where(disagree, 2, lit & (side(normal) > 0)))
        albedo = np.array(si.bsdf().eval_diffuse_reflectance(si, si.is_valid())).T
        return {"valid": valid, "shape": shape, "depth": np.where(valid, np.array(si.t), 0), "normal": normal, "reach": np.array(reach), "albedo": albedo}


def planck(nm, kelvin):
    """A black body's shape, W per wavelength, any scale."""
    x = 1.438776877e7 / (nm * kelvin)
    return 1e15 / nm**5 / np.expm1(x)


# ---------------------------------------------------------------- where edges are

def spread(picture, amount=1):
    """Largest less smallest value in the square of 2 amount + 1 pixels about each pixel."""
    low = high = picture
    for axis in (0, 1):
        lows, highs = [low], [high]
        for shift in range(1, amount + 1):
            for sign in (1, -1):
                lows.append(moved(low, sign * shift, axis))
                highs.append(moved(high, sign * shift, axis))
        low, high = np.min(lows, 0), np.max(highs, 0)
    return high - low


def moved(picture, shift, axis):
    """Shifted, the border repeated."""
    index = np.clip(np.arange(picture.shape[axis]) - shift, 0, picture.shape[axis] - 1)
    return np.take(picture, index, axis)


def masks(facts, width, height):
    """Pixels whose neighbours show the same surface in the same lamps' light; and among those, the ones whose paint is even."""
    square = lambda a: a.reshape(height, width, *a.shape[1:])
    valid, shape, depth = square(facts["valid"]), square(facts["shape"]), square(facts["depth"])
    even = valid & (spread(shape) == 0) & (spread(valid.astype(int)) == 0)
    for reach in facts["reach"]:
        r = square(reach.astype(int))
        even &= (spread(r) == 0) & (r != 2)
    # A step in depth within one mesh: an ear before a cheek. Second differences, so that slanted surfaces are no edges.
    for axis in (0, 1):
        bend = np.abs(moved(depth, 1, axis) + moved(depth, -1, axis) - 2 * depth)
        even &= moved(bend, 1, axis) + moved(bend, -1, axis) + bend < 0.01 * depth
    even &= spread(square(facts["normal"])).max(-1) < 0.25
    albedo = square(facts["albedo"])
    painted = spread(albedo).max(-1) > 0.02 * albedo.max(-1)
    return valid, even, even & ~painted


# ---------------------------------------------------------------- the comparison

def read_exr(mi, path):
    """R, G, B of an EXR in cd/m2 of white, whatever else is in it."""
    bitmap = mi.Bitmap(path)
    fields = [bitmap.struct_()[k].name for k in range(len(bitmap.struct_()))]
    data = np.array(bitmap)  # all channels are 32 bits wide
    missing = [c for c in "RGB" if c not in fields]
    if missing:
        raise SystemExit(f"{path}: no channel {missing[0]}; it has {', '.join(fields)}")
    metadata = bitmap.metadata()
    white = metadata["whiteLuminance"] if "whiteLuminance" in metadata else 1.0  # cd/m2 of R = G = B = 1
    return white * np.stack([data[..., fields.index(c)] for c in "RGB"], -1)


def difference(ours, theirs):
    """Largest difference of the three channels over the largest of theirs: a colour cast counts as much as a wrong brightness."""
    return np.abs(ours - theirs).max(-1) / np.maximum(theirs.max(-1), 1e-12)


def report(name, d, where):
    """One line of the table."""
    v = d[where]
    if not len(v):
        return print(f"  {name:34} none")
    print(f"  {name:34}{len(v):9d}{np.median(v):12.2e}{np.percentile(v, 99):12.2e}{v.max():12.2e}{100 * (v <= 0.01).mean():10.3f} %")


def compare(ours, theirs, facts, bodies):
    """Print the table; return the differences and the share of even, unpainted, lit pixels within 1 %."""
    height, width = theirs.shape[:2]
    valid, even, plain = masks(facts, width, height)
    lit = theirs.max(-1) > 1e-3 * np.percentile(theirs.max(-1), 90)
    d = difference(ours, theirs)
    print(f"  {'pixels':34}{'number':>9}{'median':>12}{'99th pct':>12}{'largest':>12}{'within 1 %':>12}")
    report("all that show something lit", d, valid & lit)
    report("away from edges and shadow edges", d, even & lit)
    report("and away from edges in paint", d, plain & lit)
    shape = facts["shape"].reshape(height, width)
    for name in dict.fromkeys(bodies):
        mine = np.isin(shape, [k for k, b in enumerate(bodies) if b == name])
        report(f"  of these, {name}", d, plain & lit & mine)
    dark = even & (theirs.max(-1) <= 0)
    if dark.any():
        print(f"  pixels that no lamp reaches: {dark.sum()}, brightest in terrell's picture {ours[dark].max():.2e} (brightest of all {theirs.max():.2e})")
    ratio = ours[plain & lit].sum(-1) / theirs[plain & lit].sum(-1)
    print(f"  terrell / Mitsuba, median of R + G + B: {np.median(ratio):.6f}")
    share = (d[plain & lit] <= 0.01).mean()
    return d, plain & lit, share


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("manifest")
    arguments.add_argument("--spectral", action="store_true", help="trace wavelengths in Mitsuba too (lamps other than D65)")
    arguments.add_argument("--exr", help="terrell's picture; unless said, the newest in the manifest's output folder")
    arguments.add_argument("--mitsuba-only", action="store_true", help="only render Mitsuba's side")
    arguments.add_argument("--folder", help="where mitsuba.exr, mitsuba.png and difference.png go; unless said, nowhere")
    arguments.add_argument("--require", type=float, default=99.0, help="percent of plain pixels that must agree within 1 %% (else exit code 1)")
    a = arguments.parse_args()
    import mitsuba as mi
    mi.set_variant("llvm_ad_spectral" if a.spectral else "llvm_ad_rgb")
    manifest = Manifest(a.manifest)
    width, height = manifest.size
    peer = Peer(mi, manifest, a.spectral).look()
    facts = peer.facts()
    theirs = peer.rgb().reshape(height, width, 3)
    white = np.percentile(theirs.max(-1), 99)
    if a.folder:
        os.makedirs(a.folder, exist_ok=True)
        mi.Bitmap(theirs.astype(np.float32)).write(os.path.join(a.folder, "mitsuba.exr"))
        save_png(mi, theirs / white, os.path.join(a.folder, "mitsuba.png"))
    print(f"{a.manifest}: {width} x {height}, Mitsuba {mi.__version__} {mi.variant()}, 99th percentile {white:.4g} cd/m2")
    if a.mitsuba_only:
        return 0
    path = a.exr or manifest.exr()
    if not path:
        raise SystemExit(f"no picture of terrell's yet: cargo run --release -- render {a.manifest}")
    ours = read_exr(mi, path)
    if ours.shape != theirs.shape:
        raise SystemExit(f"{path} is {ours.shape[1]} x {ours.shape[0]}, not {width} x {height}")
    d, plain, share = compare(ours, theirs, facts, peer.bodies)
    if a.folder:
        shown = np.clip(d / 0.05, 0, 1)[..., None] * np.array((1.0, 1.0, 1.0))
        shown[~plain] *= (0.25, 0.35, 1.0)
        save_png(mi, shown, os.path.join(a.folder, "difference.png"))
    return 0 if 100 * share >= a.require else 1


def save_png(mi, linear, path):
    mi.util.write_bitmap(path, mi.Bitmap(np.clip(linear, 0, 1).astype(np.float32)))


if __name__ == "__main__":
    sys.exit(main())
