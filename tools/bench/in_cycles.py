#!/usr/bin/env python3
"""A model of the benchmark in Blender's Cycles: in_cycles.py MODEL.glb [--size 1280x720] [--samples 1] [--threads 2] [--save PICTURE.exr]

Serves bench.py (see serve.py). Cycles picks one of the lamps at random for each sample and one way at each face of glass: to shade both lamps it takes two
samples. Light between walls, denoising and adaptive sampling are off. Lamps do not shine through its glass.
"""
import argparse
import os
import time

from serve import quietly, serve

start = time.perf_counter()
import bpy  # noqa: E402

from model import DEPTH, INDEX, MIRROR  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("model")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--samples", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--save")
    return parser.parse_args()


def simple_surfaces():
    """The cheapest shader that a user could choose, instead of the importer's."""
    for material in bpy.data.materials:
        if not material.node_tree:
            continue
        nodes, links = material.node_tree.nodes, material.node_tree.links
        old = nodes["Principled BSDF"]
        name = material.name.split(".")[0]
        new = nodes.new({"Mirror": "ShaderNodeBsdfGlossy", "Glass": "ShaderNodeBsdfGlass"}.get(name, "ShaderNodeBsdfDiffuse"))
        if name == "Mirror":
            new.inputs["Color"].default_value = (MIRROR, MIRROR, MIRROR, 1)
        elif name != "Glass":
            color = old.inputs["Base Color"]
            new.inputs["Color"].default_value = color.default_value
            for link in color.links:
                links.new(link.from_socket, new.inputs["Color"])
        if name in ("Mirror", "Glass"):
            new.inputs["Roughness"].default_value = 0
        if name == "Glass":
            new.inputs["IOR"].default_value = INDEX
        output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
        links.new(new.outputs[0], output.inputs["Surface"])


def settings(scene, size, samples, threads):
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.threads_mode, render.threads = "FIXED", threads
    render.resolution_x, render.resolution_y, render.resolution_percentage = *size, 100
    render.use_persistent_data = True
    render.use_compositing = render.use_sequencer = render.use_motion_blur = False
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = samples, False, False
    cycles.pixel_filter_type = "BOX"
    sharp = any(material.name.startswith(("Mirror", "Glass")) for material in bpy.data.materials)
    deep = DEPTH if sharp else 0
    cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = deep
    cycles.diffuse_bounces = cycles.volume_bounces = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"


def main():
    a = arguments()
    out = quietly()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    began = time.perf_counter()
    bpy.ops.import_scene.gltf(filepath=os.path.abspath(a.model))
    scene = bpy.context.scene
    scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
    for lamp in bpy.data.lights:
        lamp.shadow_soft_size = 0
    simple_surfaces()
    settings(scene, tuple(int(side) for side in a.size.split("x")), a.samples, a.threads)
    built = time.perf_counter()
    bpy.ops.render.render(write_still=False)
    done = time.perf_counter()
    if a.save:
        scene.render.filepath = os.path.abspath(a.save)
        bpy.ops.render.render(write_still=True)
    facts = {"libraries": began - start, "build": built - began, "first": done - built}
    serve(facts, lambda _: bpy.ops.render.render(write_still=False), out)


if __name__ == "__main__":
    main()
