# SPDX-License-Identifier: MIT
"""Makes a shot for Cycles and saves it: fine patterns, wires, a turning wheel and a ball, seen by a moving camera.

blender -b --factory-startup --python make_scene.py -- FILE.blend WIDTH HEIGHT FRAMES SAMPLES
"""
import math
import sys

import bpy


def material(name, colour, other=None, scale=1.0):
    """Diffuse; with another colour: a checker of both, `scale` cells a unit."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = 0.7
    shader.inputs["Base Color"].default_value = (*colour, 1)
    if other:
        checker = nodes.new("ShaderNodeTexChecker")
        checker.inputs["Color1"].default_value = (*colour, 1)
        checker.inputs["Color2"].default_value = (*other, 1)
        checker.inputs["Scale"].default_value = scale
        place = nodes.new("ShaderNodeTexCoord")
        links.new(place.outputs["Object"], checker.inputs["Vector"])
        links.new(checker.outputs["Color"], shader.inputs["Base Color"])
    return made


def add(operator, surface, **arguments):
    operator(**arguments)
    made = bpy.context.object
    made.data.materials.append(surface)
    return made


def linear_keys(owner, path, values):
    """One key for each (frame, value), with straight lines between them."""
    preferences = bpy.context.preferences.edit
    preferences.keyframe_new_interpolation_type = "LINEAR"
    for frame, value in values:
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def add_wheel(frames):
    rim = add(bpy.ops.mesh.primitive_torus_add, material("rim", (0.6, 0.1, 0.05)), location=(-1.6, 1.2, 1.4),
              rotation=(math.pi / 2, 0, 0), major_radius=1.1, minor_radius=0.05, major_segments=64)
    for i in range(8):
        spoke = add(bpy.ops.mesh.primitive_cylinder_add, material("spoke", (0.7, 0.6, 0.2)), radius=0.018, depth=2.2,
                    rotation=(math.pi / 2, 0, 0))
        spoke.parent = rim
        spoke.location = (0, 0, 0)
        spoke.rotation_euler = (math.pi / 2, 0, i * math.pi / 8)
    linear_keys(rim, "rotation_euler", [(0, (math.pi / 2, 0, 0)), (frames, (math.pi / 2, frames * 0.02, 0))])


def add_things(frames):
    add(bpy.ops.mesh.primitive_plane_add, material("ground", (0.35, 0.3, 0.22), (0.12, 0.15, 0.1), 3), size=60)
    bricks = material("wall", (0.55, 0.5, 0.45), (0.25, 0.1, 0.08), 9)
    add(bpy.ops.mesh.primitive_cube_add, bricks, location=(1, 4, 1.5), scale=(4, 0.2, 1.5))
    for i in range(14):
        add(bpy.ops.mesh.primitive_cylinder_add, material("wire", (0.02, 0.02, 0.02)), radius=0.012, depth=2,
            location=(0.2 + i * 0.22, 1.5, 1), rotation=(0, 0.35, 0))
    add_wheel(frames)
    squares = material("ball", (0.8, 0.8, 0.8), (0.05, 0.1, 0.5), 6)
    ball = add(bpy.ops.mesh.primitive_uv_sphere_add, squares, radius=0.45, segments=48, ring_count=24)
    bpy.ops.object.shade_smooth()
    linear_keys(ball, "location", [(0, (-2.5, 0, 0.45)), (frames, (-2.5 + 0.04 * frames, 0, 0.45))])
    linear_keys(ball, "rotation_euler", [(0, (0, 0, 0)), (frames, (0, 0.08 * frames, 0))])
    bpy.ops.object.text_add(location=(0.3, 3.7, 1.2), rotation=(math.pi / 2, 0, 0))
    text = bpy.context.object
    text.data.body, text.data.size = "QUINCUNX", 0.6
    text.data.materials.append(material("text", (0.9, 0.85, 0.7)))


def add_light_and_camera(frames):
    bpy.ops.object.light_add(type="SUN", rotation=(0.8, 0.2, 0.6))
    bpy.context.object.data.energy, bpy.context.object.data.angle = 3, 0.02
    bpy.ops.object.camera_add(location=(0, -6, 1.7), rotation=(math.radians(86), 0, 0))
    camera = bpy.context.object
    camera.data.lens = 35
    linear_keys(camera, "location", [(0, (-0.4, -6, 1.7)), (frames, (-0.4 + 0.015 * frames, -6, 1.7))])
    turn = [(0, (math.radians(86), 0, 0.05)), (frames, (math.radians(86), 0, 0.05 - 0.002 * frames))]
    linear_keys(camera, "rotation_euler", turn)
    bpy.context.scene.camera = camera


def add_sky():
    """Bright above and dark below, with bands that show how it moves."""
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    world.cycles.sampling_method, world.cycles.sample_map_resolution = "MANUAL", 64  # else it takes seconds a frame
    bands = nodes.new("ShaderNodeTexWave")
    bands.inputs["Scale"].default_value = 6
    bands.inputs["Distortion"].default_value = 3
    place = nodes.new("ShaderNodeTexCoord")
    colours = nodes.new("ShaderNodeValToRGB")
    colours.color_ramp.elements[0].color = (0.25, 0.4, 0.7, 1)
    colours.color_ramp.elements[1].color = (0.8, 0.85, 0.9, 1)
    links.new(place.outputs["Generated"], bands.inputs["Vector"])
    links.new(bands.outputs["Fac"], colours.inputs["Fac"])
    links.new(colours.outputs["Color"], nodes["Background"].inputs["Color"])


def main():
    path, width, height, frames, samples = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    add_things(int(frames))
    add_light_and_camera(int(frames))
    add_sky()
    scene.frame_start, scene.frame_end = 1, int(frames)
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    scene.cycles.samples, scene.cycles.use_adaptive_sampling = int(samples), False
    scene.cycles.use_denoising, scene.cycles.seed = False, 1
    scene.render.filepath = "//out/shot_"
    bpy.ops.wm.save_as_mainfile(filepath=path)


main()
