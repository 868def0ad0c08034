#!/usr/bin/env python3
"""Writes painted_sheet.obj: a flat sheet whose red vertex colour rises from 0 on the left to 1 on the right, as u^3.

Metres, Y up, at y = 0; triangles face up. Run it in this folder:  python3 make_painted_sheet.py
"""

from pathlib import Path

WIDTH, DEPTH = 0.6, 0.2  # along X and Z
COLUMNS, ROWS = 48, 16


def main():
    lines = ["# Painted sheet, metres, Y up. Written by make_painted_sheet.py."]
    for j in range(ROWS + 1):
        for i in range(COLUMNS + 1):
            u = i / COLUMNS
            lines.append("v %.6g 0 %.6g %.6g 0.4 0.4" % (WIDTH * (u - 0.5), DEPTH * j / ROWS, u**3))
    for j in range(ROWS + 1):
        for i in range(COLUMNS + 1):
            lines.append("vt %.6g %.6g" % (WIDTH * i / COLUMNS, -DEPTH * j / ROWS))
    for j in range(ROWS):
        for i in range(COLUMNS):
            a = j * (COLUMNS + 1) + i + 1
            b, d = a + 1, a + COLUMNS + 1
            c = d + 1
            halves = [(a, d, c), (a, c, b)] if (i + j) % 2 == 0 else [(a, d, b), (b, d, c)]
            lines += ["f " + " ".join("%d/%d" % (v, v) for v in half) for half in halves]
    Path(__file__).with_name("painted_sheet.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
