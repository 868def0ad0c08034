#!/usr/bin/env python3
"""Writes cushion.obj: two squares of cloth sewn along their edges, slightly apart in the middle.

Texture coordinates are the flat squares in metres, so "rest": "uv", "uv_scale": 1 makes them the rest shape. Metres,
Y up, lying at y = 0; closed, triangles counter-clockwise seen from outside. Run it in this folder:
python3 make_cushion.py
"""

import math
from pathlib import Path

SIDE = 0.4  # of the squares
CELLS = 32  # along a side
RISE = 0.02  # of the middle of each square


def is_border(i, j):
    return i in (0, CELLS) or j in (0, CELLS)


def square(sign, vertices, number):
    """Vertex numbers [i][j] of the upper (1) or lower (-1) square; borders are shared."""
    numbers = []
    for i in range(CELLS + 1):
        row = []
        for j in range(CELLS + 1):
            key = (i, j, 0 if is_border(i, j) else sign)
            if key not in number:
                u, v = i / CELLS, j / CELLS
                height = RISE * math.sin(math.pi * u) * math.sin(math.pi * v)
                number[key] = len(vertices)
                vertices.append((SIDE * (u - 0.5), sign * height, SIDE * (0.5 - v)))
            row.append(number[key])
        numbers.append(row)
    return numbers


def faces(numbers, sign):
    """Triangles with diagonals in turn, as (vertex, texture coordinate) corners."""

    def corner(i, j):
        return numbers[i][j], i * (CELLS + 1) + j

    triangles = []
    for i in range(CELLS):
        for j in range(CELLS):
            a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
            halves = [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
            triangles += halves if sign > 0 else [half[::-1] for half in halves]
    return triangles


def main():
    vertices, number = [], {}
    upper, lower = square(1, vertices, number), square(-1, vertices, number)
    texture = [(SIDE * i / CELLS, SIDE * j / CELLS) for i in range(CELLS + 1) for j in range(CELLS + 1)]
    lines = ["# Cushion, metres, Y up. Written by make_cushion.py."]
    lines += ["v %.6g %.6g %.6g" % v for v in vertices]
    lines += ["vt %.6g %.6g" % t for t in texture]
    for name, triangles in (("upper", faces(upper, 1)), ("lower", faces(lower, -1))):
        lines.append("g " + name)
        lines += ["f " + " ".join("%d/%d" % (v + 1, t + 1) for v, t in half) for half in triangles]
    Path(__file__).with_name("cushion.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
