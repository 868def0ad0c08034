#!/usr/bin/env python3
"""plot.py FOLDER   draws the CSV files of quadrature_figures into FOLDER/figures.png; needs matplotlib"""

import csv
import os
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

RULES = {
    "gauss_legendre_3": ("3-point GL", "tab:gray"),
    "gauss_legendre_4": ("4-point GL", "black"),
    "gaussian_alone": ("Gaussian alone", "tab:green"),
    "stacked_no_penalty": ("stacked, no penalty", "tab:orange"),
    "stacked": ("stacked (paper)", "tab:blue"),
}


def read(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def draw_profile(axes, rows, share):
    """The target and what stacking leaves of it to Gauss-Legendre."""
    rows = [row for row in rows if row["near_share"] == share]
    x = [row["x"] for row in rows]
    axes.plot(x, [row["target"] for row in rows], color="black", label="target")
    for key, rule in (("gaussian_no_penalty", "stacked_no_penalty"), ("gaussian", "stacked")):
        label, color = RULES[rule]
        axes.plot(x, [row["target"] - row[key] for row in rows], color=color, label="residual, " + label)
    axes.set_title(f"1-D, near box of {share:.0%}")
    axes.set_xlabel("x")


def draw_peaks(axes, rows, share):
    """Error against the position of the peak."""
    rows = [row for row in rows if row["near_share"] == share and row["lambda"] == 0.2]
    for key, (label, color) in RULES.items():
        axes.semilogy([row["peak"] for row in rows], [row[key] for row in rows], color=color, label=label)
    axes.set_title(f"error, near box of {share:.0%}")
    axes.set_xlabel("peak")


def draw_groups(axes, rows, key, title):
    """Mean error per rule for each value of `key`."""
    groups = sorted({row[key] for row in rows})
    width = 0.8 / len(RULES)
    for k, (rule, (label, color)) in enumerate(RULES.items()):
        means = [statistics.mean(row[rule] for row in rows if row[key] == group) for group in groups]
        axes.bar([g + (k - 2) * width for g in range(len(groups))], means, width, color=color, label=label)
    axes.set_yscale("log")
    axes.set_xticks(range(len(groups)), [f"{group:g}" for group in groups])
    axes.set_title(title)
    axes.set_xlabel(key.replace("_", " "))


def main():
    folder = sys.argv[1]
    figure, axes = plt.subplots(2, 3, figsize=(15, 8), layout="constrained")
    profile, line = read(folder, "profile.csv"), read(folder, "line.csv")
    for column, share in enumerate((0.7, 0.9)):
        draw_profile(axes[0, column], profile, share)
        draw_peaks(axes[1, column], line, share)
    square = [row for row in read(folder, "square.csv") if row["lambda"] == 0.2]
    draw_groups(axes[0, 2], square, "near_share", "mean error, 2-D product")
    draw_groups(axes[1, 2], read(folder, "sheet.csv"), "stiffness", "mean error, kernel of a sheet [N/m]")
    axes[0, 0].legend()
    axes[1, 0].legend()
    figure.savefig(os.path.join(folder, "figures.png"), dpi=80)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
