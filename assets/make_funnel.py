#!/usr/bin/env python3
"""Writes funnel.obj: a funnel with a wall two centimetres thick.

The outline below is turned about the Y axis. Metres, Y up, the spout ends at y = 0; closed, triangles
counter-clockwise seen from outside. Run it in this folder:  python3 make_funnel.py
"""

import math
from pathlib import Path

SEGMENTS = 48  # around the axis
EDGE = 0.03  # [m] length wanted along the outline
# (radius, height): down the inside, around the spout, up the outside.
CORNERS = [(0.32, 0.42), (0.055, 0.12), (0.05, 0.0), (0.07, 0.0), (0.075, 0.115), (0.335, 0.41)]


def outline():
    """The corners and points between them, closed."""
    points = []
    for (r0, y0), (r1, y1) in zip(CORNERS, CORNERS[1:] + CORNERS[:1]):
        count = max(1, int(math.hypot(r1 - r0, y1 - y0) / EDGE))
        points += [(r0 + (r1 - r0) * k / count, y0 + (y1 - y0) * k / count) for k in range(count)]
    return points


def turned(points):
    """Vertices and triangles (from 0) of the outline turned about Y."""
    vertices, triangles = [], []
    for s in range(SEGMENTS):
        angle = 2.0 * math.pi * s / SEGMENTS
        vertices += [(r * math.sin(angle), y, r * math.cos(angle)) for r, y in points]
    count = len(points)
    for s in range(SEGMENTS):
        here, there = s * count, (s + 1) % SEGMENTS * count
        for k in range(count):
            above, below = k, (k + 1) % count
            triangles += [(here + above, there + below, here + below), (here + above, there + above, there + below)]
    return vertices, triangles


def main():
    vertices, triangles = turned(outline())
    lines = ["# Funnel, metres, Y up. Written by make_funnel.py."]
    lines += ["v %.6g %.6g %.6g" % v for v in vertices]
    lines += ["f %d %d %d" % tuple(i + 1 for i in t) for t in triangles]
    Path(__file__).with_name("funnel.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
