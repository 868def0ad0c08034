#!/usr/bin/env python3
"""Reads the attributes of caches by the libraries of their formats, and by Blender, and compares them with what they are.

    python3 tests/dcc/attributes.py build/bin/toile build/dcc/attributes

A sheet of two panels is held above a box, and stretched by 10 % within a second while the box sinks by 5 cm: strain
and gap are known at every frame. Alembic is read by alembic3d, USD by Pixar's library and Blender, VTU by VTK, PLY by
a few lines of Python. Prints a table, and exits with 1 if a comparison fails.
"""

import argparse
import contextlib
import json
import os
import pathlib
import re
import subprocess
import sys

import numpy as np

os.environ.setdefault("TOILE_PYTHON", sys.executable)

FRAMES, FPS = 61, 60  # more than one value clip
NAMES = ["left", "right"]
ALLOWED = 2e-6
SHEET = """v -0.1 0.21 0.1\nv 0.1 0.21 0.1\nv 0.1 0.21 -0.1\nv -0.1 0.21 -0.1
g left\nf 1 2 3\ng right\nf 1 3 4\n"""
ATTRIBUTES = ["strain", "gap", "panel"]


def held(lower, upper, **more):
    return {"cloth": "sheet", "select": {"box": {"lower": [lower, 0, -1], "upper": [upper, 0.3, 1]}}, **more}


def scene():
    archives = ["whole.abc", "whole.usda", "whole.usdc"]
    return {
        "toile": 1, "frames": FRAMES, "fps": FPS,
        "avatars": [{"name": "block", "box": {"size": [1, 0.2, 1]}, "translate": [0, 0.1, 0],
                     "keyframes": [{"time": 0}, {"time": 1, "translate": [0, -0.05, 0]}]}],
        "cloths": [{"name": "sheet", "file": "sheet.obj"}],
        "attachments": [held(-1, 0), held(0, 1, keyframes=[{"time": 0}, {"time": 1, "translate": [0.02, 0, 0]}])],
        "export": [{"file": name, "avatars": True, "start_frame": 1, "attributes": ATTRIBUTES} for name in archives]
        + [{"file": name, "attributes": ATTRIBUTES} for name in ("whole.ply", "whole.pvd")]}


def expected(frame):
    """Strain and gap of a frame, 0 the first."""
    return 0.1 * frame / (FRAMES - 1), 0.01 + 0.05 * frame / (FRAMES - 1)


class Check:
    """What is wrong with one file, and the largest difference."""

    def __init__(self):
        self.wrong, self.worst = [], 0.0

    def vertices(self, frame, strain, gap):
        for name, values, value in zip(("strain", "gap"), (strain, gap), expected(frame)):
            difference = np.abs(np.asarray(values, float) - value).max() if len(values) == 4 else np.inf
            self.worst = max(self.worst, difference)
            if not difference <= ALLOWED:
                self.wrong.append(f"{name} of frame {frame} is {list(values)}, not {value}")

    def same(self, what, found, right):
        if found != right:
            self.wrong.append(f"{what}: {found}, not {right}")


def alembic(file, check):
    from alembic3d import Abc, AbcGeom

    top = Abc.IArchive(str(file)).getTop()
    schema = AbcGeom.IPolyMesh(top.getChild("sheet"), "sheetShape").getSchema()
    values = schema.getArbGeomParams()
    check.same("parameters", sorted(values.getPropertyHeader(k).getName() for k in range(values.getNumProperties())),
               sorted(ATTRIBUTES))
    strain, gap = AbcGeom.IFloatGeomParam(values, "strain"), AbcGeom.IFloatGeomParam(values, "gap")
    panel = AbcGeom.IInt32GeomParam(values, "panel")
    check.same("scopes", [str(p.getScope()).rsplit(".", maxsplit=1)[-1] for p in (strain, gap, panel)],
               ["kVertexScope", "kVertexScope", "kUniformScope"])
    times = schema.getTimeSampling()
    for frame in range(FRAMES):
        at = Abc.ISampleSelector(times.getSampleTime(frame))
        check.vertices(frame, *(list(p.getExpandedValue(at).getVals()) for p in (strain, gap)))
    check.same("panel", list(panel.getExpandedValue().getVals()), [0, 1])
    check.same("names", panel.getHeader().getMetaData().get("toile_names"), ",".join(NAMES))
    block = AbcGeom.IPolyMesh(top.getChild("block"), "blockShape").getSchema()
    arb = block.getArbGeomParams()
    check.same("parameters of the box", arb.getNumProperties() if arb and arb.valid() else 0, 0)


def usd(file, check):
    from pxr import Usd, UsdGeom

    from usd_check import findings

    stage = Usd.Stage.Open(str(file))
    sheet = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/whole/sheet/sheetShape"))
    strain, gap, panel = (sheet.GetPrimvar(name) for name in ATTRIBUTES)
    check.same("interpolation", [p.GetInterpolation() for p in (strain, gap, panel)], ["vertex", "vertex", "uniform"])
    for frame in range(FRAMES):
        check.vertices(frame, strain.Get(1.0 + frame), gap.Get(1.0 + frame))
    check.same("panel", list(panel.Get()), [0, 1])
    check.same("names", list(panel.GetAttr().GetCustomData()["names"]), NAMES)
    block = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/whole/block/blockShape"))
    check.same("primvars of the box", [p.GetPrimvarName() for p in block.GetPrimvarsWithValues()], [])
    check.same("validators", findings(stage), [])
    for layer in stage.GetUsedLayers(True):
        if not layer.anonymous:
            check.same(f"validators of {layer.identifier}", findings(layer), [])


def blender(file, check):
    """As attributes of points and faces, as nodes and shaders see them."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    with quiet():
        bpy.ops.wm.usd_import(filepath=str(file.resolve()), set_frame_range=False)
    sheet = next(item for item in bpy.context.scene.objects if item.type == "MESH" and "sheet" in item.name)
    for frame in range(FRAMES):
        bpy.context.scene.frame_set(1 + frame)
        mesh = sheet.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        check.vertices(frame, *([value.value for value in mesh.attributes[name].data] for name in ("strain", "gap")))
    panel = mesh.attributes["panel"]
    check.same("domain", panel.domain, "FACE")
    check.same("panel", [value.value for value in panel.data], [0, 1])


def vtu(file, check):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    from players import Vtk

    vtk = Vtk(file, argparse.Namespace(fps=FPS, first=0))
    for frame in range(FRAMES):
        grid = vtk.grid(frame)
        check.vertices(frame, *(vtk_to_numpy(grid.GetPointData().GetArray(name)) for name in ("strain", "gap")))
        check.same("panel", list(vtk_to_numpy(grid.GetCellData().GetArray("panel"))), [0, 1])
        names = grid.GetFieldData().GetAbstractArray("panel_names")
        check.same("names", [names.GetValue(k) for k in range(names.GetNumberOfValues())], NAMES)


def ply(file, check):
    for frame in range(FRAMES):
        data = (file.parent / f"{file.stem}_{frame:04d}.ply").read_bytes()
        head, body = data.split(b"end_header\n", 1)
        names = re.findall(r"property float (\w+)", head.decode().split("element face")[0])
        values = np.frombuffer(body, "<f4", 4 * len(names)).reshape(4, -1)
        check.vertices(frame, *(values[:, names.index(name)] for name in ("strain", "gap")))
        faces = np.frombuffer(body[values.nbytes:], np.dtype([("n", "u1"), ("v", "<i4", 3), ("panel", "<i4")]))
        check.same("panel", list(faces["panel"]), [0, 1])
        check.same("names", re.findall(r"comment panel \d+ (.*)", head.decode()), NAMES)


def blender_ply(file, check):
    """Blender takes what it does not know of vertices as attributes of points, and no numbers of faces."""
    import bpy

    for frame in (0, FRAMES - 1):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        with quiet():
            bpy.ops.wm.ply_import(filepath=str((file.parent / f"{file.stem}_{frame:04d}.ply").resolve()))
        mesh = next(item for item in bpy.context.scene.objects if item.type == "MESH").data
        check.same("faces", len(mesh.polygons), 2)
        check.vertices(frame, *([value.value for value in mesh.attributes[name].data] for name in ("strain", "gap")))


@contextlib.contextmanager
def quiet():
    """Without what Blender prints."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


CHECKS = [("alembic3d", alembic, "whole.abc"), ("Pixar's library", usd, "whole.usda"),
          ("Pixar's library", usd, "whole.usdc"), ("Blender", blender, "whole.usda"), ("Blender", blender, "whole.usdc"),
          ("VTK", vtu, "whole.pvd"), ("Python", ply, "whole.ply"), ("Blender", blender_ply, "whole.ply")]


def main():
    parser = argparse.ArgumentParser(description="Compare attributes of caches, as other programs read them.")
    parser.add_argument("toile", help="the program")
    parser.add_argument("folder", type=pathlib.Path, help="for the caches")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    (options.folder / "sheet.obj").write_text(SHEET, encoding="utf-8")
    (options.folder / "scene.json").write_text(json.dumps(scene()), encoding="utf-8")
    subprocess.run([str(pathlib.Path(options.toile).resolve()), "simulate", "scene.json", "-o", ".", "--quiet"],
                   cwd=options.folder, check=True)
    failed = 0
    print("| cache | read by | result |\n|---|---|---|")
    for reader, run, name in CHECKS:
        check = Check()
        run(options.folder / name, check)
        failed += bool(check.wrong)
        said = "FAILED: " + "; ".join(check.wrong[:3]) if check.wrong else f"equal, to {check.worst:.1g}"
        print(f"| {name} | {reader} | {said} |", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
