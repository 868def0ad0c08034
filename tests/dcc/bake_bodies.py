#!/usr/bin/env python3
"""Animates two bodies in Blender and writes each as glTF, Alembic and USD.

    python3 tests/dcc/bake_bodies.py tests/scenes/caches/samples

Needs Blender as a module: pip install bpy==5.0.1 (Python 3.11). Both run for half a second at 32 frames a second.

    slide  a ball that moves by 1/64 m a frame: every number is the same in both files
    bend   a column whose upper half turns by 60 degrees, with smooth weights: skinned by Blender in single precision
"""

import argparse
import math
import pathlib

import bpy

FPS = 32
FRAMES = 17


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = FPS, 1.0
    scene.frame_start, scene.frame_end = 0, FRAMES - 1


def add_mesh(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))  # one normal a vertex: glTF splits none
    body = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(body)
    return body


def move_linearly(action_owner):
    """Interpolates all keys linearly."""
    for layer in action_owner.animation_data.action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                for curve in bag.fcurves:
                    for key in curve.keyframe_points:
                        key.interpolation = "LINEAR"


def make_slide():
    """162 vertices, 320 triangles, 0.2 m about the origin."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.2)
    body = bpy.context.object
    body.name = body.data.name = "slide"
    body.data.polygons.foreach_set("use_smooth", [True] * len(body.data.polygons))
    for frame, x in ((0, 0.0), (FRAMES - 1, (FRAMES - 1) / 64)):
        body.location = (x, 0.0, 0.0)
        body.keyframe_insert("location", frame=frame)
    move_linearly(body)


def make_bend():
    """A closed column along Blender's Z, 0.8 m high, of rings of eight vertices."""
    rings, corners = 13, 8
    vertices = [(0.08 * math.cos(math.tau * k / corners), 0.08 * math.sin(math.tau * k / corners), 0.8 * r / (rings - 1))
                for r in range(rings) for k in range(corners)]
    faces = []
    for r in range(rings - 1):
        for k in range(corners):
            a, b = r * corners + k, r * corners + (k + 1) % corners
            faces += [(a, b, b + corners), (a, b + corners, a + corners)]
    for k in range(1, corners - 1):
        faces += [(0, k + 1, k), ((rings - 1) * corners, (rings - 1) * corners + k, (rings - 1) * corners + k + 1)]
    body = add_mesh("bend", vertices, faces)

    armature = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    lower = armature.data.edit_bones.new("lower")
    lower.head, lower.tail = (0, 0, 0), (0, 0, 0.4)
    upper = armature.data.edit_bones.new("upper")
    upper.head, upper.tail, upper.parent = (0, 0, 0.4), (0, 0, 0.8), lower
    bpy.ops.object.mode_set(mode="POSE")
    bone = armature.pose.bones["upper"]
    bone.rotation_mode = "QUATERNION"
    for frame in range(FRAMES):
        angle = math.radians(60.0) * frame / (FRAMES - 1)
        bone.rotation_quaternion = (math.cos(angle / 2), math.sin(angle / 2), 0, 0)
        bone.keyframe_insert("rotation_quaternion", frame=frame)
    bpy.ops.object.mode_set(mode="OBJECT")
    move_linearly(armature)

    groups = {name: body.vertex_groups.new(name=name) for name in ("lower", "upper")}
    for v, (_, _, z) in enumerate(vertices):
        weight = min(max((z - 0.3) / 0.2, 0.0), 1.0)
        groups["lower"].add([v], 1.0 - weight, "REPLACE")
        groups["upper"].add([v], weight, "REPLACE")
    body.modifiers.new("skin", "ARMATURE").object = armature
    body.parent = armature


def export(folder, name):
    file = str(folder / name)
    bpy.ops.export_scene.gltf(filepath=file + ".glb", export_animations=True, export_force_sampling=False,
                              export_texcoords=False, export_materials="NONE", export_optimize_animation_size=False)
    bpy.ops.wm.alembic_export(filepath=file + ".abc", start=0, end=FRAMES - 1, uvs=False, normals=False,
                              flatten=False, packuv=False)
    bpy.ops.wm.usd_export(filepath=file + ".usdc", export_animation=True, export_uvmaps=False, export_normals=False,
                          export_materials=False, export_armatures=False)


def main():
    parser = argparse.ArgumentParser(description="Write sample bodies from Blender.")
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder.resolve()
    for name, make in (("slide", make_slide), ("bend", make_bend)):
        empty_scene()
        make()
        export(folder, name)


if __name__ == "__main__":
    main()
