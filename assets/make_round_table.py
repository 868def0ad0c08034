#!/usr/bin/env python3
"""Writes round_table.obj: a round table with a rounded rim, a turned column and a foot.

The outline below is turned about the Y axis. Metres, Y up, standing on y = 0; closed, triangles
counter-clockwise seen from outside. Run it in this folder:  python3 make_round_table.py
"""

import math
from pathlib import Path

SEGMENTS = 64  # around the axis
RIM_POINTS = 8  # on the half circle of the rim
TOP_RADIUS, TOP_HEIGHT, TOP_THICKNESS = 0.45, 0.74, 0.03


def outline():
    """(radius, height) from the axis on top, over the rim, down the column, to the axis below."""
    half = TOP_THICKNESS / 2
    top = [(r, TOP_HEIGHT) for r in (0.0, 0.10, 0.20, 0.30, 0.38, TOP_RADIUS - half)]
    rim = []
    for k in range(1, RIM_POINTS):
        angle = math.pi / 2 - math.pi * k / RIM_POINTS
        rim.append((TOP_RADIUS - half + half * math.cos(angle), TOP_HEIGHT - half + half * math.sin(angle)))
    below = TOP_HEIGHT - TOP_THICKNESS
    underside = [(TOP_RADIUS - half, below), (0.30, below), (0.15, below), (0.06, below)]
    column = [(0.045, 0.69), (0.040, 0.60), (0.035, 0.45), (0.040, 0.30), (0.050, 0.15), (0.070, 0.08)]
    foot = [(0.14, 0.045), (0.22, 0.030), (0.24, 0.015), (0.24, 0.0), (0.12, 0.0), (0.0, 0.0)]
    return top + rim + underside + column + foot


def turned(points):
    """Vertices and triangles (from 0) of the outline turned about Y; its ends lie on the axis."""
    rings = points[1:-1]
    vertices = [(0.0, points[0][1], 0.0)]
    for radius, height in rings:
        for s in range(SEGMENTS):
            angle = 2.0 * math.pi * s / SEGMENTS
            vertices.append((radius * math.sin(angle), height, radius * math.cos(angle)))
    vertices.append((0.0, points[-1][1], 0.0))

    def at(ring, s):
        return 1 + ring * SEGMENTS + s % SEGMENTS

    last = len(vertices) - 1
    triangles = []
    for s in range(SEGMENTS):
        triangles.append((0, at(0, s), at(0, s + 1)))
        for ring in range(len(rings) - 1):
            a, b = at(ring, s), at(ring, s + 1)
            c, d = at(ring + 1, s), at(ring + 1, s + 1)
            triangles += [(a, c, d), (a, d, b)]
        triangles.append((last, at(len(rings) - 1, s + 1), at(len(rings) - 1, s)))
    return vertices, triangles


def main():
    vertices, triangles = turned(outline())
    lines = ["# Round table, metres, Y up. Written by make_round_table.py."]
    lines += ["v %.6g %.6g %.6g" % v for v in vertices]
    lines += ["f %d %d %d" % tuple(i + 1 for i in t) for t in triangles]
    Path(__file__).with_name("round_table.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
