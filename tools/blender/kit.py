"""What the model scripts share: an empty Blender, painted textures, materials, box-mapped UVs, and the export.

Scripts work in Blender's axes (z up). The exporter turns (x, y, z) into glTF's (x, z, -y), y up.
"""
import math
import os
import sys
import tempfile

import bpy
import numpy as np

GLB = dict(
    export_format="GLB", export_yup=True, export_apply=True, export_cameras=True, export_lights=True, export_extras=True,
    export_animations=False, export_image_format="AUTO", export_materials="EXPORT",
)


def output_folder():
    """The folder named on the command line, made if need be."""
    if len(sys.argv) != 2:
        sys.exit(f"usage: python {sys.argv[0]} OUTPUT_FOLDER")
    folder = os.path.abspath(sys.argv[1])
    os.makedirs(folder, exist_ok=True)
    return folder


def empty_scene():
    """A scene with nothing in it, not even the default cube."""
    bpy.ops.wm.read_factory_settings(use_empty=True)


# ---------------------------------------------------------------- painting

def srgb(linear):
    """Linear light to the sRGB code values in which pictures are stored."""
    v = np.clip(linear, 0, 1)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.power(v, 1 / 2.4) - 0.055)


def shrink(picture, k=2):
    """Average of k x k blocks: paint large, store small, and the edges come out smooth."""
    h, w = picture.shape[0] // k, picture.shape[1] // k
    return picture[: h * k, : w * k].reshape(h, k, w, k, -1).mean((1, 3))


def noise(n, octaves, seed, tile=1):
    """Value noise in 0..1 on n x n pixels that repeats at the edges; `octaves` are the grid sizes."""
    rng = np.random.default_rng(seed)
    total, weight = np.zeros((n, n)), 0.0
    for k in octaves:
        grid = rng.random((k, k))
        t = (np.arange(n) + 0.5) / n * k
        i = np.floor(t).astype(int)
        f = t - i
        f = f * f * (3 - 2 * f)
        a, b = i % k, (i + 1) % k
        rows = grid[a] * (1 - f)[:, None] + grid[b] * f[:, None]
        total += (rows[:, a] * (1 - f) + rows[:, b] * f) / k
        weight += 1.0 / k
    return total / weight


def image(name, picture, file=None, quality=88):
    """A Blender image from sRGB values (rows from the top). Stored as JPEG, or in `file` as PNG."""
    h, w = picture.shape[:2]
    made = bpy.data.images.new(name + "_painted", w, h)
    pixels = np.ones((h, w, 4), np.float32)
    pixels[..., :3] = np.clip(picture, 0, 1)
    made.pixels.foreach_set(pixels[::-1].ravel())
    made.file_format = "PNG" if file else "JPEG"
    path = file or os.path.join(tempfile.mkdtemp(), name + ".jpg")
    made.save(filepath=path, quality=100 if file else quality)
    bpy.data.images.remove(made)
    loaded = bpy.data.images.load(path)
    loaded.name = name
    if not file:
        loaded.pack()
        os.remove(path)
    return loaded


# ---------------------------------------------------------------- materials

def matte(name, color=(0.8, 0.8, 0.8), texture=None, glow=None, strength=0.0):
    """A diffuse material. `color` is linear reflectance; `glow` a linear colour shining with `strength` cd/m2."""
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    m.use_backface_culling = False
    nodes, links = m.node_tree.nodes, m.node_tree.links
    p = nodes["Principled BSDF"]
    p.inputs["Base Color"].default_value = (*color, 1)
    p.inputs["Roughness"].default_value = 1.0
    p.inputs["Specular IOR Level"].default_value = 0.0
    p.inputs["Metallic"].default_value = 0.0
    if texture:
        t = nodes.new("ShaderNodeTexImage")
        t.image = texture
        links.new(t.outputs["Color"], p.inputs["Base Color"])
    if glow:
        p.inputs["Emission Color"].default_value = (*glow, 1)
        p.inputs["Emission Strength"].default_value = strength
    return m


# ---------------------------------------------------------------- meshes

def mesh_object(name, vertices, faces, materials=(), material_of_face=None, uv=None, smooth=False):
    """An object from arrays. `uv` has one (u, v) per face corner, in order, v upwards."""
    me = bpy.data.meshes.new(name)
    me.from_pydata([tuple(map(float, v)) for v in vertices], [], [tuple(map(int, f)) for f in faces])
    for m in materials:
        me.materials.append(m)
    if material_of_face is not None:
        me.polygons.foreach_set("material_index", np.asarray(material_of_face, np.int32))
    if uv is not None:
        layer = me.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", np.asarray(uv, np.float32).ravel())
    me.polygons.foreach_set("use_smooth", np.full(len(me.polygons), smooth))
    me.validate()
    me.update()
    return place(name, me)


def place(name, data, at=(0, 0, 0), turn=(0, 0, 0), scale=(1, 1, 1), parent=None):
    """A new object showing `data` (a mesh shared by many objects is stored once). `turn` in degrees."""
    o = bpy.data.objects.new(name, data)
    o.location, o.scale = at, scale
    o.rotation_euler = [math.radians(a) for a in turn]
    o.parent = parent
    bpy.context.scene.collection.objects.link(o)
    return o


def only(o):
    """Select `o` alone, as operators want it."""
    bpy.ops.object.select_all(action="DESELECT")
    o.select_set(True)
    bpy.context.view_layer.objects.active = o


def modify(o, kind, **settings):
    """Add a modifier and apply it at once."""
    m = o.modifiers.new(kind, kind)
    for key, value in settings.items():
        setattr(m, key, value)
    only(o)
    bpy.ops.object.modifier_apply(modifier=m.name)
    return o


def smooth_by_angle(o, degrees=35.0):
    """Smooth shading but for edges sharper than this."""
    only(o)
    bpy.ops.object.shade_smooth_by_angle(angle=math.radians(degrees), keep_sharp_edges=True)
    return o


def bevelled_box(name, low, high, bevel=0.0, segments=2, material=None):
    """A box from corner to corner with rounded edges and flat-looking sides."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    corners = [[(low, high)[(i >> k) & 1][k] for k in range(3)] for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    o = mesh_object(name, corners, faces, [material] if material else [])
    if bevel > 0:
        modify(o, "BEVEL", width=bevel, segments=segments, limit_method="NONE", harden_normals=False)
        smooth_by_angle(o, 50)
        modify(o, "WEIGHTED_NORMAL", weight=100, keep_sharp=True)
    return o


def box_uv(o, metres_per_tile, offset=(0.0, 0.0)):
    """UVs seen along the axis nearest to each face's normal, one texture tile per so many metres."""
    me = o.data
    layer = me.uv_layers.active or me.uv_layers.new(name="UVMap")
    for p in me.polygons:
        axis = int(np.argmax(np.abs(p.normal)))
        a, b = [(1, 2), (0, 2), (0, 1)][axis]
        for i in p.loop_indices:
            v = me.vertices[me.loops[i].vertex_index].co
            layer.data[i].uv = (v[a] / metres_per_tile + offset[0], v[b] / metres_per_tile + offset[1])
    return o


def join(objects, name):
    """Make one mesh of several objects."""
    bpy.ops.object.select_all(action="DESELECT")
    for o in objects:
        o.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.join()
    objects[0].name = objects[0].data.name = name
    return objects[0]


# ---------------------------------------------------------------- export

def export_glb(path, **more):
    """Write the scene as binary glTF and say what is in it."""
    bpy.ops.export_scene.gltf(filepath=path, **{**GLB, **more})
    meshes = {o.data for o in bpy.context.scene.objects if o.type == "MESH"}
    count = lambda me: sum(len(p.vertices) - 2 for p in me.polygons)
    stored = sum(count(me) for me in meshes)
    shown = sum(count(o.data) for o in bpy.context.scene.objects if o.type == "MESH")
    print(f"{os.path.basename(path)}: {stored} triangles stored, {shown} shown, {os.path.getsize(path)} bytes", flush=True)
