"""The table of `toile-bench solvers`, read and searched."""

import csv
import math

KEYS = ("ms_per_step", "setup_ms", "iterations", "rms_over_edge", "energy_gap", "peak_mb")

# Gaps below are rounding; they may be negative.
LEAST_ERROR = 1e-12


class Problem:
    """One mesh, size, stiffness and time step; `curves` maps a method to its rows by rising budget."""

    def __init__(self, mesh, vertices, stiffness, dt):
        self.mesh, self.vertices, self.stiffness, self.dt = mesh, vertices, stiffness, dt
        self.curves = {}
        self.is_converged = True

    def title(self):
        return f"{self.mesh} {self.vertices}, {self.stiffness:g} N/m, 1/{1 / self.dt:.0f} s"

    def row(self, name):
        """The row of "direct 20"; None without one."""
        method = name.rsplit(" ", 1)[0]
        return next((row for row in self.curves.get(method, ()) if row["method"] == name), None)


def read_problems(file):
    """Problems in the table's order, those whose reference has not converged included."""
    problems = {}
    with open(file, newline="", encoding="utf-8") as table:
        for row in csv.DictReader(table):
            key = row["mesh"], int(row["vertices"]), float(row["stiffness"]), float(row["dt"])
            problem = problems.setdefault(key, Problem(*key))
            row.update({name: float(row[name]) for name in KEYS})
            method, budget = row["method"].rsplit(" ", 1)
            row["budget"] = int(budget)
            problem.curves.setdefault(method, []).append(row)
            problem.is_converged &= row.get("reference", "converged") == "converged"
    for problem in problems.values():
        for rows in problem.curves.values():
            rows.sort(key=lambda row: row["budget"])
    return list(problems.values())


def time_to_reach(rows, quantity, target):
    """(prefix, milliseconds a step): log-log between the first budget that reaches the target and the one before.
    "<": the smallest budget is beyond it already; ">": the largest is not there."""
    previous = None
    for row in rows:
        error = max(row[quantity], LEAST_ERROR)
        if error <= target:
            if previous is None:
                return "<", row["ms_per_step"]
            before = max(previous[quantity], LEAST_ERROR)
            if before <= error:
                return "", row["ms_per_step"]
            share = math.log(before / target) / math.log(before / error)
            times = previous["ms_per_step"], row["ms_per_step"]
            return "", times[0] * (times[1] / times[0]) ** share
        previous = row
    return ">", max(row["ms_per_step"] for row in rows)


def exponent(sizes, values):
    """p of values ~ sizes^p, least squares of the logarithms; nan below two sizes or without positive values."""
    points = [(math.log(n), math.log(v)) for n, v in zip(sizes, values) if v > 0.0]
    if len(points) < 2:
        return math.nan
    x0 = sum(x for x, _ in points) / len(points)
    y0 = sum(y for _, y in points) / len(points)
    return sum((x - x0) * (y - y0) for x, y in points) / sum((x - x0) ** 2 for x, _ in points)
