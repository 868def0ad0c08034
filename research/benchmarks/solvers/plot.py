#!/usr/bin/env python3
"""Figures and tables from `toile-bench solvers`.

    plot.py solvers.csv -o FOLDER     PNG and SVG: solvers_error_time, solvers_gap_time, solvers_error_iterations,
                                      solvers_cost, solvers_setup; solvers_exponents.csv
    plot.py solvers.csv --table       prints Markdown: time to reach an error, fitted exponents
"""

import argparse
import csv
import math
import pathlib

import table

# Solver: colour. Newton's method around it is dashed; other outer methods are dotted and grey.
COLOURS = {
    "direct": "black", "quadrature": "#d62728", "multigrid": "#1f77b4", "subspace": "#17becf",
    "chebyshev": "#2ca02c", "a-jacobi": "#98df8a", "jacobi-pcg": "#ff7f0e", "paper": "#bcbd22",
    "vbd": "#9467bd", "xpbd": "#e377c2",
}
OUTER = {"direct lg": ("#999999", ":"), "direct anderson": ("#555555", ":")}
NEWTON = [f"{solver} newton-pcg" for solver in ("direct", "quadrature")]
METHODS = ["direct", "quadrature", *NEWTON, "multigrid", "subspace", "chebyshev", "a-jacobi", "jacobi-pcg", "vbd", "xpbd"]

# Cost against size: one budget a method, on the sheet at these.
BUDGETS = {"jacobi-pcg": 8, "vbd": 50, "direct newton-pcg": 4, "quadrature newton-pcg": 4}
SCALING_STIFFNESS, SCALING_DT = 1e3, 1 / 120

# Newton's curves fall out of the panels there; below it nobody can see a difference.
FLOOR = {"rms_over_edge": 1e-5, "energy_gap": 1e-7}

# What "the same error" means: that of a method, or a relative energy gap.
GAP = 1e-4
YARDSTICKS = [("direct 20", "rms_over_edge"), ("xpbd 20", "rms_over_edge"), (None, "energy_gap")]


def style(method):
    if method in OUTER:
        colour, line = OUTER[method]
    else:
        colour, line = COLOURS[method.split(" ")[0]], "--" if method.endswith("newton-pcg") else "-"
    return {"color": colour, "linestyle": line, "marker": "o", "markersize": 3,
            "linewidth": 2 if method in ("direct", "quadrature") else 1.2,
            "zorder": 4 if method.startswith(("direct", "quadrature")) else 3}


def number(value):
    if not math.isfinite(value):
        return "-"
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


# ---------------------------------------------------------------- figures


def save(figure, target):
    import matplotlib.pyplot as plt

    figure.savefig(target.with_suffix(".png"), dpi=90)
    figure.savefig(target.with_suffix(".svg"), metadata={"Date": None})
    plt.close(figure)


def small_multiples(problems, methods, horizontal, vertical, labels, target, line=None):
    """One panel a problem, one legend for all."""
    import matplotlib.pyplot as plt

    columns = min(4, len(problems))
    count = math.ceil(len(problems) / columns)
    figure, panels = plt.subplots(count, columns, figsize=(3.9 * columns, 3.2 * count + 1.0), squeeze=False)
    for panel in panels.flat[len(problems):]:
        panel.axis("off")
    lines = {}
    for panel, problem in zip(panels.flat, problems):
        for method in methods:
            rows = problem.curves.get(method, [])
            points = [(row[horizontal], max(row[vertical], table.LEAST_ERROR)) for row in rows]
            if points:
                lines[method] = panel.loglog(*zip(*points), **style(method))[0]
        panel.set_ylim(bottom=max(panel.get_ylim()[0], FLOOR[vertical]))
        if line is not None:
            panel.axhline(line, color="grey", linewidth=0.8)
        panel.set_title(problem.title() + ("" if problem.is_converged else " (reference not converged)"), fontsize=9)
        panel.grid(True, which="major", alpha=0.3)
    for panel in panels[:, 0]:
        panel.set_ylabel(labels[1])
    for panel in panels[-1]:
        panel.set_xlabel(labels[0])
    ordered = [method for method in methods if method in lines]
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.7 / figure.get_figheight()))
    figure.legend([lines[method] for method in ordered], ordered, ncols=min(6, len(ordered)), loc="upper center", fontsize=9)
    save(figure, target)


def scaling(problems):
    """{method: rows of one budget by rising size} on the sheet."""
    chosen = [p for p in problems
              if p.mesh == "sheet" and p.stiffness == SCALING_STIFFNESS and abs(p.dt - SCALING_DT) < 1e-3]
    chosen.sort(key=lambda p: p.vertices)
    result = {}
    for method in METHODS:
        rows = [(p.vertices, p.row(f"{method} {BUDGETS.get(method, 20)}")) for p in chosen]
        rows = [(n, row) for n, row in rows if row]
        if len(rows) >= 2:
            result[method] = rows
    return result


def draw_scaling(curves, quantities, target):
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(1, len(quantities), figsize=(7 * len(quantities), 5.5), squeeze=False)
    for panel, (quantity, label) in zip(panels.flat, quantities):
        for method, rows in curves.items():
            sizes, values = [n for n, _ in rows], [row[quantity] for _, row in rows]
            power = table.exponent(sizes, values)
            name = f"{rows[0][1]['method']}: N^{power:.2f}"
            panel.loglog(sizes, values, label=name, **style(method))
        panel.set_xlabel("vertices N")
        panel.set_ylabel(label)
        panel.grid(True, which="major", alpha=0.3)
        panel.legend(fontsize=8)
    figure.tight_layout()
    save(figure, target)


def draw(problems, folder):
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "toile"  # the same file for the same table
    folder.mkdir(parents=True, exist_ok=True)
    error, gap, time = "RMS error [mean edge]", "relative energy gap", "milliseconds per step"
    small_multiples(problems, METHODS, "ms_per_step", "rms_over_edge", (time, error), folder / "solvers_error_time")
    small_multiples(problems, METHODS, "ms_per_step", "energy_gap", (time, gap), folder / "solvers_gap_time", GAP)
    small_multiples(problems, ["direct", *OUTER, *METHODS[1:], "paper"], "iterations", "rms_over_edge",
                    ("iterations, sweeps or substeps", error), folder / "solvers_error_iterations")
    curves = scaling(problems)
    if curves:
        draw_scaling(curves, [("ms_per_step", time)], folder / "solvers_cost")
        draw_scaling(curves, [("setup_ms", "set-up [ms]"), ("peak_mb", "memory [MB]")], folder / "solvers_setup")
        with open(folder / "solvers_exponents.csv", "w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(exponents(curves))
    else:
        print("fewer than two sheets at 1e3 N/m and 1/120 s: no figures of cost against size")


# ---------------------------------------------------------------- tables


def exponents(curves):
    """Header and rows: powers of N of the time of a step, of set-up and of memory."""
    rows = [["method", "sizes", "least_vertices", "most_vertices", "step", "setup", "memory"]]
    for points in curves.values():
        sizes = [n for n, _ in points]
        powers = [table.exponent(sizes, [row[q] for _, row in points]) for q in ("ms_per_step", "setup_ms", "peak_mb")]
        rows.append([points[0][1]["method"], len(sizes), sizes[0], sizes[-1], *(f"{p:.2f}" for p in powers)])
    return rows


def print_markdown(rows):
    print("| " + " | ".join(map(str, rows[0])) + " |")
    print("|" + "---|" * len(rows[0]))
    for row in rows[1:]:
        print("| " + " | ".join(map(str, row)) + " |")


def reach_rows(problems, yardstick, quantity):
    """Header and rows: milliseconds a step until the yardstick's error, the best in bold."""
    methods = [m for m in METHODS if any(m in p.curves for p in problems)]
    rows = [["mesh, vertices, stiffness, dt", "target", *methods]]
    for problem in problems:
        row = problem.row(yardstick) if yardstick else None
        if yardstick and not row:
            continue
        target = row[quantity] if row else GAP
        reached = {m: table.time_to_reach(problem.curves[m], quantity, target) for m in methods if m in problem.curves}
        best = min((ms for prefix, ms in reached.values() if prefix != ">"), default=None)
        cells = []
        for method in methods:
            prefix, ms = reached.get(method, ("", math.nan))
            text = f"{prefix} {number(ms)}".strip()
            cells.append(f"**{text}**" if prefix != ">" and ms == best else text)
        rows.append([problem.title(), f"{target:.1e}", *cells])
    return rows


def print_tables(problems):
    unconverged = [p.title() for p in problems if not p.is_converged]
    converged = [p for p in problems if p.is_converged]
    print("Milliseconds a step, log-log between budgets; < : the smallest budget is closer already, > : the largest is "
          "not there; bold: fastest.\n")
    for yardstick, quantity in YARDSTICKS:
        print(f"**Until the error of {yardstick}**\n" if yardstick else f"**Until a relative energy gap of {GAP:g}**\n")
        print_markdown(reach_rows(converged, yardstick, quantity))
        print()
    if unconverged:
        print("Left out, since the reference has not converged: " + "; ".join(unconverged) + ".\n")
    curves = scaling(problems)
    if curves:
        print("**Powers of N**, fitted (sheet, 1e3 N/m, 1/120 s)\n")
        print_markdown(exponents(curves))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, help="folder for the figures")
    parser.add_argument("--table", action="store_true", help="print the tables as Markdown")
    arguments = parser.parse_args()
    problems = table.read_problems(arguments.csv)
    if not problems:
        parser.error(f"{arguments.csv}: has no rows")
    if arguments.output:
        draw(problems, arguments.output)
    if arguments.table or not arguments.output:
        print_tables(problems)


if __name__ == "__main__":
    main()
