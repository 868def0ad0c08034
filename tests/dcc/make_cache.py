#!/usr/bin/env python3
"""Writes small caches for comparisons: make_cache.py FOLDER [--columns 12] [--rows 9] [--frames 24]

skirt: quads and a row of triangles, with a seam in the texture and two groups; tee: quads. Each as OBJ and PC2, and
both together in outfit.abc, written by Alembic's own library where that is installed.
"""

import argparse
import pathlib

import numpy as np

from point_cache import write_pc2

FPS = 24.0


def grid(columns, rows):
    """Faces of a tube, quads but for the last row, and texture indices with a seam where it closes."""
    faces, textures = [], []
    for row in range(rows - 1):
        for column in range(columns):
            right = (column + 1) % columns
            low, high = row * columns, (row + 1) * columns
            face = [low + column, low + right, high + right, high + column]
            at = [row * (columns + 1) + column, row * (columns + 1) + column + 1,
                  (row + 1) * (columns + 1) + column + 1, (row + 1) * (columns + 1) + column]
            if row < rows - 2:
                faces.append(face), textures.append(at)
            else:
                faces += [face[:3], [face[0], face[2], face[3]]]
                textures += [at[:3], [at[0], at[2], at[3]]]
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows))
    return faces, textures, np.stack([u.ravel(), v.ravel()], axis=1)


def waves(columns, rows, frames, shift):
    """Positions [frames, points, 3] in metres: a tube whose waves travel around it while it turns, as floats are."""
    angle, height = np.meshgrid(np.linspace(0, 2 * np.pi, columns, endpoint=False), np.linspace(0, 0.6, rows))
    x = []
    for frame in range(frames):
        time = frame / FPS
        phase = 6 * time + np.sin(8 * height - 3 * time)
        radius = 0.3 + 0.2 * height + 0.1 * height * np.cos(5 * angle + phase) + 0.01 * np.sin(9 * height + 5 * time)
        turned = angle + 0.3 * np.sin(2 * time)
        x.append(np.stack([radius * np.cos(turned) + shift, 1.0 - height, radius * np.sin(turned)], axis=-1))
    return np.float32(np.reshape(x, (frames, -1, 3)))


def write_obj(file, x, faces, textures, uvs):
    lines = ["v " + " ".join(f"{c:.9g}" for c in p) for p in x]
    lines += ["vt " + " ".join(f"{c:.9g}" for c in p) for p in uvs]
    for k, (face, at) in enumerate(zip(faces, textures)):
        if k in (0, len(faces) // 2):
            lines.append("g front" if k == 0 else "g back panel")
        lines.append("f " + " ".join(f"{v + 1}/{t + 1}" for v, t in zip(face, at)))
    pathlib.Path(file).write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_outfit(file, meshes):
    """Meshes by name, each (positions, faces), as one archive with clockwise faces."""
    import imath
    from alembic3d import Abc, AbcCoreAbstract, AbcGeom

    def array(kind, values):
        made = kind(len(values))
        for k, value in enumerate(values):
            made[k] = value
        return made

    archive = Abc.OArchive(str(file))
    times = archive.addTimeSampling(AbcCoreAbstract.TimeSampling(1.0 / FPS, 0.0))
    for name, (positions, faces) in meshes.items():
        mesh = AbcGeom.OPolyMesh(AbcGeom.OXform(archive.getTop(), name), name + "Shape", times)
        corners = array(imath.IntArray, [v for face in faces for v in reversed(face)])
        counts = array(imath.IntArray, [len(face) for face in faces])
        for x in positions:
            points = array(imath.V3fArray, [imath.V3f(*(float(c) for c in p)) for p in x])
            mesh.getSchema().set(AbcGeom.OPolyMeshSchemaSample(points, corners, counts))


def main():
    parser = argparse.ArgumentParser(description="Write small caches for comparisons.")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--columns", type=int, default=12)
    parser.add_argument("--rows", type=int, default=9)
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--no-archive", action="store_true", help="no outfit.abc")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    meshes = {}
    for name, rows, shift in (("skirt", options.rows, 0.0), ("tee", options.rows + 2, 1.5)):
        faces, textures, uvs = grid(options.columns, rows)
        positions = waves(options.columns, rows, options.frames, shift)
        write_obj(options.folder / f"{name}.obj", positions[0], faces, textures, uvs)
        write_pc2(options.folder / f"{name}.pc2", positions)
        meshes[name] = (positions, faces)
    if not options.no_archive:
        write_outfit(options.folder / "outfit.abc", meshes)


if __name__ == "__main__":
    main()
