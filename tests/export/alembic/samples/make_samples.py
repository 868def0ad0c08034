"""Writes moving_quad.abc, moving_still.abc and irregular.abc beside this file with the official library: pip install alembic3d

moving_quad.abc: a quad and a triangle of five points under two transforms. The outer one moves by 1 m along X a
frame and is turned by 90 degrees about Z; the inner one is scaled by 2. Point k is at (k, frame, 0) in its own
frame.
Texture coordinates are stored per corner, without indices; the triangle is the face set "tip".
"""

import pathlib

import imath
from alembic3d import Abc, AbcGeom, AbcCoreAbstract

FRAMES, FPS, START = 4, 24.0, 10.0


def points(frame):
    array = imath.V3fArray(5)
    for k in range(5):
        array[k] = imath.V3f(k, frame, 0)
    return array


def integers(values):
    array = imath.IntArray(len(values))
    for k, value in enumerate(values):
        array[k] = value
    return array


def texture():
    array = imath.V2fArray(7)
    for k in range(7):
        array[k] = imath.V2f(k, 0.5 * k)
    return array


archive = Abc.OArchive(str(pathlib.Path(__file__).with_name("moving_quad.abc")))
times = archive.addTimeSampling(AbcCoreAbstract.TimeSampling(1.0 / FPS, START / FPS))
outer = AbcGeom.OXform(archive.getTop(), "outer", times)
inner = AbcGeom.OXform(outer, "inner")
mesh = AbcGeom.OPolyMesh(inner, "cloth", times)

inner_sample = AbcGeom.XformSample()
inner_sample.setScale(imath.V3d(2, 2, 2))
inner.getSchema().set(inner_sample)
for frame in range(FRAMES):
    outer_sample = AbcGeom.XformSample()
    outer_sample.setTranslation(imath.V3d(frame, 0, 0))
    outer_sample.setZRotation(90.0)
    outer.getSchema().set(outer_sample)
    sample = AbcGeom.OPolyMeshSchemaSample(points(frame), integers([3, 2, 1, 0, 4, 3, 0]), integers([4, 3]))
    if frame == 0:
        sample.setUVs(AbcGeom.OV2fGeomParamSample(texture(), AbcGeom.GeometryScope.kFacevaryingScope))
    mesh.getSchema().set(sample)
faces = mesh.getSchema().createFaceSet("tip")
faces.getSchema().set(AbcGeom.OFaceSetSchemaSample(integers([1])))

# A quad that does not deform, moved by 2 m along Y a frame: moving_still.abc.
archive = Abc.OArchive(str(pathlib.Path(__file__).with_name("moving_still.abc")))
times = archive.addTimeSampling(AbcCoreAbstract.TimeSampling(1.0 / FPS, 0.0))
mover = AbcGeom.OXform(archive.getTop(), "mover", times)
still = AbcGeom.OPolyMesh(mover, "quad")
still.getSchema().set(AbcGeom.OPolyMeshSchemaSample(points(0), integers([3, 2, 1, 0]), integers([4])))
for frame in range(FRAMES):
    sample = AbcGeom.XformSample()
    sample.setTranslation(imath.V3d(0, 2 * frame, 0))
    mover.getSchema().set(sample)

# A square that grows by 1 m along Y a sample, and moves along X, each at times of its own; and one with two samples a
# frame, of which the second follows after a quarter of it: irregular.abc.
POINT_TIMES, HEIGHTS = [0.1, 0.2, 0.7, 1.7], [1, 2, 3, 4]
MOVER_TIMES, PLACES = [0.0, 0.4, 1.0], [0, 4, 5]
ACYCLIC = AbcCoreAbstract.TimeSamplingType(AbcCoreAbstract.AcyclicFlag.kAcyclic)


def seconds(values):
    times = AbcCoreAbstract.TimeVector()
    times.extend(values)
    return times


def square(height):
    array = imath.V3fArray(4)
    for k, (x, y) in enumerate([(0, 0), (1, 0), (1, height), (0, height)]):
        array[k] = imath.V3f(x, y, 0)
    return array


def write_squares(parent, name, times, heights):
    mesh = AbcGeom.OPolyMesh(parent, name, times)
    for height in heights:
        mesh.getSchema().set(AbcGeom.OPolyMeshSchemaSample(square(height), integers([3, 2, 1, 0]), integers([4])))


archive = Abc.OArchive(str(pathlib.Path(__file__).with_name("irregular.abc")))
mover = AbcGeom.OXform(archive.getTop(), "mover",
                       archive.addTimeSampling(AbcCoreAbstract.TimeSampling(ACYCLIC, seconds(MOVER_TIMES))))
for x in PLACES:
    sample = AbcGeom.XformSample()
    sample.setTranslation(imath.V3d(x, 0, 0))
    mover.getSchema().set(sample)
write_squares(mover, "square",
              archive.addTimeSampling(AbcCoreAbstract.TimeSampling(ACYCLIC, seconds(POINT_TIMES))), HEIGHTS)
cycle = AbcCoreAbstract.TimeSamplingType(2, 1.0 / FPS)
write_squares(archive.getTop(), "shutter",
              archive.addTimeSampling(AbcCoreAbstract.TimeSampling(cycle, seconds([0.0, 0.25 / FPS]))), HEIGHTS)
