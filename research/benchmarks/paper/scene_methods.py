#!/usr/bin/env python3
"""Figures 11 and 12 in scenes of the paper: steps by each solver or preconditioner, on a CPU.

    scene_methods.py FIGURE SCENE.json --bench toile-bench [--frames 14] [-o FILE.csv]

Equal steps of implicit Euler by every method, from the scene's start. Errors are RMS distances of all surface
vertices to the same steps by Newton's method to 0.1 mm/s. Needs numpy.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[3] / "tests" / "dcc"))
from point_cache import read_pc2  # noqa: E402

REFERENCE = ("reference", {"outer": "newton", "velocity_tolerance": 1e-4, "max_iterations": 1000})
METHODS = {
    11: [(f"contact: {name}", {"outer": "lbfgs", "method": "quadrature", "contact_preconditioner": name})
         for name in ("block", "exact", "sherman-morrison", "chebyshev", "paper")],
    12: [("Newton (Toile)", {"outer": "newton"}),
         ("L-BFGS, quadrature (Toile)", {"outer": "lbfgs", "method": "quadrature"})] +
        [(f"local/global, {name}", {"outer": "local-global", "method": name})
         for name in ("direct", "quadrature", "chebyshev", "a-jacobi", "subspace")],
}
COLUMNS = ["figure", "scene", "method", "iterations", "PCG", "ms", "unfinished"]


def run(bench, scene, solver, frames):
    """Frames of the report, and positions [frames, all vertices, 3]."""
    source = json.loads(scene.read_text())
    source["frames"] = frames
    source["solver"] = {"substeps": source["solver"]["substeps"], "integrator": "implicit-euler", **solver}
    with tempfile.TemporaryDirectory() as folder:
        out, report = pathlib.Path(folder, "out"), pathlib.Path(folder, "report.json")
        with tempfile.NamedTemporaryFile("w", dir=scene.parent, suffix=".json") as changed:  # beside its meshes
            json.dump(source, changed)
            changed.flush()
            subprocess.run([bench, "simulate", changed.name, "-o", out, "--report", report, "--no-check", "--quiet"],
                           check=True, stdout=subprocess.DEVNULL)
        caches = [read_pc2(path)[1] for path in sorted(out.glob("*.pc2"))]
        return json.loads(report.read_text())["frames"], np.concatenate(caches, axis=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("figure", type=int, choices=METHODS)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--bench", default="build/bin/toile-bench")
    parser.add_argument("--frames", type=int, default=14)
    parser.add_argument("-o", "--output", type=pathlib.Path, help="CSV; rows of other figures stay")
    args = parser.parse_args()

    seen = [frame for frame in (4, 8) if frame < args.frames] + [args.frames - 1]
    columns = COLUMNS + [f"mm at {frame}" for frame in seen]
    kept = list(csv.reader(args.output.open())) if args.output and args.output.is_file() else [columns]
    if kept[0] != columns:
        sys.exit(f"error: {args.output}: has other columns; use the same --frames, or another file")
    print("| " + " | ".join(columns) + " |\n|" + "---|" * len(columns), flush=True)
    rows, exact = [], None
    for name, solver in [REFERENCE] + METHODS[args.figure]:
        frames, x = run(args.bench, args.scene, solver, args.frames)
        exact = x if exact is None else exact
        steps = sum(frame["steps"] for frame in frames)
        error = 1e3 * np.sqrt(((x - exact) ** 2).sum(axis=2).mean(axis=1))
        rows.append([args.figure, args.scene.stem, name,
                     *(f"{sum(frame[key] for frame in frames) / steps:.1f}" for key in ("iterations", "linear_iterations")),
                     f"{1e3 * sum(frame['seconds'] for frame in frames) / steps:.0f}",
                     sum(frame["status"] != "converged" for frame in frames),
                     *(f"{error[frame]:.2g}" for frame in seen)])
        print("| " + " | ".join(map(str, rows[-1])) + " |", flush=True)

    if args.output:
        kept = [row for row in kept if row[0] != str(args.figure)]
        with args.output.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(kept + rows)


if __name__ == "__main__":
    sys.exit(main())
