"""Bodies of the paper's scenes as distance functions: letters, octopus, boat, puffer ball, animals. Metres, Y up."""

import numpy as np
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from solids import Solid, blended, box, capsule, ellipsoid, tube


def letter(character, height=0.12, depth=0.045, rounding=0.008):
    """A capital of DejaVu Sans Bold, the font that comes with matplotlib, standing in the plane of X and Y."""
    font = FontProperties(family="DejaVu Sans", weight="bold")
    loops = TextPath((0, 0), character, size=height / 0.729, prop=font).to_polygons()
    a = np.concatenate([loop[:-1] for loop in loops])
    b = np.concatenate([loop[1:] for loop in loops])
    corner = 0.5 * (a.min(axis=0) + a.max(axis=0))
    a, b = a - corner, b - corner

    def distance(p):
        q = p[..., None, :2]
        t = np.clip(((q - a) * (b - a)).sum(-1) / ((b - a) ** 2).sum(-1), 0.0, 1.0)
        flat = np.linalg.norm(q - a - t[..., None] * (b - a), axis=-1).min(-1)
        rises = (a[:, 1] > q[..., 1]) != (b[:, 1] > q[..., 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            left_of = q[..., 0] < a[:, 0] + (q[..., 1] - a[:, 1]) / (b - a)[:, 1] * (b - a)[:, 0]
        flat = np.where((rises & left_of).sum(-1) % 2 == 1, -flat, flat)
        w = np.stack([flat, np.abs(p[..., 2]) - 0.5 * depth], axis=-1) + rounding
        return np.linalg.norm(np.maximum(w, 0.0), axis=-1) + np.minimum(w.max(-1), 0.0) - rounding

    return Solid(distance, (*a.min(axis=0), -0.5 * depth), (*a.max(axis=0), 0.5 * depth), 0.008)


def octopus():
    """A head on eight curling arms, 28 cm across."""

    def distance(p):
        body = ellipsoid(p, [0, 0.11, 0], np.array([0.055, 0.065, 0.055]))
        for k in range(8):
            angle = np.pi * (k + 0.5) / 4
            outwards = np.array([np.cos(angle), 0, np.sin(angle)])
            arm = [r * outwards + [0, y, 0] for r, y in [(0.02, 0.07), (0.06, 0.035), (0.10, 0.018), (0.135, 0.03)]]
            body = blended(body, tube(p, arm, [0.02, 0.016, 0.012, 0.008]), 0.012)
        return body

    return Solid(distance, (-0.15, 0, -0.15), (0.15, 0.18, 0.15), 0.005)


def boat():
    """A steamer 40 cm long, bow towards +X."""

    def distance(p):
        x, y = p[..., 0], p[..., 1]
        hull = ellipsoid(p, [0, 0.10, 0], np.array([0.22, 0.10, 0.085]))
        hull = np.maximum(hull, y - 0.075 - 0.8 * x**2)  # the deck rises towards bow and stern
        hull = np.maximum(hull, 0.012 - y)  # a flat bottom
        body = np.minimum(hull, box(p, [-0.02, 0.095, 0], [0.16, 0.06, 0.07], 0.008))
        body = np.minimum(body, box(p, [0.02, 0.13, 0], [0.07, 0.05, 0.055], 0.008))
        chimney = capsule(p, np.array([-0.055, 0.09, 0]), np.array([-0.06, 0.17, 0]), 0.019, 0.016)
        return blended(body, chimney, 0.006)

    return Solid(distance, (-0.22, 0, -0.09), (0.22, 0.2, 0.09), 0.008)


def puffer(bristles, radius=0.05, length=0.03, thickness=0.0055):
    """A ball with straight bristles, evenly about it."""
    k = np.arange(bristles) + 0.5
    height, angle = 1 - 2 * k / bristles, np.pi * (1 + 5**0.5) * k
    out = np.stack([np.sqrt(1 - height**2) * np.cos(angle), height, np.sqrt(1 - height**2) * np.sin(angle)], axis=-1)

    def distance(p):
        nearest = np.argmax(p @ out.T, axis=-1)
        axis = out[nearest]
        along = np.clip((p * axis).sum(-1), 0, radius + length)
        bristle = np.linalg.norm(p - along[..., None] * axis, axis=-1) - thickness
        return blended(np.linalg.norm(p, axis=-1) - radius, bristle, 0.006)

    reach = radius + length + thickness
    return Solid(distance, (-reach,) * 3, (reach,) * 3, 0.5 * thickness)


def animal(kind):
    """One of six toy animals that sit, about 16 cm tall, facing +Z."""
    ear, snout, tail, slim = [
        ([(0.03, 0.135, 0), (0.038, 0.15, 0)], 0.020, 0.02, 1.0),  # bear
        ([(0.018, 0.14, 0), (0.028, 0.20, -0.01)], 0.012, 0.02, 0.9),  # rabbit
        ([(0.03, 0.13, 0), (0.04, 0.165, 0)], 0.010, 0.07, 0.85),  # cat
        ([(0.035, 0.13, 0), (0.055, 0.095, 0.01)], 0.030, 0.05, 0.95),  # dog
        ([(0.02, 0.135, 0), (0.05, 0.15, 0)], 0.035, 0.03, 1.1),  # pig
        ([(0.012, 0.145, 0), (0.016, 0.16, 0.01)], 0.008, 0.04, 1.15),  # chick
    ][kind]

    def distance(p):
        q = np.stack([np.abs(p[..., 0]), p[..., 1], p[..., 2]], axis=-1)  # both sides at once
        body = ellipsoid(q, [0, 0.05, 0], np.array([0.045, 0.05, 0.042]) * slim)
        body = blended(body, ellipsoid(q, [0, 0.115, 0.005], np.array([0.038, 0.035, 0.036])), 0.012)
        body = blended(body, tube(q, ear, [0.013, 0.009]), 0.008)
        body = blended(body, tube(q, [(0, 0.108, 0.03), (0, 0.104, 0.035 + snout)], [0.015, 0.012]), 0.008)
        body = blended(body, tube(q, [(0.03, 0.075, 0.01), (0.055, 0.05, 0.045)], [0.016, 0.014]), 0.01)
        body = blended(body, tube(q, [(0.025, 0.02, 0.02), (0.04, 0.016, 0.065)], [0.02, 0.016]), 0.01)
        return blended(body, tube(q, [(0, 0.03, -0.03), (0, 0.035, -0.04 - tail)], [0.014, 0.01]), 0.008)

    return Solid(distance, (-0.09, -0.02, -0.13), (0.09, 0.22, 0.11), 0.006)
