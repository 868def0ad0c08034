#!/usr/bin/env python3
"""Compares a cache, as another program plays it, with point caches of the same run.

    python3 tests/dcc/compare.py skirt.abc skirt.pc2 [--start-frame 1001] [--render skirt.png]
    python3 tests/dcc/compare.py outfit.glb skirt.pc2 tee.pc2

.abc, .usda, .usdc, .glb, .pc2 and .mdd (on the OBJ beside them, or --mesh), .ply and .obj sequences are played by Blender, .pvd by
VTK: pip install -r tests/dcc/requirements.txt (Python 3.11). Of several references each is compared with the mesh of
its name. Prints the largest difference of a vertex over all frames, and exits with 0 if it is at most --tolerance,
else with 1.
"""

import argparse
import pathlib
import sys

import numpy as np

from players import player_of
from point_cache import read_pc2


def in_metres_y_up(x, unit, up):
    """Positions in metres with Y up, of a file that says otherwise."""
    x = x / (100.0 if unit == "cm" else 1.0)
    return np.stack([x[:, 0], x[:, 2], -x[:, 1]], axis=1) if up == "z" else x


def largest_difference(player, name, expected, options):
    """Over all frames [m], with its frame and point."""
    worst, at = 0.0, (options.first, 0)
    for k, reference in enumerate(expected):
        frame = options.first + k
        x = in_metres_y_up(player.positions(name, frame), options.unit, options.up)
        if x.shape != reference.shape:
            sys.exit(f"{options.cache}: has {len(x)} points at frame {frame}, the reference {len(reference)}")
        difference = np.linalg.norm(x - reference, axis=1)
        if not difference.max() <= worst:  # nor if it is no number
            worst, at = float(difference.max()), (frame, int(difference.argmax()))
    return worst, at


def velocity_difference(player, expected, options):
    """Largest difference from central differences, one-sided at the ends [m/s]; nothing if there are none."""
    if not hasattr(player, "velocities") or player.velocities(options.first) is None:
        return None
    expected = np.gradient(expected, axis=0) * options.fps if len(expected) > 1 else np.zeros_like(expected)
    return max(float(np.abs(in_metres_y_up(player.velocities(options.first + k), options.unit, options.up) - v).max())
               for k, v in enumerate(expected))


def render(player, name, frame, file):
    """Draws a frame from the front, from a distance that shows all positions."""
    import bpy

    x = player.positions(name, frame)
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


def describe(item):
    """What else Blender has of a mesh."""
    if item is None:
        return ""
    sides = [len(polygon.vertices) for polygon in item.data.polygons]
    return (f", {len(sides)} faces of up to {max(sides)} sides, {len(item.data.uv_layers)} sets of texture "
            f"coordinates, {len(item.data.materials)} materials")


def main():
    parser = argparse.ArgumentParser(description="Compare a cache, as another program plays it, with PC2 files.")
    parser.add_argument("cache", help=".abc, .usda, .usdc, .glb, .pc2, .mdd, .ply, .obj or .pvd; skirt_####.ply for a sequence")
    parser.add_argument("references", nargs="+", help="PC2 of each mesh, in metres with Y up, called as the mesh")
    parser.add_argument("--mesh", help="OBJ that a .pc2 or .mdd plays on [beside it]")
    parser.add_argument("--fps", type=float, default=24.0, help="frames a second of the cache")
    parser.add_argument("--unit", choices=["m", "cm"], default="m", help="of the cache")
    parser.add_argument("--up", choices=["y", "z"], default="y", help="upward axis of the cache; Blender turns USD itself")
    parser.add_argument("--start-frame", type=int, help="of the cache; without it the PC2's")
    parser.add_argument("--tolerance", type=float, help="allowed difference in metres [a micrometre; what a .glb says]")
    parser.add_argument("--render", metavar="FILE", help="PNG of the last frame")
    options = parser.parse_args()

    references = {pathlib.Path(file).stem: read_pc2(file) for file in options.references}
    start = next(iter(references.values()))[0]
    options.first = round(start) if options.start_frame is None else options.start_frame
    player = player_of(options.cache, options)
    tolerance = player.tolerance if options.tolerance is None else options.tolerance
    is_equal = True
    for name, (_, expected) in references.items():
        worst, at = largest_difference(player, name, expected, options)
        speed = velocity_difference(player, expected, options)
        is_equal = is_equal and worst <= tolerance and (speed is None or speed <= tolerance * options.fps)
        print(f"{options.cache}: {name}: {len(expected)} frames, {expected.shape[1]} points"
              f"{describe(player.item(name))}; largest difference {worst:.3g} m"
              + (f" at frame {at[0]}, point {at[1]}" if worst != 0 else "")
              + f", allowed {tolerance:.3g} m" + (f"; of velocities {speed:.3g} m/s" if speed is not None else ""))
    if options.render:
        name, (_, expected) = next(iter(references.items()))
        if player.item(name) is None:
            sys.exit(f"--render: {options.cache} is not played by Blender; leave it out")
        render(player, name, options.first + len(expected) - 1, options.render)
    return 0 if is_equal else 1


if __name__ == "__main__":
    sys.exit(main())
