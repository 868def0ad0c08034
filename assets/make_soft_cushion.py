#!/usr/bin/env python3
"""Writes soft_cushion.msh: a rounded cushion of tetrahedra.

A grid of cells, six tetrahedra each, pushed from a cube onto a superellipsoid. Metres, Y up, resting on y = 0. Run it
in this folder: python3 make_soft_cushion.py
"""

import itertools
from pathlib import Path

SIZE = (0.44, 0.16, 0.44)
CELLS = (10, 4, 10)
ROUNDNESS = 4  # exponent of the superellipsoid: 2 an ellipsoid, large a box


def place(index):
    p = [2 * i / n - 1 for i, n in zip(index, CELLS)]
    norm = sum(abs(c) ** ROUNDNESS for c in p) ** (1 / ROUNDNESS)
    scale = max(map(abs, p)) / norm if norm else 0
    x, y, z = (0.5 * size * scale * c for size, c in zip(SIZE, p))
    return x, y + 0.5 * SIZE[1], z


def number(index):
    return 1 + index[0] + (CELLS[0] + 1) * (index[1] + (CELLS[1] + 1) * index[2])


def tetrahedra(cell):
    """Paths along the axes, in each of their orders, from the corner with even indices to the opposite one."""
    first = [i + i % 2 for i in cell]
    last = [i + 1 - i % 2 for i in cell]
    for order in itertools.permutations(range(3)):
        corner = list(first)
        tet = [number(corner)]
        for axis in order:
            corner[axis] = last[axis]
            tet.append(number(corner))
        is_mirrored = (is_odd(order) + sum(cell)) % 2 == 1
        yield [tet[i] for i in (0, 1, 3, 2)] if is_mirrored else tet


def is_odd(order):
    return sum(order[i] > order[j] for i, j in itertools.combinations(range(3), 2)) % 2


def main():
    points = [place(i[::-1]) for i in itertools.product(*(range(n + 1) for n in reversed(CELLS)))]
    tets = [tet for cell in itertools.product(*map(range, CELLS)) for tet in tetrahedra(cell)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
    lines += [f"{i + 1} {x:.6g} {y:.6g} {z:.6g}" for i, (x, y, z) in enumerate(points)]
    lines += ["$EndNodes", "$Elements", str(len(tets))]
    lines += [f"{i + 1} 4 0 {' '.join(map(str, tet))}" for i, tet in enumerate(tets)]
    lines += ["$EndElements"]
    Path("soft_cushion.msh").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
