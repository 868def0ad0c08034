"""Writes blender.ply, blender_text.ply and meshlab.ply beside this file: pip install bpy==5.0.1 pymeshlab

All are a quad and a triangle over five points with texture coordinates; MeshLab's has two triangles for the quad.
"""

import pathlib

import bpy
import pymeshlab

FOLDER = pathlib.Path(__file__).parent
POINTS = [(0, 0, 0), (1, 0, 0), (1, 1, 0.5), (0, 1, 0), (2, 0.5, 1)]
FACES = [(0, 1, 2, 3), (1, 4, 2)]
UVS = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0), (0.5, 0), (1, 1)]  # of corners: a seam at point 1

obj = FOLDER / "quad.obj"
corner = iter(range(1, 8))
obj.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in POINTS) + "".join(f"vt {u} {v}\n" for u, v in UVS) +
               "".join("f " + " ".join(f"{v + 1}/{next(corner)}" for v in face) + "\n" for face in FACES),
               encoding="utf-8")

meshes = pymeshlab.MeshSet()
meshes.load_new_mesh(str(obj))
meshes.save_current_mesh(str(FOLDER / "meshlab.ply"), save_wedge_texcoord=True, save_vertex_normal=True)

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=str(obj), forward_axis="Y", up_axis="Z")
for name, ascii_format in (("blender.ply", False), ("blender_text.ply", True)):
    bpy.ops.wm.ply_export(filepath=str(FOLDER / name), ascii_format=ascii_format, export_uv=True, export_normals=True,
                          forward_axis="Y", up_axis="Z")
obj.unlink()
