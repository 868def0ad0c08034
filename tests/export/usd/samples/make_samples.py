"""Writes moving_quad.usda, changing.usda, irregular.usda and turning.usda beside this file with Pixar's library: pip install usd-core

moving_quad.usda: a quad and a triangle of five points, clockwise, under two transforms, in millimetres with Z up and
30 frames a second. The outer transform moves by 1 unit along X a frame and is turned by 90 degrees about Z; the inner
one is scaled by 2. Point k is at (k, frame, 0) in its own frame; it has samples at every half frame from 10 to 13.
Texture coordinates are stored per point, without indices; the triangle is the subset "tip". A second mesh, "still",
does not move.

changing.usda: a triangle that becomes another one, and one that a skeleton moves.

irregular.usda: a square that grows by 1 m along Y a sample, at codes that are on no grid, of 24 a second.

turning.usda: a square of two samples, at code 1 and at one that is on no grid; it turns once meanwhile.
"""

import pathlib

from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel

FOLDER = pathlib.Path(__file__).parent


def new_stage(name, **info):
    path = str(FOLDER / name)
    pathlib.Path(path).unlink(missing_ok=True)
    stage = Usd.Stage.CreateNew(path)
    UsdGeom.SetStageMetersPerUnit(stage, info.get("metres", 1.0))
    UsdGeom.SetStageUpAxis(stage, info.get("up", "Y"))
    return stage


def points(frame):
    return [(k, frame, 0) for k in range(5)]


stage = new_stage("moving_quad.usda", metres=0.001, up="Z")
stage.SetTimeCodesPerSecond(30)
stage.SetStartTimeCode(10)
stage.SetEndTimeCode(13)
outer = UsdGeom.Xform.Define(stage, "/outer")
move, turn = outer.AddTranslateOp(), outer.AddRotateZOp()
turn.Set(90.0)
for frame in range(10, 14):
    move.Set(Gf.Vec3d(frame, 0, 0), frame)
UsdGeom.Xform.Define(stage, "/outer/inner").AddScaleOp().Set(Gf.Vec3f(2, 2, 2))
mesh = UsdGeom.Mesh.Define(stage, "/outer/inner/cloth")
for half in range(7):
    mesh.CreatePointsAttr().Set(points(10 + half / 2), 10 + half / 2)
mesh.CreateFaceVertexCountsAttr([4, 3])
mesh.CreateFaceVertexIndicesAttr([3, 2, 1, 0, 4, 3, 0])
mesh.CreateOrientationAttr("leftHanded")
texture = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, "vertex")
texture.Set([(k, 0.5 * k) for k in range(5)])
subset = UsdGeom.Subset.CreateGeomSubset(mesh, "tip", UsdGeom.Tokens.face, [1])
subset.GetPrim().SetDisplayName("sharp tip")
still = UsdGeom.Mesh.Define(stage, "/still")
still.CreatePointsAttr(points(0))
still.CreateFaceVertexCountsAttr([4])
still.CreateFaceVertexIndicesAttr([0, 1, 2, 3])
stage.Save()

stage = new_stage("changing.usda")
mesh = UsdGeom.Mesh.Define(stage, "/changing")
for frame in range(3):
    mesh.CreatePointsAttr().Set(points(frame), frame)
    mesh.CreateFaceVertexIndicesAttr().Set([0, 1, 2 + (frame > 1)], frame)
mesh.CreateFaceVertexCountsAttr([3])
skeleton = UsdSkel.Root.Define(stage, "/body")
UsdSkel.Skeleton.Define(stage, "/body/skeleton")
skin = UsdGeom.Mesh.Define(stage, "/body/skin")
skin.CreatePointsAttr(points(0))
skin.CreateFaceVertexCountsAttr([3])
skin.CreateFaceVertexIndicesAttr([0, 1, 2])
UsdSkel.BindingAPI.Apply(skin.GetPrim()).CreateSkeletonRel().SetTargets(["/body/skeleton"])
stage.Save()


def square_stage(name, codes):
    stage = new_stage(name)
    stage.SetTimeCodesPerSecond(24)
    mesh = UsdGeom.Mesh.Define(stage, "/square")
    for height, code in enumerate(codes, 1):
        mesh.CreatePointsAttr().Set([(0, 0, 0), (1, 0, 0), (1, height, 0), (0, height, 0)], code)
    mesh.CreateFaceVertexCountsAttr([4])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 3])
    return stage, mesh


square_stage("irregular.usda", [2.4, 4.8137, 16.8, 40.8])[0].Save()

stage, mesh = square_stage("turning.usda", [1, 25.0137])
turn = mesh.AddRotateZOp()
turn.Set(0.0, 1)
turn.Set(360.0, 25.0137)
stage.Save()
