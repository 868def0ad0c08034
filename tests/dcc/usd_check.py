#!/usr/bin/env python3
"""Reads a USD cache with Pixar's library, compares it with a point cache of the same run, and validates it.

    python3 tests/dcc/usd_check.py skirt.usda skirt.pc2 [--mesh /skirt/skirt/skirtShape]

Needs usd-core: pip install usd-core. Every frame must have the same bits as the PC2, velocities must be differences
of positions, and all validators of pxr.UsdValidation must be content, with the stage and with each layer of value
clips. Without usd-core it says SKIPPED and exits with 77.
"""

import argparse
import pathlib
import struct
import sys

try:
    from pxr import Sdf, Usd, UsdGeom, UsdValidation
except ImportError:
    print("SKIPPED: usd-core is not installed (pip install usd-core)")
    sys.exit(77)


def read_pc2(file):
    """Number of points, and the bytes of each frame."""
    data = pathlib.Path(file).read_bytes()
    points, _, _, frames = struct.unpack_from("<iffi", data, 16)
    size = 12 * points
    return points, [data[32 + size * k:32 + size * (k + 1)] for k in range(frames)]


def floats(array):
    return struct.unpack(f"<{3 * len(array)}f", bytes(memoryview(array)))


def validators():
    return UsdValidation.ValidationRegistry().GetOrLoadAllValidators()


def findings(subject):
    """What the validators say of a stage or a layer."""
    if isinstance(subject, Sdf.Layer):
        errors = [error for validator in validators() for error in validator.Validate(subject)]
    else:
        errors = UsdValidation.ValidationContext(validators()).Validate(subject)
    return [f"{error.GetIdentifier()}: {error.GetMessage()}" for error in errors]


def compare(stage, mesh, frames, points):
    """Complaints about the frames of a mesh."""
    start, rate = stage.GetStartTimeCode(), stage.GetTimeCodesPerSecond()
    subframes = stage.GetRootLayer().customLayerData["toileSubframes"]
    said = []
    if round((stage.GetEndTimeCode() - start) * subframes) + 1 != len(frames):
        said.append(f"ends at time code {stage.GetEndTimeCode():g}, and has {len(frames)} frames")
    times = [start + k / subframes for k in range(len(frames))]
    for k, (time, expected) in enumerate(zip(times, frames)):
        x = mesh.GetPointsAttr().Get(time)
        if x is None or bytes(memoryview(x)) != expected:
            said.append(f"frame {k} differs")
            continue
        extent = mesh.GetExtentAttr().Get(time)
        if list(extent) != list(UsdGeom.PointBased.ComputeExtent(x)):
            said.append(f"frame {k} has another extent")
        velocities = mesh.GetVelocitiesAttr().Get(time)
        if velocities is None:
            continue
        before, after = max(k - 1, 0), min(k + 1, len(frames) - 1)
        seconds = max(after - before, 1) / (rate * subframes)
        a, b = (struct.unpack(f"<{3 * points}f", frames[at]) for at in (before, after))
        worst = max(abs(v - (y - x) / seconds) for v, x, y in zip(floats(velocities), a, b))
        if worst > 1e-4 * max(map(abs, b)) / seconds:
            said.append(f"frame {k} has velocities that differ by {worst:g}")
    middle = mesh.GetPointsAttr().Get((times[0] + times[-1]) / 2 + 0.25 / subframes)
    if len(middle) != points:
        said.append("has no points between frames")
    return said


def main():
    parser = argparse.ArgumentParser(description="Compare and validate a USD cache.")
    parser.add_argument("cache")
    parser.add_argument("reference", help="PC2 of the same frames")
    parser.add_argument("--mesh", help="path of one of several")
    options = parser.parse_args()

    stage = Usd.Stage.Open(options.cache)
    meshes = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)
              and options.mesh in (None, str(prim.GetPath()))]
    if len(meshes) != 1:
        sys.exit(f"{options.cache}: has {len(meshes)} meshes; name one with --mesh")
    points, frames = read_pc2(options.reference)
    said = compare(stage, UsdGeom.Mesh(meshes[0]), frames, points)
    said += findings(stage)
    layers = stage.GetUsedLayers(True)
    for layer in layers:
        if not layer.anonymous:
            said += [f"{layer.identifier}: {text}" for text in findings(layer)]
    print("\n".join(said) or f"{options.cache}: {len(frames)} frames of {points} points have the same bits; "
          f"{len(validators())} validators are content with the stage and {len(layers)} layers")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
