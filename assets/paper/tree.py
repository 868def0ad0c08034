"""A tree: branches as a distance function, and leaves of tetrahedra that grow out of its surface. Metres, Y up."""

import itertools
import math
import random

import numpy as np
from scipy.sparse import csr_array

from solids import Solid, capsule

LOWEST_LEAF = 0.55  # [m]
LEAF_OF_CORNERS = [(0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5), (0, 3, 2, 6), (2, 3, 5, 6)]  # a ring about the edge 2 3


def segments_of(levels, thinnest=0.009):
    """Segments (a, b, radius at a, radius at b) of a tree 1.5 m tall that forks into three at each level."""
    rolls = random.Random(3)
    segments = []

    def grow(base, direction, length, radius, level):
        tip = base + length * direction
        segments.append((base, tip, radius, max(thinnest, 0.75 * radius)))
        if level == levels:
            return
        side = np.cross(direction, [0.31, 0.17, 0.93])
        side /= np.linalg.norm(side)
        turn = rolls.uniform(0, 2 * math.pi)
        for k in range(3):
            angle = turn + k * 2 * math.pi / 3
            spread = math.cos(angle) * side + math.sin(angle) * np.cross(direction, side)
            onwards = direction + rolls.uniform(0.6, 0.95) * spread + [0, 0.1, 0]
            grow(tip, onwards / np.linalg.norm(onwards), 0.72 * length, max(thinnest, 0.6 * radius), level + 1)

    grow(np.zeros(3), np.array([0.0, 1.0, 0.0]), 0.5, 0.05, 0)
    return segments


def branches(levels):
    """Trunk and branches with their feet on y = 0."""
    segments = segments_of(levels)
    ends = np.array([s[:2] for s in segments])

    def distance(p):
        # Only segments that can be nearest to one of the points.
        flat = p.reshape(-1, 3)
        middle = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
        reach = np.linalg.norm(flat - middle, axis=1).max()
        near = np.array([capsule(middle, *s) for s in segments])
        return np.minimum.reduce([capsule(p, *segments[k]) for k in np.flatnonzero(near <= near.min() + 2 * reach)])

    return Solid(distance, ends.min(axis=(0, 1)) - 0.05, ends.max(axis=(0, 1)) + 0.05, 0.006)


def leaf_on(a, b, c, length):
    """Four vertices of a leaf on the triangle a, b, c: above c, one side, tip, other side; and its middle."""
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    side = (b - a) / np.linalg.norm(b - a)
    onwards = np.cross(normal, side) + 1.2 * normal
    onwards *= length / np.linalg.norm(onwards)
    half, middle = 0.28 * length * side, c + 0.5 * onwards
    return np.array([c + 0.1 * length * normal, middle + half, c + onwards, middle - half]), middle


def edges_of(points, cells):
    """From the first corner of tetrahedra to the others [m, 3, 3]."""
    cells = np.asarray(cells)
    return points[cells[:, 1:]] - points[cells[:, :1]]


def with_leaves(vertices, tetrahedra, distance, count, length):
    """The tree and `count` leaves of this length [m], none of which touches another or a branch.

    A leaf is five tetrahedra on a triangle of the bark, about an edge that stands on one of its corners.
    """
    outside = np.concatenate([tetrahedra[:, f] for f in ([0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3])])
    _, first, times = np.unique(np.sort(outside, axis=1), axis=0, return_index=True, return_counts=True)
    bark = outside[first[times == 1]]

    edges = np.concatenate([bark[:, [k, (k + 1) % 3]] for k in range(3)])
    neighbours = csr_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=2 * [len(vertices)])
    rings = np.split(neighbours.indices, neighbours.indptr[1:-1])

    middles = {}  # of leaves, by cells of a grid as wide as a leaf is long
    points, cells = [vertices], [tetrahedra]
    for face in random.Random(5).sample(range(len(bark)), len(bark)):
        if count == 0:
            break
        leaf, middle = leaf_on(*vertices[bark[face]], length)
        cell = np.floor(middle / length).astype(int)
        cells_around = [tuple(cell + shift) for shift in itertools.product((-1, 0, 1), repeat=3)]
        others = [other for key in cells_around for other in middles.get(key, ())]
        close = any(np.linalg.norm(middle - other) < length for other in others)
        # The bark about the triangle bends away from the leaf, and the rest of the tree is not near.
        a, b, c = vertices[bark[face]]
        around = vertices[np.concatenate([rings[v] for v in bark[face]])]
        normal = np.cross(b - a, c - a)
        rises = ((around - a) @ normal).max() > 0.02 * np.linalg.norm(b - a) * np.linalg.norm(normal)
        small = np.linalg.norm(normal) < (0.15 * length) ** 2
        edges = edges_of(np.concatenate([vertices[bark[face]], leaf]), LEAF_OF_CORNERS)
        overlaps = np.linalg.det(edges).min() <= 0
        if small or close or rises or overlaps or middle[1] < LOWEST_LEAF or distance(leaf[1:]).min() < 0.2 * length:
            continue
        middles.setdefault(tuple(cell), []).append(middle)
        first_vertex = len(vertices) + 4 * (len(points) - 1)
        cells.append(np.concatenate([bark[face], first_vertex + np.arange(4)])[LEAF_OF_CORNERS])
        points.append(leaf)
        count -= 1
    if count:
        raise SystemExit(f"tree: no place for {count} of the leaves; give fewer by --count")
    points, cells = np.concatenate(points), np.concatenate(cells)
    return points, cells
