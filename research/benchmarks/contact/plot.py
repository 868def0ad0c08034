#!/usr/bin/env python3
"""Figure from `toile-bench contact`.

    plot.py FOLDER [-o FILE]    draws contact_scaling.csv and contact_dressed.csv of FOLDER, as far as they are there,
                                into FILE [FOLDER/contact_cost.png]: milliseconds per step by part against
                                vertices and against contacts, and what dressed scenes spend; needs matplotlib
"""

import argparse
import csv
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# Part: colour. In the order of the bars.
PARTS = {
    "cloth_pairs": "#d62728", "avatar_pairs": "#ff9896", "bring_back": "#ff7f0e", "solve": "#1f77b4",
    "pcg": "#17becf", "minimise": "#aec7e8", "strain_limit": "#2ca02c", "rest": "#999999",
}


def read(file):
    if not file.exists():
        return []
    with open(file, newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def exponent(points):
    """Slope of the least squares line through the logarithms of (x, y)."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean_x, mean_y = (sum(values) / len(logs) for values in zip(*logs))
    square = sum((x - mean_x) ** 2 for x, _ in logs)
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / square if square > 0 else math.nan


def draw_curves(axes, rows, horizontal, label):
    curves = [("step", "ms_per_step", "black", 2.2)]
    curves += [(part.replace("_", " "), part + "_ms", colour, 1.4) for part, colour in PARTS.items()]
    for name, column, colour, width in curves:
        points = [(float(row[horizontal]), float(row[column])) for row in rows]
        points = sorted(point for point in points if min(point) > 0)
        if len(points) >= 2:
            axes.loglog(*zip(*points), marker="o", markersize=3, color=colour, linewidth=width,
                        label=f"{name}: {exponent(points):.2f}")
    axes.set_xlabel(label)
    axes.set_ylabel("ms per step")
    axes.grid(True, which="major", alpha=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7, title="power", title_fontsize=7, loc="upper left")


def draw_dressed(axes, rows):
    names = [row["scene"] for row in rows]
    left = [0.0] * len(rows)
    for part, colour in PARTS.items():
        shares = [float(row[part + "_ms"]) / float(row["ms_per_step"]) for row in rows]
        axes.barh(names, shares, left=left, color=colour, label=part.replace("_", " "))
        left = [a + b for a, b in zip(left, shares)]
    for at, row in enumerate(rows):
        axes.text(1.01, at, f"x {float(row['ratio']):.2f}", va="center", fontsize=8)
    axes.axvline(0.5, color="black", linewidth=0.8, linestyle=":")
    axes.set_xlim(0, 1.12)
    axes.invert_yaxis()
    axes.set_xlabel("share of a step; x: over the same scene without self-contact")
    axes.legend(fontsize=7, ncols=4, loc="upper center", bbox_to_anchor=(0.5, -0.18))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    arguments = parser.parse_args()
    scaling = read(arguments.folder / "contact_scaling.csv")
    dressed = read(arguments.folder / "contact_dressed.csv")
    if not scaling and not dressed:
        parser.error(f"{arguments.folder}: has neither contact_scaling.csv nor contact_dressed.csv, or no rows in them")

    figure, axes = plt.subplots(1, 3, figsize=(17, 5))
    size = [row for row in scaling if row["case"].startswith("scaling size")]
    layers = [row for row in scaling if row["case"].startswith("scaling layers")]
    draw_curves(axes[0], size, "vertices", "vertices, at fixed layers")
    draw_curves(axes[1], layers, "contacts_per_step", "contacts, at fixed vertices")
    if dressed:
        draw_dressed(axes[2], dressed)
    else:
        axes[2].axis("off")
    figure.tight_layout()
    figure.savefig(arguments.output or arguments.folder / "contact_cost.png", dpi=90)


if __name__ == "__main__":
    main()
