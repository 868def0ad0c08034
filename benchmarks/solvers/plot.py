#!/usr/bin/env python3
"""Error against milliseconds and against iterations, from the table of `toile bench solvers`.

    plot.py solvers.csv -o FOLDER      writes solvers_time.png/.svg and solvers_iterations.png/.svg

One panel per mesh, size, stiffness and time step; one line per method through its budgets.
"""

import argparse
import csv
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLUMNS = 4


def read_problems(file):
    """{(mesh, vertices, stiffness, dt): {method: [row, ...]}}"""
    problems = {}
    with open(file, newline="") as table:
        for row in csv.DictReader(table):
            key = row["mesh"], int(row["vertices"]), float(row["stiffness"]), float(row["dt"])
            method = row["method"].rsplit(" ", 1)[0]
            problems.setdefault(key, {}).setdefault(method, []).append(row)
    return problems


def draw(problems, quantity, label, target):
    rows = math.ceil(len(problems) / COLUMNS)
    figure, panels = plt.subplots(rows, COLUMNS, figsize=(5 * COLUMNS, 4 * rows), squeeze=False)
    for panel in panels.flat[len(problems):]:
        panel.axis("off")
    for panel, ((mesh, vertices, stiffness, dt), methods) in zip(panels.flat, problems.items()):
        for method, budgets in methods.items():
            points = sorted((float(row[quantity]), float(row["rms_over_edge"])) for row in budgets)
            style = ":" if method in ("vbd", "xpbd") else "-"
            panel.loglog(*zip(*points), style, marker="o", markersize=3, label=method)
        panel.set_title(f"{mesh} {vertices}, {stiffness:g} N/m, dt 1/{1 / dt:.0f} s", fontsize=10)
        panel.set_xlabel(label)
        panel.set_ylabel("RMS error [mean edge]")
        panel.grid(True, which="both", alpha=0.2)
    panels.flat[0].legend(fontsize=7)
    figure.tight_layout()
    for suffix in (".png", ".svg"):
        figure.savefig(target.with_suffix(suffix), dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("."))
    arguments = parser.parse_args()
    problems = read_problems(arguments.table)
    draw(problems, "ms_per_step", "milliseconds per step", arguments.output / "solvers_time")
    draw(problems, "iterations", "iterations, sweeps or substeps per step", arguments.output / "solvers_iterations")


if __name__ == "__main__":
    main()
