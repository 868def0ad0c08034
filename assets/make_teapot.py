#!/usr/bin/env python3
"""Writes teapot.obj: a round pot with a lid, a knob, a spout and a handle, 42 cm from tip to handle.

A solid given by its distance function, blended where parts meet, and cut into triangles by marching cubes.
Metres, Y up, standing on y = 0; closed, triangles counter-clockwise seen from outside. Needs numpy, scipy and scikit-image.
Run it in this folder:  python3 make_teapot.py
"""

from pathlib import Path

import numpy as np
from skimage.measure import marching_cubes

from paper.solids import blended, ellipsoid, tube

CELL = 0.007  # [m] of the grid that the surface is cut on
BLEND = 0.012  # [m] over which parts run into each other
LOWER, UPPER = np.array([-0.26, -0.02, -0.15]), np.array([0.26, 0.28, 0.15])


def teapot(p):
    pot = ellipsoid(p, [0.0, 0.095, 0.0], np.array([0.125, 0.095, 0.125]))
    pot = np.maximum(pot, 0.004 - p[..., 1])  # stands on a flat foot
    pot = blended(pot, ellipsoid(p, [0.0, 0.185, 0.0], np.array([0.07, 0.02, 0.07])), BLEND)
    pot = blended(pot, ellipsoid(p, [0.0, 0.222, 0.0], np.array([0.017, 0.017, 0.017])), BLEND)
    spout = [(0.10, 0.07, 0.0), (0.16, 0.10, 0.0), (0.185, 0.15, 0.0), (0.215, 0.18, 0.0)]
    pot = blended(pot, tube(p, spout, [0.032, 0.024, 0.017, 0.015]), BLEND)
    angle = np.linspace(0.0, np.pi, 9)
    handle = [(-0.11 - 0.085 * np.sin(a), 0.10 + 0.055 * np.cos(a), 0.0) for a in angle]
    return blended(pot, tube(p, handle, [0.012] * len(handle)), BLEND)


def evened(vertices, faces):
    """Moves vertices towards the middle of their neighbours and back onto the surface: no slivers."""
    edges = np.concatenate([faces[:, [a, (a + 1) % 3]] for a in range(3)])
    degree = np.bincount(edges[:, 0], minlength=len(vertices))[:, None]
    for _ in range(20):
        mean = np.zeros_like(vertices)
        np.add.at(mean, edges[:, 0], vertices[edges[:, 1]])
        vertices = mean / degree
        steps = 1e-5 * np.eye(3)
        gradient = np.stack([teapot(vertices + h) - teapot(vertices - h) for h in steps], axis=-1) / 2e-5
        vertices -= (teapot(vertices) / (gradient**2).sum(axis=-1))[:, None] * gradient
    return vertices


def main():
    axes = [np.arange(lower, upper, CELL) for lower, upper in zip(LOWER, UPPER)]
    distance = teapot(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1))
    vertices, faces, _, _ = marching_cubes(distance, 0.0, spacing=(CELL,) * 3, gradient_direction="descent")
    vertices = evened(vertices + LOWER, faces)
    with open(Path(__file__).with_name("teapot.obj"), "w") as file:
        file.write("# made by make_teapot.py\n")
        for v in vertices:
            file.write("v %.5f %.5f %.5f\n" % tuple(v))
        for f in faces + 1:
            file.write("f %d %d %d\n" % tuple(f))


if __name__ == "__main__":
    main()
