#!/usr/bin/env python3
"""Figure of `toile-bench error_time`.

    plot.py error_time.csv -o FOLDER    PNG and SVG: error_time, one panel a problem, the default marked
"""

import argparse
import csv
import math
import pathlib

# Method: colour and line. Toile's own are drawn thicker.
STYLES = {
    "Newton, BDF2": ("#d62728", "-"), "preview": ("#ff9896", "-"), "direct": ("black", "-"),
    "quadrature": ("#8c564b", "-"), "multigrid": ("#1f77b4", "--"), "subspace": ("#17becf", "--"),
    "Chebyshev": ("#2ca02c", "--"), "A-Jacobi": ("#98df8a", "--"), "Jacobi-PCG": ("#ff7f0e", "--"),
    "XPBD": ("#e377c2", ":"), "VBD": ("#9467bd", ":"),
}
OWN = ("Newton, BDF2", "preview", "direct", "quadrature")


def panels_of(rows):
    """{problem: {method: rows by time}}"""
    panels = {}
    for row in rows:
        panels.setdefault(row["problem"], {}).setdefault(row["method"], []).append(row)
    for methods in panels.values():
        for points in methods.values():
            points.sort(key=lambda row: float(row["ms/frame"]))
    return panels


def draw(rows, target):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    panels = panels_of(rows)
    columns = min(2, len(panels))
    count = math.ceil(len(panels) / columns)
    figure, axes = plt.subplots(count, columns, figsize=(6.5 * columns, 4.2 * count + 0.8), squeeze=False)
    for axis in axes.flat[len(panels):]:
        axis.axis("off")
    lines = {}
    for axis, (problem, methods) in zip(axes.flat, panels.items()):
        for method, points in methods.items():
            colour, line = STYLES[method]
            x, y = [float(p["ms/frame"]) for p in points], [max(float(p["error"]), 1e-6) for p in points]
            lines[method] = axis.loglog(x, y, line, color=colour, marker="o", markersize=4,
                                        linewidth=2 if method in OWN else 1.2, zorder=4 if method in OWN else 3)[0]
            for point in points:
                if point["default"]:
                    axis.plot(float(point["ms/frame"]), float(point["error"]), "*", color=colour, markersize=16,
                              markeredgecolor="black", zorder=5)
        axis.set_title(problem, fontsize=10)
        axis.set_xlabel("milliseconds a frame")
        axis.set_ylabel(next(iter(methods.values()))[0]["quantity"], fontsize=9)
        axis.grid(True, which="major", alpha=0.3)
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.7 / figure.get_figheight()))
    figure.legend([lines[m] for m in STYLES if m in lines], [m for m in STYLES if m in lines], ncols=6,
                  loc="upper center", fontsize=9)
    figure.savefig(target.with_suffix(".png"), dpi=90)
    figure.savefig(target.with_suffix(".svg"), metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    options = parser.parse_args()
    with options.table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    options.output.mkdir(parents=True, exist_ok=True)
    draw(rows, options.output / "error_time")


if __name__ == "__main__":
    main()
