#!/usr/bin/env python3
"""Compares a cache, as Blender plays it, with a point cache of the same run.

    python3 tests/dcc/compare.py skirt.abc skirt.pc2 [--start-frame 1001] [--picture skirt.png]
    python3 tests/dcc/compare.py skirt.usda skirt.pc2

Needs Blender as a module: pip install bpy==5.0.1 (Python 3.11). Prints the largest difference of a vertex over all
frames, and exits with 0 if it is at most --tolerance, else with 1. Where Blender turns the object for its upward axis,
that rounds; the numbers of the mesh are those of the cache.
"""

import argparse
import pathlib
import sys

import bpy
import numpy as np


def read_pc2(file):
    """Start frame and positions [frames, points, 3] in metres."""
    data = pathlib.Path(file).read_bytes()
    if data[:12] != b"POINTCACHE2\0":
        sys.exit(f"{file}: does not start with POINTCACHE2; this is no PC2 file")
    points = int(np.frombuffer(data, "<i4", 1, 16)[0])
    start = float(np.frombuffer(data, "<f4", 1, 20)[0])
    frames = int(np.frombuffer(data, "<i4", 1, 28)[0])
    return start, np.frombuffer(data, "<f4", 3 * points * frames, 32).reshape(frames, points, 3).astype(float)


def import_mesh(cache, fps):
    """The only mesh of an Alembic archive or a USD file in an empty scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = round(fps)
    bpy.context.scene.render.fps_base = round(fps) / fps
    path = str(pathlib.Path(cache).resolve())
    if pathlib.Path(cache).suffix == ".abc":
        bpy.ops.wm.alembic_import(filepath=path, set_frame_range=False)
    else:
        # Without the unit: the numbers are compared as they are stored.
        bpy.ops.wm.usd_import(filepath=path, set_frame_range=False, apply_unit_conversion_scale=False)
    meshes = [item for item in bpy.context.scene.objects if item.type == "MESH"]
    if len(meshes) != 1:
        sys.exit(f"{cache}: has {len(meshes)} meshes; one is compared")
    return meshes[0]


def played(item, frame):
    """Positions [points, 3] with Y up, where Blender has Z up, and the numbers [points, 3] that the mesh holds."""
    bpy.context.scene.frame_set(frame)
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", flat)
    matrix = np.array(evaluated.matrix_world)
    world = flat.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
    evaluated.to_mesh_clear()
    return np.stack([world[:, 0], world[:, 2], -world[:, 1]], axis=1), flat.reshape(-1, 3)


def render(x, file):
    """Draws the current frame from the front, from a distance that shows all positions, which have Y up."""
    scene = bpy.context.scene
    corners = np.stack([x[:, 0], -x[:, 2], x[:, 1]], axis=1)
    middle, size = (corners.min(0) + corners.max(0)) / 2, np.linalg.norm(np.ptp(corners, axis=0))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = middle + np.array([0.0, -1.6 * size, 0.0])
    camera.rotation_euler = (np.pi / 2, 0, 0)
    light = bpy.data.objects.new("light", bpy.data.lights.new("light", "SUN"))
    light.data.energy = 3.0
    light.rotation_euler = (0.7, 0.3, 0)
    for added in (camera, light):
        scene.collection.objects.link(added)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 16
    scene.render.resolution_x = scene.render.resolution_y = 480
    scene.render.filepath = str(pathlib.Path(file).resolve())
    bpy.ops.render.render(write_still=True)


def main():
    parser = argparse.ArgumentParser(description="Compare a cache, as Blender plays it, with a PC2.")
    parser.add_argument("cache", help=".abc, .usda, .usdc or .usd of one mesh")
    parser.add_argument("reference", help="PC2 of the same frames, in metres with Y up")
    parser.add_argument("--fps", type=float, default=24.0, help="frames a second of the cache")
    parser.add_argument("--unit", choices=["m", "cm"], default="m", help="of the cache")
    parser.add_argument("--up", choices=["y", "z"], default="y", help="upward axis of the cache; Blender turns USD itself")
    parser.add_argument("--start-frame", type=int, help="of the cache; without it the PC2's")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="allowed difference in metres")
    parser.add_argument("--picture", help="PNG of the last frame")
    options = parser.parse_args()

    start, reference = read_pc2(options.reference)
    first = round(start) if options.start_frame is None else options.start_frame
    item = import_mesh(options.cache, options.fps)
    worst, at, same = 0.0, (0, 0), 0
    for k, expected in enumerate(reference):
        x, stored = played(item, first + k)
        x = x / (100.0 if options.unit == "cm" else 1.0)
        if options.up == "z":
            x = np.stack([x[:, 0], x[:, 2], -x[:, 1]], axis=1)
        if x.shape != expected.shape:
            sys.exit(f"{options.cache}: has {len(x)} points at frame {first + k}, the reference {len(expected)}")
        same += np.array_equal(stored, expected)
        difference = np.linalg.norm(x - expected, axis=1)
        if difference.max() > worst:
            worst, at = difference.max(), (first + k, int(difference.argmax()))
    print(f"{options.cache}: {len(reference)} frames, {same} with the same bits in the mesh, {reference.shape[1]} points, "
          f"{len(item.data.uv_layers)} sets of texture coordinates, {len(item.data.materials)} face sets, "
          f"largest difference {worst:.3g} m" + (f" at frame {at[0]}, point {at[1]}" if worst > 0 else ""))
    if options.picture:
        render(played(item, first + len(reference) - 1)[0], options.picture)
    return 0 if worst <= options.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
