#!/usr/bin/env python3
"""Makes a small scene of assets/paper and simulates it until its bodies touch.

    paper_scenes.py --toile PATH --assets DIR SCENE FRAMES

All steps converge, there is contact, and the certificate holds. Scenes are made by the interpreter in TOILE_PYTHON, by
default this one. Exit codes: 0 so it is, 1 not, 77 the interpreter lacks packages.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

PACKAGES = "numpy, scipy, skimage, matplotlib"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--toile", required=True)
    parser.add_argument("--assets", required=True, type=pathlib.Path)
    parser.add_argument("scene")
    parser.add_argument("frames")
    options = parser.parse_args()

    python = os.environ.get("TOILE_PYTHON", sys.executable)
    packages = subprocess.run([python, "-c", f"import {PACKAGES}"], stderr=subprocess.PIPE, text=True)
    if packages.returncode != 0:
        print(f"SKIPPED: scenes are made with {PACKAGES}; {python} says: {packages.stderr.splitlines()[-1]}")
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
    contacts = frames[-1]["contacts"]
    print(f"{options.scene}: {sorted(statuses)}, {contacts} contacts in the last frame")
    return 0 if statuses == {"converged"} and contacts > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
