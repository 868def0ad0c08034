"""Solids given by their distance functions, and surfaces of revolution. Metres, Y up.

A distance function maps points [..., 3] to the distance from the surface [m], negative inside. `contour` cuts it into
triangles, counter-clockwise seen from outside.
"""

import itertools
from typing import Callable, NamedTuple

import numpy as np
from scipy.ndimage import map_coordinates
from skimage.measure import marching_cubes

BLOCK = 32  # points along an edge of the blocks in which a distance function is evaluated


class Solid(NamedTuple):
    distance: Callable
    lower: tuple  # corners of a box that contains it
    upper: tuple
    detail: float = 0.01  # [m] points that far apart see its finest parts


def ellipsoid(p, centre, radii):
    """About the distance to an ellipsoid: exact on it and for spheres."""
    q = (p - centre) / radii
    size = np.linalg.norm(q, axis=-1)
    return size * (size - 1.0) / np.maximum(np.linalg.norm(q / radii, axis=-1), 1e-9)


def tube(p, points, radii):
    """Distance to a chain of capsules whose radius changes along it."""
    points = np.asarray(points, float)
    return np.minimum.reduce([capsule(p, *ends) for ends in zip(points, points[1:], radii, radii[1:])])


def capsule(p, a, b, radius_a, radius_b):
    t = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
    return np.linalg.norm(p - a - t[..., None] * (b - a), axis=-1) - (radius_a + t * (radius_b - radius_a))


def box(p, centre, size, rounding):
    """Distance to a box with rounded edges."""
    q = np.abs(p - centre) - 0.5 * np.asarray(size) + rounding
    return np.linalg.norm(np.maximum(q, 0.0), axis=-1) + np.minimum(q.max(axis=-1), 0.0) - rounding


def blended(a, b, width):
    """Smooth union."""
    h = np.clip(0.5 + 0.5 * (b - a) / width, 0.0, 1.0)
    return b + h * (a - b) - width * h * (1.0 - h)


def contour(solid, cell):
    """Vertices [n, 3] and triangles [m, 3] of the surface, cut on a grid with this distance of points [m]."""
    lower = np.asarray(solid.lower) - 2 * cell
    axes = [np.arange(a, b + 2 * cell, cell) for a, b in zip(lower, solid.upper)]
    grid = np.empty([len(axis) for axis in axes], np.float32)
    for corner in itertools.product(*(range(0, n, BLOCK) for n in grid.shape)):
        block = tuple(slice(i, i + BLOCK) for i in corner)
        spans = [axis[part] for axis, part in zip(axes, block)]
        middle = solid.distance(np.array([0.5 * (span[0] + span[-1]) for span in spans]))
        near = abs(middle) < BLOCK * cell * 3**0.5  # distances of blends are rough far from the surface
        grid[block] = solid.distance(np.stack(np.meshgrid(*spans, indexing="ij"), axis=-1)) if near else middle
    inner = grid[1:-1, 1:-1, 1:-1]
    assert (grid < 0).sum() == (inner < 0).sum(), "a solid that reaches out of its box has no closed surface"
    grid[np.abs(grid) < 1e-6 * cell] = 1e-6 * cell  # a surface through points of the grid has triangles without area
    vertices, faces, _, _ = marching_cubes(grid, 0.0, gradient_direction="descent")
    return evened(vertices.astype(float), faces, grid) * cell + lower, faces


def evened(vertices, faces, grid):
    """Moves vertices [in cells of the grid] towards the middle of their neighbours and back onto the surface."""
    edges = np.concatenate([faces[:, [k, (k + 1) % 3]] for k in range(3)])
    degree = np.bincount(edges[:, 0], minlength=len(vertices))[:, None]
    for _ in range(10):
        mean = np.zeros_like(vertices)
        np.add.at(mean, edges[:, 0], vertices[edges[:, 1]])
        vertices = mean / degree
        value = lambda shift: map_coordinates(grid, (vertices + shift).T, order=1)
        gradient = np.stack([value(h) - value(-h) for h in 0.5 * np.eye(3)], axis=-1)
        steps = value(0.0) / np.maximum((gradient**2).sum(axis=-1), 1e-12)
        vertices = vertices - np.clip(steps[:, None] * gradient, -1.0, 1.0)
    return vertices


def revolved(corners, edge):
    """Vertices and triangles of a closed outline about the Y axis.

    `corners` are (radius, height), with the solid on the left of their order; `edge` [m] is the length wanted.
    """
    outline = []
    for a, b in zip(np.array(corners, float), np.array(corners[1:] + corners[:1], float)):
        outline += [a + (b - a) * t for t in np.arange(0.0, 1.0, 1.0 / max(1, round(np.hypot(*(b - a)) / edge)))]
    radius, height = np.array(outline).T
    around = max(16, round(2 * np.pi * radius.max() / edge))
    angle = 2 * np.pi * np.arange(around)[:, None] / around
    vertices = np.stack([radius * np.sin(angle), height + 0 * angle, radius * np.cos(angle)], axis=-1).reshape(-1, 3)

    number = np.arange(around * len(outline)).reshape(around, -1)
    a, b = number, np.roll(number, -1, axis=0)
    below_a, below_b = np.roll(a, -1, axis=1), np.roll(b, -1, axis=1)
    faces = np.concatenate([np.stack([a, below_b, below_a], -1), np.stack([a, b, below_b], -1)], axis=1)
    return vertices, faces.reshape(-1, 3)


def spiral_steps(inner, outer, bottoms, tops, per_turn):
    """Vertices and triangles of flat steps that wind about the Y axis between two radii [m], in one piece.

    `tops` [m] are the heights of the steps, `bottoms` those of the underside where they begin and end.
    """
    vertices, number = [], {}
    for k, bottom in enumerate(bottoms):
        angle = 2 * np.pi * k / per_turn
        heights = {"bottom": bottom, "before": tops[max(k - 1, 0)], "after": tops[min(k, len(tops) - 1)]}
        for level, height in heights.items():
            for side, radius in (("in", inner), ("out", outer)):
                number[k, level, side] = len(vertices)
                vertices.append((radius * np.sin(angle), height, radius * np.cos(angle)))
    last = len(tops)
    for side in ("in", "out"):  # no riser before the first step and after the last
        number[0, "before", side] = number[0, "after", side]
        number[last, "after", side] = number[last, "before", side]

    faces = []

    def polygon(*corners):
        loop = [number[corner] for corner in corners]
        fan = [(loop[0], b, c) for b, c in zip(loop[1:], loop[2:])]
        faces.extend(face for face in fan if len(set(face)) == 3)

    for k in range(last):
        polygon((k, "after", "in"), (k, "after", "out"), (k + 1, "before", "out"), (k + 1, "before", "in"))
        polygon((k, "bottom", "out"), (k, "bottom", "in"), (k + 1, "bottom", "in"), (k + 1, "bottom", "out"))
        for side, order in (("in", -1), ("out", 1)):
            here = [(k, level, side) for level in ("after", "before", "bottom")]
            polygon((k + 1, "bottom", side), *[(k + 1, "before", side), *here][::order])
    for k in range(1, last):
        polygon((k, "before", "in"), (k, "before", "out"), (k, "after", "out"), (k, "after", "in"))
    polygon((0, "bottom", "in"), (0, "bottom", "out"), (0, "after", "out"), (0, "after", "in"))
    polygon((last, "bottom", "out"), (last, "bottom", "in"), (last, "before", "in"), (last, "before", "out"))
    used, faces = np.unique(faces, return_inverse=True)
    return np.array(vertices)[used], faces.reshape(-1, 3)


def open_box(size, wall):
    """Vertices and faces of a box without a lid about the Y axis, standing on y = 0; `size` [m] is its inside."""
    x, y, z = 0.5 * size[0], size[1], 0.5 * size[2]
    square = np.array([(-1, 1), (1, 1), (1, -1), (-1, -1)])  # counter-clockwise from above
    rings = [(x + wall, 0, z + wall), (x + wall, y + wall, z + wall), (x, y + wall, z), (x, wall, z)]
    vertices = [(i * a, h, k * b) for a, h, b in rings for i, k in square]
    faces = [(3, 2, 1, 0), (12, 13, 14, 15)]
    faces += [(r + k, r + (k + 1) % 4, r + (k + 1) % 4 + 4, r + k + 4) for r in (0, 4, 8) for k in range(4)]
    return np.array(vertices), faces
