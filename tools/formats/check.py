#!/usr/bin/env python3
"""Opens a file of every format that terrell writes with readers of others, and prints a table: check.py [--terrell PROGRAM] [--keep FOLDER]

Readers, as far as they are there: ImageMagick, ffprobe and ffmpeg, exrheader (OpenEXR's own), Chromium, Pillow, and Blender's OpenImageIO (the module bpy). Pictures are compared with the PNG of
8 bits as Pillow reads it: the table says how far values of 0 to 255 are off in the mean, and for linear files by which part ffmpeg and Blender differ at most. Needs numpy and Pillow.
Ends with 1 if a reader refuses a file, or reads another size, number of pictures or other colours.
"""
import argparse
import functools
import http.server
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading

import numpy as np
from PIL import Image

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE = (320, 180)
COUNT = 12
MANIFEST = """
light_speed: 1 m/s
assets: { ball: { sphere: { radius: 1 m } }, floor: { plane: {} } }
bodies:
  - { asset: ball, at: 0 1 0 m, velocity: 0.6 0 0 c, material: { diffuse: { rgb: 0.8 0.3 0.1 } } }
  - { asset: floor, material: { diffuse: { rgb: 0.3 0.4 0.5 } } }
lights: [{ lamp: { intensity: 400 cd }, at: 2 5 4 m }]
observer: { at: 0 2 8 m, look_at: 0 1 0 m }
exposures: { from: 4 s, to: 14 s, count: 12 }
picture: { size: 320 180, samples: 1, white: 2 cd/m2 }
film: { rate: 12, file: [film.mp4, film.gif, film.avi] }
output: { folder: out, png: 8, bmp: on, exr: on, doppler: on, emission_time: on }
"""
OTHERS = {
    "sixteen": {"output.png": "16"},
    "half": {"output.exr": "{ depth: half }"},
    "radiance": {"output.exr": "{ layers: [radiance] }"},
    "spectrum": {"output.exr": "{ layers: [radiance, spectrum] }"},
}
EXPOSURE = 6
rows, wrong = [], []


def said(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise ValueError(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "refused")
    return done.stdout


def row(what, reader, reads):
    """Adds a line to the table: what a reader reads of a file, or why not."""
    try:
        rows.append((what, reader, reads()))
    except (ValueError, OSError, AssertionError, KeyError, SyntaxError) as error:
        rows.append((what, reader, f"FAILED: {error}"))
        wrong.append(what)


def expect(found, expected, what):
    if found != expected:
        raise ValueError(f"{what} {found}, not {expected}")


def off(found, right, most):
    """How far a picture is off another in the mean, of 255."""
    difference = np.abs(found.astype(float) - right.astype(float)).mean()
    if difference > most:
        raise ValueError(f"off by {difference:.2f}")
    return "the same" if difference == 0 else f"off by {difference:.2f} of 255"


def pillow(path, right, most):
    picture = Image.open(path)
    height = SIZE[1] if right is not None else picture.size[1]
    expect(picture.size, (SIZE[0], height), "size")
    text = [key for key in ("Fingerprint", "Velocity") if key in getattr(picture, "text", {})]
    values = np.asarray(picture.convert("RGB"))
    about = f"{picture.format} {picture.mode} {picture.size[0]} x {picture.size[1]}"
    if text:
        about += ", texts"
    return about if right is None else f"{about}, {off(values, right, most)}"


def by_magick(path):
    gamma = said("identify", "-format", "%[gamma]", path)
    if abs(float(gamma) - 1 / 2.2) > 0.01:
        raise ValueError(f"gamma {gamma}")
    return "sRGB"


def raw(path, pixels, number=0):
    """A picture of a file as ffmpeg decodes it."""
    command = ["ffmpeg", "-v", "error", "-i", path, "-vf", f"select=eq(n\\,{number})", "-frames:v", "1", "-f", "rawvideo", "-pix_fmt", pixels, "-"]
    done = subprocess.run(command, capture_output=True)
    if done.returncode != 0 or not done.stdout or done.stderr:
        raise ValueError(done.stderr.decode().strip()[-200:] or "no picture")
    return done.stdout


def by_ffmpeg(path, right, most, number=0):
    values = np.frombuffer(raw(path, "rgb24", number), np.uint8).reshape(-1, SIZE[0], 3)
    if right is None:
        return f"{values.shape[1]} x {values.shape[0]}"
    return f"{SIZE[0]} x {values.shape[0]}, {off(values, right, most)}"


def probed(path, pictures):
    entries = "stream=codec_name,width,height,pix_fmt,nb_read_frames,duration:format_tags=comment"
    found = json.loads(said("ffprobe", "-v", "error", "-count_frames", "-show_entries", entries, "-of", "json", path))
    stream = found["streams"][0]
    expect((stream["width"], stream["height"]), SIZE, "size")
    expect(int(stream["nb_read_frames"]), pictures, "pictures")
    expect(round(float(stream["duration"]), 2), pictures / 12, "seconds")
    if "Fingerprint" not in found["format"].get("tags", {}).get("comment", ""):
        raise ValueError("no comment")
    return f"{stream['codec_name']} {stream['pix_fmt']}, {pictures} pictures in {float(stream['duration']):.2f} s, comment"


def linear(path):
    """Red, green and blue of an OpenEXR file as ffmpeg decodes it."""
    planes = np.frombuffer(raw(path, "gbrpf32le"), np.float32).reshape(3, SIZE[1], SIZE[0])
    return planes[[2, 0, 1]].transpose(1, 2, 0)


def header(path, names, attributes):
    text = said("exrheader", path)
    channels = re.findall(r"^    ([^ ]+), (16|32)-bit", text, re.M)
    found = [name for name, _ in channels]
    missing = [name for name in names if name not in found] + [name for name in attributes if name not in text]
    if missing:
        raise ValueError(f"no {', '.join(missing)}")
    bits = sorted({bits for _, bits in channels})
    return f"{len(channels)} channels of {' and '.join(bits)} bits, {', '.join(attributes)}"


def by_blender(path, bpy):
    """Pixels of a file of R, G and B; of others the passes that the compositor offers."""
    picture = bpy.data.images.load(path)
    tree = bpy.data.node_groups.new("check", "CompositorNodeTree")
    node = tree.nodes.new("CompositorNodeImage")
    node.image = picture
    if picture.type == "MULTILAYER":
        return "passes " + ", ".join(output.name for output in node.outputs if output.name != "Alpha")
    expect(tuple(picture.size), SIZE, "size")
    values = np.empty(4 * SIZE[0] * SIZE[1], np.float32)
    picture.pixels.foreach_get(values)
    values = values.reshape(SIZE[1], SIZE[0], 4)[::-1, :, :3]
    other = linear(path)
    apart = np.abs(values - other).max() / np.abs(other).max()
    if apart > 1e-3:
        raise ValueError(f"{apart:.1e} from what ffmpeg reads")
    return f"{SIZE[0]} x {SIZE[1]}, R G B " + ("as ffmpeg reads them" if apart == 0 else f"within {apart:.0e} of what ffmpeg reads")


PAGE = """<body><script>
const files = %s, said = {};
const drawn = (what, width, height) => {
  const canvas = Object.assign(document.createElement('canvas'), {width, height});
  const context = canvas.getContext('2d');
  context.drawImage(what, 0, 0);
  const pixels = context.getImageData(0, 0, width, height).data, mean = [0, 0, 0];
  for (let i = 0; i < pixels.length; i++) if (i %% 4 < 3) mean[i %% 4] += pixels[i] / (width * height);
  return [width, height, ...mean];
};
const one = async name => {
  if (name.endsWith('mp4')) {
    const film = document.createElement('video');
    film.muted = true; film.src = name;
    await new Promise((done, refused) => { film.onloadeddata = done; film.onerror = () => refused(film.error.message); });
    return drawn(film, film.videoWidth, film.videoHeight);
  }
  const picture = new Image();
  picture.src = name;
  await picture.decode();
  return drawn(picture, picture.naturalWidth, picture.naturalHeight);
};
(async () => {
  for (const name of files) try { said[name] = await one(name); } catch (error) { said[name] = String(error); }
  await fetch('said', {method: 'POST', body: JSON.stringify(said)});
})();
</script>"""


def by_chromium(folder, names, program):
    """Size and mean colour of each file as a browser shows it."""
    with open(os.path.join(folder, "page.html"), "w") as page:
        page.write(PAGE % json.dumps(names))

    told, done = {}, threading.Event()

    class Listening(http.server.SimpleHTTPRequestHandler):
        def do_POST(self):
            told.update(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()
            done.set()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Listening, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    address = f"http://127.0.0.1:{server.server_address[1]}/page.html"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        flags = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}"]
        browser = subprocess.Popen([program, *flags, address], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        done.wait(120)
        browser.terminate()
        browser.wait()
    server.shutdown()
    return {name: told.get(name, "nothing was heard of it") for name in names}


def shown(found, right, most):
    if isinstance(found, str):
        raise ValueError(found)
    height = right.shape[0]
    expect(tuple(found[:2]), (SIZE[0], height), "size")
    apart = np.abs(np.array(found[2:]) - right.reshape(-1, 3).mean(axis=0)).max()
    if apart > most:
        raise ValueError(f"mean colour off by {apart:.2f}")
    return f"{SIZE[0]} x {height}, mean colour within {apart:.2f} of 255"


def rendered(program, folder):
    with open(os.path.join(folder, "film.yaml"), "w") as file:
        file.write(MANIFEST)
    said(program, "render", os.path.join(folder, "film.yaml"))
    for name, changes in OTHERS.items():
        flags = [flag for change in changes.items() for flag in ("--set", "=".join(change))]
        said(program, "render", os.path.join(folder, "film.yaml"), "--exposure", str(EXPOSURE), "--out", os.path.join(folder, name), *flags)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--terrell", default=os.path.join(HERE, "..", "..", "target", "release", "terrell"))
    arguments.add_argument("--keep", help="where the files go; unless said they are removed")
    given = arguments.parse_args()
    there = tempfile.TemporaryDirectory()
    folder = os.path.abspath(given.keep) if given.keep else there.name
    os.makedirs(folder, exist_ok=True)
    rendered(os.path.abspath(given.terrell), folder)
    name = f"{EXPOSURE:04}"
    out = os.path.join(folder, "out")
    at = lambda ending: os.path.join(out, f"{name}.{ending}")
    right = np.asarray(Image.open(at("png")).convert("RGB"))
    first = np.asarray(Image.open(os.path.join(out, "0000.png")).convert("RGB"))
    sixteen = os.path.join(folder, "sixteen", f"{name}.png")

    pictures = [("PNG, 8 bits", at("png"), right), ("PNG, 16 bits", sixteen, right), ("BMP", at("bmp"), right)]
    pictures += [("Doppler factor", at("doppler.png"), None), ("emission time", at("emission_time.png"), None)]
    for what, path, expected in pictures:
        row(what, "Pillow", lambda: pillow(path, expected, 1.0))
        row(what, "ffmpeg", lambda: by_ffmpeg(path, expected, 1.0))
        if path.endswith(".png"):
            row(what, "ImageMagick", lambda: by_magick(path))
    row("PNG, 16 bits", "file", lambda: said("file", "-b", sixteen).strip())

    light = ["R", "G", "B", "distance", "normal.X", "body", "material", "albedo.R", "doppler", "emission_time", "cie.Y"]
    bands = [f"S0.{400 + 300 / 16 * (i + 0.5):g}nm".replace(".", ",").replace("S0,", "S0.") for i in range(16)]
    layout = ["spectralLayoutVersion", "emissiveUnits"]
    files = [("OpenEXR, float", at("exr"), light, []), ("OpenEXR, half", os.path.join(folder, "half", f"{name}.exr"), light, [])]
    files += [("OpenEXR, R G B", os.path.join(folder, "radiance", f"{name}.exr"), ["R", "G", "B"], [])]
    files += [("OpenEXR, spectrum", os.path.join(folder, "spectrum", f"{name}.exr"), bands + ["R"], layout)]
    try:
        import bpy
    except ImportError:
        bpy = None
    for what, path, names, more in files:
        row(what, "exrheader", lambda: header(path, names, ["Fingerprint", "Velocity", *more]))
        row(what, "ffmpeg", lambda: f"{linear(path).shape[1]} x {linear(path).shape[0]}, R G B to {linear(path).max():.4g}")
        if bpy:
            row(what, "Blender", lambda: by_blender(path, bpy))

    for kind, ending, most in (("MP4", "mp4", 4.0), ("GIF", "gif", 6.0), ("AVI", "avi", 3.0)):
        film = os.path.join(out, f"film.{ending}")
        row(kind, "ffprobe", lambda: probed(film, COUNT))
        row(kind, "ffmpeg", lambda: by_ffmpeg(film, right, most, EXPOSURE))
    row("GIF", "Pillow", lambda: f"{expect(Image.open(os.path.join(out, 'film.gif')).n_frames, COUNT, 'pictures') or COUNT} pictures")

    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser:
        shutil.copy(sixteen, os.path.join(out, "sixteen.png"))
        names = {f"{name}.png": ("PNG, 8 bits", right, 0.5), "sixteen.png": ("PNG, 16 bits", right, 1.0), f"{name}.bmp": ("BMP", right, 0.5)}
        for ending, what in (("doppler.png", "Doppler factor"), ("emission_time.png", "emission time")):
            names[f"{name}.{ending}"] = (what, np.asarray(Image.open(at(ending)).convert("RGB")), 0.5)
        names |= {"film.gif": ("GIF", first, 2.0), "film.mp4": ("MP4", first, 4.0)}
        found = by_chromium(out, list(names), browser)
        for file, (what, expected, most) in names.items():
            row(what, "Chromium", lambda: shown(found[file], expected, most))
    print("| format | opened by |\n| --- | --- |")
    for what in dict.fromkeys(what for what, _, _ in rows):
        print(f"| {what} | " + "; ".join(f"{reader}: {reads}" for of, reader, reads in rows if of == what) + " |")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
