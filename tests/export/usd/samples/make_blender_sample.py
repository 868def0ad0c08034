"""Writes blender.usdc beside this file with Blender as a module: pip install bpy==5.0.1 (Python 3.11)

A grid of 2 x 1 quads whose point at its corner rises by 0.25 m a frame, in frames 1 to 4, in an object that is moved by
(0, 0, 1) m. Two materials, "left" and "right", have a quad each.
"""

import pathlib

import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.frame_start, scene.frame_end, scene.render.fps = 1, 4, 24
mesh = bpy.data.meshes.new("cloth")
mesh.from_pydata([(x, y, 0) for y in range(2) for x in range(3)], [], [(0, 1, 4, 3), (1, 2, 5, 4)])
texture = mesh.uv_layers.new(name="st")
for loop, at in zip(mesh.loops, texture.data):
    at.uv = (mesh.vertices[loop.vertex_index].co.x / 2, mesh.vertices[loop.vertex_index].co.y)
for name in ("left", "right"):
    mesh.materials.append(bpy.data.materials.new(name))
mesh.polygons[1].material_index = 1
cloth = bpy.data.objects.new("cloth", mesh)
cloth.location.z = 1.0
scene.collection.objects.link(cloth)
cloth.shape_key_add(name="rest")
cloth.shape_key_add(name="raised").data[5].co.z = 0.75
value = cloth.data.shape_keys.key_blocks["raised"]
for frame in (1, 4):
    value.value = (frame - 1) / 3
    value.keyframe_insert("value", frame=frame)
for curve in cloth.data.shape_keys.animation_data.action.layers[0].strips[0].channelbags[0].fcurves:
    for point in curve.keyframe_points:
        point.interpolation = "LINEAR"
bpy.ops.wm.usd_export(filepath=str(pathlib.Path(__file__).with_name("blender.usdc")), export_animation=True,
                      export_materials=True, generate_preview_surface=False, export_shapekeys=False)
