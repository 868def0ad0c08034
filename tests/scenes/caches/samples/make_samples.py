"""Writes growing.abc beside this file, with the official library: pip install alembic3d

It is a triangle that is two triangles in its second sample: no body can play it.

slide and bend come from Blender: tests/dcc/bake_bodies.py.
"""

import pathlib

import imath
from alembic3d import Abc, AbcGeom, AbcCoreAbstract


def points(height):
    array = imath.V3fArray(4)
    for k, (x, z) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
        array[k] = imath.V3f(x, height, z)
    return array


def integers(values):
    array = imath.IntArray(len(values))
    for k, value in enumerate(values):
        array[k] = value
    return array


archive = Abc.OArchive(str(pathlib.Path(__file__).with_name("growing.abc")))
times = archive.addTimeSampling(AbcCoreAbstract.TimeSampling(1.0 / 24.0, 0.0))
mesh = AbcGeom.OPolyMesh(AbcGeom.OXform(archive.getTop(), "body"), "bodyShape", times)
for height, corners, counts in ((0, [2, 1, 0], [3]), (1, [2, 1, 0, 2, 3, 1], [3, 3])):
    sample = AbcGeom.OPolyMeshSchemaSample(points(height), integers(corners), integers(counts))
    mesh.getSchema().set(sample)
