#!/usr/bin/env python3
"""Makes the volumetric scenes of "Multilevel quadrature for projective dynamics", from shapes of our own.

    python3 make_scene.py letters out/letters --size small

writes out/letters/letters.json and the meshes it names. Needs numpy, scipy, scikit-image and matplotlib, and `toile`
to fill surfaces with tetrahedra. See docs/guide/paper_scenes.md.
"""

import argparse
import itertools
import math
import random
import shutil
import sys

import numpy as np
from scipy.spatial.transform import Rotation

import bodies
from scene_folder import SceneFolder, read_tetrahedra
from solids import Solid, box, contour, open_box, revolved, spiral_steps, tube
from tree import branches, with_leaves

RED, ORANGE, GREEN = [0.75, 0.25, 0.2], [0.85, 0.6, 0.2], [0.35, 0.55, 0.3]
COLORS = [RED, ORANGE, GREEN, [0.2, 0.5, 0.6], [0.35, 0.35, 0.65], [0.65, 0.35, 0.55]]
GLASS, METAL = [0.75, 0.82, 0.85], [0.5, 0.5, 0.55]
FLOOR = {"name": "floor", "plane": {}}
STEPS_120 = {"fps": 30, "solver": {"substeps": 4}}  # the paper's time steps: 1/120 s, and 1/100 s for ships and tree
STEPS_100 = {"fps": 25, "solver": {"substeps": 4}}


def layers(count, columns, pitch, bottom):
    """`count` places in layers of columns x columns, from below; pitch [m] sideways and upwards."""
    half = 0.5 * (columns - 1)
    for i in range(count):
        row, column = divmod(i % columns**2, columns)
        yield [(column - half) * pitch[0], bottom + i // columns**2 * pitch[1], (row - half) * pitch[0]]


def soft_bodies(name, files, places, rotations, **material):
    """Soft bodies of one material, in six colours."""
    for i, (file, place, rotation) in enumerate(zip(files, places, rotations)):
        placed = {"translate": place, "rotate_deg": rotation, "color": COLORS[i % 6]}
        yield {"name": f"{name}_{i:02}", "file": file, **placed, **material}


def animals(folder, count, places, young):
    files = [folder.body(f"animal_{i % 6}", bodies.animal(i % 6)) for i in range(count)]
    rotations = [[0, 75 * i, 0] for i in range(count)]
    return [*soft_bodies("animal", files, places, rotations, young=young, poisson=0.4, density=300)]


def glass(name, file, friction=0.1):
    return {"name": name, "file": file, "friction": friction, "color": GLASS}


def letters(folder, count, young=3e4):
    """Figure 14: the letters of two words fall into a bowl."""
    quarter = [math.pi / 2 * k / 12 for k in range(13)]
    inside = [(0.26 * math.cos(a) + 1e-3, 0.28 - 0.26 * math.sin(a)) for a in quarter]
    outside = [(0.28 * math.sin(a) + 1e-3, 0.28 - 0.28 * math.cos(a)) for a in quarter]
    bowl = folder.surface("bowl", *revolved(inside + outside, 0.02))
    files = [folder.body(c, bodies.letter(c)) for c in itertools.islice(itertools.cycle("AWESOMESIMULATION"), count)]
    rolls = random.Random(1)
    rotations = [[rolls.uniform(-105, -75), rolls.uniform(0, 360), 0] for _ in range(count)]
    places = layers(count, 2, (0.17, 0.11), 0.22)
    return {
        "name": "Letters in a bowl",
        "frames": 60,
        **STEPS_120,
        "avatars": [glass("bowl", bowl, friction=0.3)],
        "soft_bodies": [*soft_bodies("letter", files, places, rotations, young=young, poisson=0.4, density=300)],
        "render": {"azimuth_deg": 30, "elevation_deg": 45, "zoom": 1.4},
    }


def stiff_letters(folder, count):
    """Figure 14, upper row: letters 20 times stiffer."""
    return letters(folder, count, young=6e5)


def ships(folder, count):
    """Figures 16 and 17: ships slide down a spiral staircase."""
    per_turn, rise, apart = 28, 0.06, 5  # steps in a turn, their height [m], steps from ship to ship
    steps = 24 + apart * count
    slope = rise * np.arange(steps + 1)
    top = slope[-1] + 0.3
    stairs = {
        "stairs": spiral_steps(0.2, 0.7, slope, slope[:-1] + 0.1, per_turn),
        "rail": spiral_steps(0.71, 0.74, slope, slope[:-1] + 0.25, per_turn),
        "pillar": revolved([(0.19, top), (1e-3, top), (1e-3, 0.0), (0.19, 0.0)], 0.05),
    }
    angles = 2 * math.pi / per_turn * (steps - 4 - apart * np.arange(count))
    heights = rise * angles * per_turn / (2 * math.pi) + 0.2
    places = np.stack([0.45 * np.sin(angles), heights, 0.45 * np.cos(angles)], axis=-1).tolist()
    downhill = [[-30, 180 + math.degrees(angle)] for angle in angles]  # bow down, then along the stairs
    rotations = Rotation.from_euler("zy", downhill, degrees=True).as_euler("xyz", degrees=True).tolist()
    files = [folder.body("ship", bodies.boat())] * count
    return {
        "name": "Ships on a spiral staircase",
        "frames": 75,
        **STEPS_100,
        "avatars": [FLOOR] + [glass(part, folder.surface(part, *mesh), friction=0.05) for part, mesh in stairs.items()],
        "soft_bodies": [*soft_bodies("ship", files, places, rotations, young=1e6, poisson=0.3, density=300)],
        "render": {"azimuth_deg": -40, "elevation_deg": 30},
    }


def funnel(folder, count):
    """Figure 21, with a cone for its disk: a plunger pushes animals through a funnel."""
    spout, neck, shoulder, top = 0.36, 0.4, 0.57, 0.72 + 0.24 * count  # heights [m]
    wall = [(0.14, top), (0.14, shoulder), (0.062, neck), (0.062, spout)]
    outline = wall + [(r + 0.02, y) for r, y in reversed(wall)]
    plunger = [(0.135, 0.21), (1e-3, 0.21), (1e-3, 0.0), (0.045, 0.0), (0.135, 0.19)]
    down = [(0.7, 0.0), (1.3, 0.97 - top), (3.2, 0.4 - top)]
    return {
        "name": "Animals through a funnel",
        "frames": 105,
        **STEPS_120,
        "avatars": [
            FLOOR,
            glass("funnel", folder.surface("funnel", *revolved(outline, 0.03))),
            {"name": "plunger", "file": folder.surface("plunger", *revolved(plunger, 0.03)), "friction": 0.1,
             "color": METAL, "translate": [0, top, 0],
             "keyframes": [{"time": t, "translate": [0, y, 0]} for t, y in down]},
        ],
        "soft_bodies": animals(folder, count, layers(count, 1, (0.0, 0.24), 0.61), young=4e4),
        "render": {"azimuth_deg": 30, "elevation_deg": 10},
    }


def tree(folder, count):
    """Figure 1: a tree with `count` leaves whose foot is shaken."""
    levels, leaf = (3, 0.06) if folder.cell > 0.02 else (5, 0.03)
    bare = branches(levels)
    points, cells = read_tetrahedra(folder.path / folder.body("branches", bare))
    file = folder.tetrahedra("tree", *with_leaves(points, cells, bare.distance, count, leaf))
    foot = {"box": {"lower": [-1, -1, -1], "upper": [1, 0.02, 1]}}
    shake = [(0.0, 0.0), (0.3, 0.12), (0.6, -0.12), (0.9, 0.12), (1.2, 0.0)]
    keyframes = [{"time": time, "translate": [x, 0, 0]} for time, x in shake]
    return {
        "name": "Tree in leaf",
        "frames": 75,
        **STEPS_100,
        "soft_bodies": [{"name": "tree", "file": file, "young": 1e7, "poisson": 0.3, "density": 400, "color": GREEN}],
        "attachments": [{"cloth": "tree", "select": foot, "keyframes": keyframes}],
        "render": {"azimuth_deg": 20, "elevation_deg": 15},
    }


def octopi(folder, count):
    """Figure 12: octopi drop onto a soft slide that is held at its ends."""

    def slide(p):
        x, y, z = np.moveaxis(p, -1, 0)
        height = 0.1 + 0.5 * (0.5 - x) ** 2 + 0.5 * np.maximum(np.abs(z) - 0.15, 0)
        sheet = np.abs(y - height) / np.sqrt(1 + (0.5 - x) ** 2) - 0.022
        return np.maximum.reduce([sheet, np.abs(x) - 0.5, np.abs(z) - 0.22])

    slide_file = folder.body("slide", Solid(slide, (-0.5, 0, -0.22), (0.5, 0.7, 0.22)))
    ends = [{"box": {"lower": [x, 0, -1], "upper": [x + 0.1, 1, 1]}} for x in (-0.57, 0.47)]
    places = [[-0.3 + 0.05 * i, 0.55 + 0.25 * i, 0.03 * (i % 3 - 1)] for i in range(count)]
    rotations = [[0, 40 * i, 0] for i in range(count)]
    files = [folder.body("octopus", bodies.octopus())] * count
    return {
        "name": "Octopi on a soft slide",
        "frames": 50,
        **STEPS_120,
        "avatars": [FLOOR],
        "soft_bodies": [
            {**glass("slide", slide_file), "young": 2e5, "density": 200, "damping": 1},
            *soft_bodies("octopus", files, places, rotations, young=3e4, poisson=0.4, density=300),
        ],
        "attachments": [{"cloth": "slide", "select": end} for end in ends],
        "render": {"azimuth_deg": 20, "elevation_deg": 20},
    }


def blender(folder, count):
    """Figure 15: blades stir animals in a jar."""

    def rotor(p):
        body = tube(p, [(0, 0, 0), (0, 0.08, 0)], [0.03, 0.03])
        for k in range(4):
            blade = Rotation.from_euler("xy", [25, 90 * k], degrees=True).as_matrix()
            body = np.minimum(body, box((p - [0, 0.05, 0]) @ blade, [0.18, 0, 0], [0.32, 0.025, 0.08], 0.01))
        return body

    blades = folder.surface("blades", *contour(Solid(rotor, (-0.35, -0.04, -0.35), (0.35, 0.12, 0.35)), 0.008))
    jar = [(0.42, 1.2), (0.42, 0.02), (1e-3, 0.02), (1e-3, 0.0), (0.44, 0.0), (0.44, 1.2)]
    return {
        "name": "Animals in a blender",
        "frames": 120,
        **STEPS_120,
        "avatars": [
            glass("jar", folder.surface("jar", *revolved(jar, 0.04))),
            {"name": "blades", "file": blades, "translate": [0, 0.08, 0], "friction": 0.1, "color": METAL,
             "keyframes": [{"time": 0.5}, {"time": 4.0, "rotate_deg": [0, 1890, 0]}]},
        ],
        "soft_bodies": animals(folder, count, layers(count, 3, (0.2, 0.24), 0.24), young=2e5),
        "render": {"azimuth_deg": 30, "elevation_deg": 50},
    }


def puffers(folder, count):
    """Figure 18: balls with bristles pile up in a glass box."""
    columns = 2 if count < 27 else 3
    side, height = 0.17 * columns + 0.02, 0.1 * math.ceil(count / columns**2) + 0.05
    walls = folder.surface("box", *open_box((side, height, side), 0.02))
    rolls = random.Random(2)
    rotations = [[rolls.uniform(0, 360) for _ in range(3)] for _ in range(count)]
    files = [folder.body("puffer", bodies.puffer(40))] * count
    places = layers(count, columns, (0.17, 0.18), 0.12)
    return {
        "name": "Puffer balls in a glass box",
        "frames": 60,
        **STEPS_120,
        "avatars": [glass("box", walls)],
        "soft_bodies": [*soft_bodies("puffer", files, places, rotations, young=5e4, poisson=0.4, density=200)],
        "render": {"azimuth_deg": 30, "elevation_deg": 50},
    }


# Scene: its function; edges of tetrahedra [m] and number of bodies (of leaves for the tree), small and full.
SCENES = {
    "letters": (letters, (0.03, 17), (0.0046, 17)),
    "stiff_letters": (stiff_letters, (0.03, 17), (0.0046, 17)),
    "ship": (ships, (0.05, 1), (0.0042, 1)),
    "ships": (ships, (0.05, 4), (0.0042, 20)),
    "funnel": (funnel, (0.03, 6), (0.0042, 6)),
    "tree": (tree, (0.03, 100), (0.007, 2000)),
    "octopi": (octopi, (0.04, 3), (0.01, 3)),
    "blender": (blender, (0.03, 36), (0.0084, 36)),
    "puffers": (puffers, (0.025, 8), (0.0045, 50)),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", choices=SCENES)
    parser.add_argument("folder", help="where the scene is written")
    parser.add_argument("--size", choices=["small", "full"], default="small", help="full: the paper's")
    parser.add_argument("--count", type=int, help="bodies, or leaves of the tree; by default those of the size")
    parser.add_argument("--toile", default=shutil.which("toile"), help="the program; by default that of the PATH")
    options = parser.parse_args()
    if not options.toile:
        sys.exit("make_scene.py: there is no toile in the PATH; name it by --toile")
    make, small, full = SCENES[options.scene]
    cell, count = small if options.size == "small" else full
    folder = SceneFolder(options.folder, cell, options.toile)
    folder.write(options.scene, make(folder, options.count or count))


if __name__ == "__main__":
    main()
