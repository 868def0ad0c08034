#!/usr/bin/env python3
"""Writes tube_dress.obj: a strapless dress around the trunk of the built-in mannequin in its bind pose.

Rings of superellipses, each a little wider than the trunk there, joined by triangles that are counter-clockwise seen
from outside. Metres, Y up. Run it in this folder: python3 make_tube_dress.py
"""

import math
from pathlib import Path

# Height, half width, back (negative) and front [m].
RINGS = (
    (1.25, 0.152, -0.107, 0.130),
    (1.20, 0.142, -0.100, 0.112),
    (1.13, 0.132, -0.090, 0.094),
    (1.06, 0.145, -0.092, 0.098),
    (1.00, 0.168, -0.104, 0.108),
    (0.95, 0.184, -0.128, 0.113),
    (0.89, 0.192, -0.143, 0.118),
    (0.75, 0.235, -0.180, 0.160),
    (0.50, 0.310, -0.250, 0.240),
)
ROUNDNESS = 2.4  # exponent of the superellipse: 2 an ellipse, large a rectangle
ROW = 0.022  # height of a row of triangles
COLUMNS = 72


def section(y):
    """Half width, back and front at a height: linear between the rings."""
    for (y1, *upper), (y0, *lower) in zip(RINGS, RINGS[1:]):
        if y >= y0:
            t = (y - y0) / (y1 - y0)
            return [b + t * (a - b) for a, b in zip(upper, lower)]
    return RINGS[-1][1:]


def point(y, angle):
    width, back, front = section(y)
    c, s = math.cos(angle), math.sin(angle)
    norm = (abs(c) ** ROUNDNESS + abs(s) ** ROUNDNESS) ** (1 / ROUNDNESS)
    return width * c / norm, y, 0.5 * (front + back) + 0.5 * (front - back) * s / norm


def main():
    top, hem = RINGS[0][0], RINGS[-1][0]
    rows = round((top - hem) / ROW)
    lines = []
    for row in range(rows + 1):
        y = top + (hem - top) * row / rows
        for column in range(COLUMNS):
            shift = 0.5 * (row % 2)
            x, y, z = point(y, 2 * math.pi * (column + shift) / COLUMNS)
            lines.append(f"v {x:.5f} {y:.5f} {z:.5f}")
    for row in range(rows):
        for column in range(COLUMNS):
            a, b = (1 + row * COLUMNS + c % COLUMNS for c in (column, column + 1))
            c, d = a + COLUMNS, b + COLUMNS
            faces = ((a, b, c), (b, d, c)) if row % 2 == 0 else ((a, d, c), (a, b, d))
            lines += ["f {} {} {}".format(*face) for face in faces]
    Path("tube_dress.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
