#!/usr/bin/env python3
"""Picture of `toile-bench figures`: error and residual against milliseconds.

    plot.py paper_figures.csv -o FOLDER     paper_figures.png
"""

import argparse
import csv
import math
import pathlib

# Figure of the paper, and a part of the problem's name.
PANELS = [(7, "2000 Pa, drag"), (8, "10 N/m, drag"), (9, "2000 Pa, drag"),
          (11, "two bars"), (11, "five sheets"), (12, "bar")]
LOOPS = {7: "line search", 8: "line search", 9: "line search", 11: "pcg", 12: "l-bfgs"}
DENOMINATORS = ", exact denominators"
FLOOR = 1e-6


def read(path):
    """(figure, problem, method, loop): [(ms, residual, error)]"""
    curves = {}
    for row in csv.DictReader(open(path)):
        key = int(row["figure"]), row["problem"], row["method"], row["loop"]
        curves.setdefault(key, []).append(tuple(float(row[name]) for name in ("ms", "residual", "error")))
    return curves


def draw_panel(ax, curves, figure, part):
    problem = next(key[1] for key in curves if key[0] == figure and part in key[1])
    of_problem = {key[2:]: points for key, points in curves.items() if key[:2] == (figure, problem)}
    # Methods that replace the loop have none but their line search.
    chosen = {method if loop == LOOPS[figure] else f"{method}, {loop}": points
              for (method, loop), points in of_problem.items()
              if loop == LOOPS[figure] or (method, LOOPS[figure]) not in of_problem}
    # The paper's rule appears with the denominators that serve it better.
    chosen = {method: points for method, points in chosen.items() if method + DENOMINATORS not in chosen}
    for i, (method, points) in enumerate(chosen.items()):
        points = [point for point in points if math.isfinite(point[2])]
        ms = [point[0] for point in points]
        ax.plot(ms, [max(point[2], FLOOR) for point in points], f"C{i}", label=method.removesuffix(DENOMINATORS))
        ax.plot(ms, [max(point[1], FLOOR) for point in points], f"C{i}", linewidth=0.5)
    ax.set(xscale="log", yscale="log", xlabel="ms", ylim=(FLOOR / 2, 4))
    ax.set_title(f"Figure {figure}: {problem}, {LOOPS[figure]}", fontsize=8)
    ax.grid(alpha=0.3)
    ax.legend(fontsize=6)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("."))
    args = parser.parse_args()

    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    curves = read(args.csv)
    plot, axes = plt.subplots(2, 3, figsize=(12, 7.5))
    for ax, (figure, part) in zip(axes.flat, PANELS):
        draw_panel(ax, curves, figure, part)
    for ax in axes[:, 0]:
        ax.set_ylabel("error (thick), residual (thin)")
    plot.tight_layout()
    plot.savefig(args.output / "paper_figures.png", dpi=90)


if __name__ == "__main__":
    main()
