#!/usr/bin/env python3
"""Makes a small scene of assets/paper and simulates it until its bodies touch.

    paper_scenes.py --toile PATH --assets DIR SCENE FRAMES [--touches-nothing]

All steps converge, there is contact unless nothing touches, and the certificate holds. Scenes are made by the
interpreter in TOILE_PYTHON, by default this one or the system's. Exit codes: 0 so it is, 1 not, 77 no interpreter has
the packages.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PACKAGES = "numpy, scipy, skimage, matplotlib"
SYSTEM_PYTHON = "/usr/bin/python3"


def find_interpreter():
    """An interpreter with the packages, or None and why there is none."""
    reasons = []
    for python in [os.environ["TOILE_PYTHON"]] if "TOILE_PYTHON" in os.environ else [sys.executable, SYSTEM_PYTHON]:
        if shutil.which(python) is None:
            reasons.append(f"{python} does not exist")
            continue
        found = subprocess.run([python, "-c", f"import {PACKAGES}"], stderr=subprocess.PIPE, text=True)
        if found.returncode == 0:
            return python, ""
        reasons.append(f"{python} says: {(found.stderr.splitlines() or ['nothing'])[-1]}")
    return None, "; ".join(reasons)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--toile", required=True)
    parser.add_argument("--assets", required=True, type=pathlib.Path)
    parser.add_argument("scene")
    parser.add_argument("frames")
    parser.add_argument("--touches-nothing", action="store_true")
    options = parser.parse_args()

    python, reasons = find_interpreter()
    if python is None:
        print(f"SKIPPED: scenes are made with {PACKAGES}; {reasons}")
        return 77

    with tempfile.TemporaryDirectory() as folder:
        maker = options.assets / "paper" / "make_scene.py"
        subprocess.run([python, maker, options.scene, folder, "--toile", options.toile], check=True)
        report = pathlib.Path(folder, "report.json")
        simulate = [options.toile, "simulate", f"{folder}/{options.scene}.json", "-o", f"{folder}/out"]
        # The exit code says whether the certificate holds.
        subprocess.run([*simulate, "--frames", options.frames, "--report", report, "--quiet"], check=True)
        frames = json.loads(report.read_text())["frames"]
    statuses = {frame["status"] for frame in frames}
    contacts = sum(frame["contacts"] for frame in frames)
    print(f"{options.scene}: {sorted(statuses)}, {contacts} contacts in all frames")
    return 0 if statuses == {"converged"} and (contacts == 0) == options.touches_nothing else 1


if __name__ == "__main__":
    sys.exit(main())
