#!/usr/bin/env python3
"""Figure and tables from the baselines of `toile-bench gpu`.

    plot_baselines.py gpu_baselines.csv -o FOLDER     gpu_baselines.png and .svg: errors against time
    plot_baselines.py gpu_baselines.csv --table       prints Markdown: milliseconds a step until an error, log-log between
                                                budgets, by the fastest variant, bold: over ours;
                                                < : the smallest budget is closer already, - : no budget is there
"""

import argparse
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "solvers"))

import table  # noqa: E402  of benchmarks/solvers

OURS = "quadrature"
FAMILIES = {  # of a rival: its variants, of which the fastest counts, and its colour
    "chebyshev": "#2ca02c", "a-jacobi": "#98df8a", "paper": "#8c564b", "vbd": "#9467bd", "xpbd": "#e377c2",
}
AIMS = {"vbd": 3.0, "xpbd": 10.0}  # how many times as long as ours a rival should take
SMALL_STEPS = "sheet in small steps"  # mesh of the rows against the limit of small steps

# Errors [mean edges] and relative energy gaps at which times are compared.
ERRORS = [0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002]
GAPS = [0.3, 0.1, 0.03, 0.01, 0.003, 0.001]


def family(method):
    return method.split(" ")[0]


def variants(problem, name):
    return [method for method in problem.curves if family(method) == name and "double" not in method]


def fastest(problem, name, quantity, target):
    """(variant, prefix, milliseconds) of the variant that is first at an error."""
    best = ("", ">", math.inf)
    for method in variants(problem, name):
        prefix, time = table.time_to_reach(problem.curves[method], quantity, target)
        if prefix != ">" and time < best[2]:
            best = (method, prefix, time)
    return best


def title(problem):
    is_good = problem.is_converged or problem.mesh == SMALL_STEPS
    note = "" if is_good else " (reference not judged converged)"
    return f"{problem.vertices} vertices, {problem.stiffness:g} N/m{note}"


def draw_panel(panel, problem, quantity, label):
    for name in [OURS, *FAMILIES]:
        for k, method in enumerate(variants(problem, name)):
            rows = problem.curves[method]
            panel.loglog([row["ms_per_step"] for row in rows], [row[quantity] for row in rows], marker="o",
                         markersize=3, color=FAMILIES.get(name, "#d62728"), linestyle=["-", "--", ":", "-."][k % 4],
                         linewidth=2 if name == OURS else 1.2, label=method)
    panel.set_ylim(top=min(panel.get_ylim()[1], 3.0))
    panel.grid(True, which="major", alpha=0.3)
    panel.set_xlabel("milliseconds per step")
    panel.set_ylabel(label)
    panel.legend(fontsize=6)


def draw(problems, folder):
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "toile"  # the same file for the same table
    import matplotlib.pyplot as plt

    to_minimiser = [p for p in problems if p.mesh != SMALL_STEPS]
    in_small_steps = [p for p in problems if p.mesh == SMALL_STEPS]
    rows = [(to_minimiser, "rms_over_edge", "RMS error to the minimiser [mean edge]"),
            (to_minimiser, "energy_gap", "relative energy gap"),
            (in_small_steps, "rms_over_edge", "RMS error to the limit of small steps [mean edge]")]
    figure, panels = plt.subplots(3, len(to_minimiser), figsize=(4.6 * len(to_minimiser), 12.5), squeeze=False)
    for line, (chosen, quantity, label) in zip(panels, rows):
        for panel, problem in zip(line, chosen):
            draw_panel(panel, problem, quantity, label)
            panel.set_title(title(problem), fontsize=9)
    figure.tight_layout()
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "gpu_baselines.png", dpi=80)
    figure.savefig(folder / "gpu_baselines.svg", metadata={"Date": None})


def cell(ours, best):
    method, prefix, time = best
    if not method:
        return "-"
    detail = method.removeprefix(family(method)).strip()
    ratio = f", **{time / ours:.2g}**" if math.isfinite(ours) and prefix != "<" else ""
    return f"{prefix} {time:.2f}{ratio}".strip() + (f" ({detail})" if detail else "")


def print_table(problem, quantity, targets, label):
    names = [name for name in FAMILIES if variants(problem, name)]
    print(f"| {label} | ours | " + " | ".join(names) + " |")
    print("|" + "---|" * (len(names) + 2))
    for target in targets:
        _, prefix, ours = fastest(problem, OURS, quantity, target)
        own = f"{prefix} {ours:.2f}".strip() if math.isfinite(ours) else "-"
        cells = [cell(ours, fastest(problem, name, quantity, target)) for name in names]
        print(f"| {target:g} | {own} | " + " | ".join(cells) + " |")
    print()


def print_tables(problems):
    for problem in problems:
        print(f"**{title(problem)}{', small steps' if problem.mesh == SMALL_STEPS else ''}**\n")
        print_table(problem, "rms_over_edge", ERRORS, "error [edges]")
        if problem.mesh != SMALL_STEPS:
            print_table(problem, "energy_gap", GAPS, "energy gap")
    print("**Aims**\n")
    print_aims(problems)


def print_aims(problems):
    """Of every problem and rival with an aim: the errors and gaps at which it is met, and at which not; where the
    rival's smallest budget is there already ("begins there") its time is not known."""
    print("| | by | " + " | ".join(f"{name}: {aim:g} times" for name, aim in AIMS.items()) + " |")
    print("|" + "---|" * (len(AIMS) + 2))
    for problem in problems:
        measures = [("rms_over_edge", ERRORS, "error")]
        if problem.mesh != SMALL_STEPS:
            measures.append(("energy_gap", GAPS, "gap"))
        for quantity, targets, label in measures:
            cells = []
            for name, aim in AIMS.items():
                outcomes = {"met": [], "not met": [], "never gets to": [], "begins there": [], "nobody gets to": []}
                for target in targets:
                    _, _, ours = fastest(problem, OURS, quantity, target)
                    _, prefix, time = fastest(problem, name, quantity, target)
                    if not math.isfinite(ours):
                        outcome = "nobody gets to" if math.isinf(time) else "not met"
                    elif math.isinf(time):
                        outcome = "never gets to"
                    elif prefix == "<":
                        outcome = "begins there"
                    else:
                        outcome = "met" if time >= aim * ours else "not met"
                    outcomes[outcome].append(f"{target:g}")
                cells.append("; ".join(f"{word} {', '.join(found)}" for word, found in outcomes.items() if found))
            note = ", small steps" if problem.mesh == SMALL_STEPS else ""
            print(f"| {title(problem)}{note} | {label} | " + " | ".join(cells) + " |")
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, help="folder for the figure")
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
