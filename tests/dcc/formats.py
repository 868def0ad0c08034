#!/usr/bin/env python3
"""Measures every cache format of Toile, and prints the table of docs/reference/cache_formats.md.

    python3 tests/dcc/formats.py build/bin/toile > docs/reference/cache_formats.md

Needs tests/dcc/requirements.txt (make test-dcc installs them into build/dcc).
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from conversion import FORMATS, compare, convert, script, writes
from players import Vtk
from point_cache import read_pc2

COLUMNS, ROWS, FRAMES = 100, 100, 120
PAYLOAD = 12 * COLUMNS * ROWS * FRAMES  # [bytes]
RUNS = 3  # of which the fastest counts

# Where the frames of a killed run are.
PARTIALS = {".pc2": "skirt.partial.pc2", ".mdd": "skirt.mdd.partial.pc2", ".abc": "skirt.partial.abc",
            ".glb": "skirt.glb.partial.pc2", ".obj": "skirt.partial/skirt_####.obj",
            ".ply": "skirt.partial/skirt_####.ply", ".pvd": "skirt.partial/skirt.pvd",
            ".usda": "skirt.partial/skirt.usda", ".usdc": "skirt.usdc.partial/skirt.usdc.usda"}
USD_TEXT = 70 / 12  # bytes of USD in text, in which the frames of a .usdc wait, over those of single precision


class Run:
    """Conversions of one format in a folder of its own."""

    def __init__(self, toile, source, folder, suffix):
        self.toile, self.source, self.folder, self.suffix = toile, source, folder, suffix
        self.options = ["--mesh", str(source.with_suffix(".obj")), "--fps", "24"]
        self.output = folder / FORMATS[suffix]
        self.bytes = 0  # of all files of the cache

    def time(self):
        """@return seconds of the fastest run, and what it says"""
        fastest = min(convert(self.toile, self.source, self.output, *self.options) for _ in range(RUNS))
        self.bytes = bytes_in(self.folder)
        return fastest

    def read_back(self):
        back = self.folder / "back.pc2"
        command = [self.toile, "convert", str(self.output), str(back), "--quiet"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return "no: for other programs"
        worst = np.abs(read_pc2(back)[1] - read_pc2(self.source)[1]).max()
        back.unlink()
        return "every bit" if worst == 0 else f"to {worst:.1g} m"

    def play(self):
        is_equal, said = compare(self.output, [self.source], *self.options[:2])
        difference = said[0].split("largest difference ")[-1].split(" at ")[0].split(",")[0]
        return f"{'yes' if is_equal else '**NO**'}, to {difference}"

    def kill_half_way(self):
        """Kills a run when half of its bytes are written. @return frames that can be read, of those in the bytes"""
        for file in list(self.folder.rglob("*")):
            if file.is_file():
                file.unlink()
        whole = PAYLOAD if PARTIALS[self.suffix].endswith(".pc2") else self.bytes
        if self.suffix == ".usdc":
            whole = USD_TEXT * PAYLOAD
        command = [self.toile, "convert", str(self.source), str(self.output), "--quiet", *self.options]
        with subprocess.Popen(command) as killed:
            while killed.poll() is None and bytes_in(self.folder) < 0.5 * whole:
                pass
            killed.kill()
        written = int(FRAMES * bytes_in(self.folder) / whole)
        x = self.read_partial()
        if len(x) > 0 and not np.array_equal(x, read_pc2(self.source)[1][:len(x)]):
            sys.exit(f"{self.output}: frames of a killed run differ from those of the whole one")
        return f"{len(x)} of {max(written, len(x))}"  # frames as text differ in size

    def read_partial(self):
        """Frames [frames, points, 3] of a killed run."""
        partial = self.folder / PARTIALS[self.suffix]
        if self.suffix == ".pvd":
            vtk = Vtk(partial, argparse.Namespace(fps=24.0, first=0))
            return np.array([vtk.positions("", k) for k in range(len(vtk.entries))])
        back = self.folder / "killed.pc2"
        done = subprocess.run([self.toile, "convert", str(partial), str(back), "--quiet"], capture_output=True,
                              text=True, check=False)
        if done.returncode != 0:
            print(f"{self.suffix}: {done.stderr.strip()}", file=sys.stderr)
            return np.empty((0, 0, 3))
        return read_pc2(back)[1]


def bytes_in(folder):
    """Size of all files below a folder, of which some vanish meanwhile."""
    size = 0
    for root, _, files in os.walk(folder):
        for file in files:
            try:
                size += os.path.getsize(os.path.join(root, file))
            except FileNotFoundError:
                pass
    return size


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as lines:
        names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{names[0] if names else 'unknown processor'}, {os.cpu_count()} threads"


def main():
    parser = argparse.ArgumentParser(description="Measure cache formats, and print a table in Markdown.")
    parser.add_argument("toile", help="the program")
    options = parser.parse_args()
    toile = str(pathlib.Path(options.toile).resolve())
    print(f"""# Cache formats, measured

{COLUMNS * ROWS} vertices, {FRAMES} frames: {PAYLOAD / 1e6:.1f} MB of positions in single precision. Machine: {machine()}.
Made by `python3 tests/dcc/formats.py build/bin/toile` with the Python packages of `tests/dcc/requirements.txt`.

| format | reads back | other program, every frame | frames read, of those written before SIGKILL | size [MB] | writes [MB/s] | note |
|---|---|---|---|---|---|---|""")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        code, _, errors = script("make_cache.py", folder, "--columns", COLUMNS, "--rows", ROWS, "--frames", FRAMES,
                                 "--no-archive")
        if code != 0:
            sys.exit(errors)
        for suffix in FORMATS:
            if not writes(toile, suffix):
                print(f"| `{suffix}` | SKIPPED: this toile does not write it | | | | | |")
                print(f"{suffix}: SKIPPED: this toile does not write it", file=sys.stderr)
                continue
            own = folder / suffix[1:]
            own.mkdir()
            run = Run(toile, folder / "skirt.pc2", own, suffix)
            seconds, said = run.time()
            note = said.split(": ", 1)[1] if ": " in said else ""
            back, played = run.read_back(), run.play()
            frames = run.kill_half_way()
            print(f"| `{suffix}` | {back} | {played} | {frames} | {run.bytes / 1e6:.1f} | "
                  f"{PAYLOAD / 1e6 / seconds:.0f} | {note} |", flush=True)
    print(f"""
The other program is Blender 5.0.1, for `.pvd` VTK 9.7.2; differences of 1e-7 m are its own rotation of axes in single
precision. Speed is that of `toile convert` from a PC2, its reading included, the fastest of {RUNS} runs. A run is
killed when at least half of the bytes of its frames are written; what is then read from the
[partial](../guide/caches.md#when-a-run-is-killed) equals those frames of the whole run. USD keeps whole clips of 50.""")
    return 0


if __name__ == "__main__":
    sys.exit(main())
