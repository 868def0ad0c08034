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
import time

import numpy as np

from conversion import FORMATS, compare, convert, script, writes
from players import Vtk
from point_cache import read_pc2

COLUMNS, ROWS, FRAMES = 100, 100, 120
RUNS = 3  # of which the fastest counts

# Where the frames of a killed run are.
PARTIALS = {".pc2": "skirt.partial.pc2", ".mdd": "skirt.mdd.partial.pc2", ".abc": "skirt.partial.abc",
            ".glb": "skirt.glb.partial.pc2", ".obj": "skirt.partial/skirt_####.obj",
            ".ply": "skirt.partial/skirt_####.ply", ".pvd": "skirt.partial/skirt.pvd",
            ".usda": "skirt.partial.usda", ".usdc": "skirt.partial.usdc"}


class Run:
    """Conversions of one format in a folder of its own."""

    def __init__(self, toile, source, folder, suffix):
        self.toile, self.source, self.folder, self.suffix = toile, source, folder, suffix
        self.options = ["--mesh", str(source.with_suffix(".obj")), "--fps", "24"]
        self.output = folder / FORMATS[suffix]

    def time(self):
        """@return seconds of the fastest run, and what it says"""
        return min(convert(self.toile, self.source, self.output, *self.options) for _ in range(RUNS))

    def size(self):
        """[bytes] of all files."""
        return sum(file.stat().st_size for file in self.folder.iterdir() if file.is_file())

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

    def kill(self, after):
        """Kills a run after some seconds. @return frames that can be read"""
        command = [self.toile, "convert", str(self.source), str(self.output), "--quiet", *self.options]
        killed = subprocess.Popen(command)
        time.sleep(after)
        killed.kill()
        if killed.wait() == 0:
            return None
        partial = self.folder / PARTIALS[self.suffix]
        expected = read_pc2(self.source)[1]
        if self.suffix == ".pvd":
            if not partial.exists():
                return 0
            vtk = Vtk(partial, argparse.Namespace(fps=24.0, first=0))
            x = np.array([vtk.positions("", k) for k in range(len(vtk.entries))])
        else:
            back = self.folder / "killed.pc2"
            done = subprocess.run([self.toile, "convert", str(partial), str(back), "--quiet"], capture_output=True,
                                  check=False)
            if done.returncode != 0:
                return 0
            x = read_pc2(back)[1]
        if not np.array_equal(x, expected[:len(x)]):
            sys.exit(f"{partial}: frames of a killed run differ from those of the whole one")
        return len(x)

    def kill_half_way(self, seconds):
        """@return frames that can be read after a kill in the middle of the run"""
        for _ in range(20):
            for file in self.folder.rglob("*"):
                if file.is_file():
                    file.unlink()
            frames = self.kill(0.5 * seconds)
            if frames is not None:
                return frames
            seconds *= 0.8
        return None


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as lines:
        names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{names[0] if names else 'unknown processor'}, {os.cpu_count()} threads"


def main():
    parser = argparse.ArgumentParser(description="Measure cache formats, and print a table in Markdown.")
    parser.add_argument("toile", help="the program")
    options = parser.parse_args()
    toile = str(pathlib.Path(options.toile).resolve())
    payload = 12 * COLUMNS * ROWS * FRAMES
    print(f"""# Cache formats, measured

{COLUMNS * ROWS} vertices, {FRAMES} frames: {payload / 1e6:.1f} MB of positions in single precision. Machine: {machine()}.
Made by `python3 tests/dcc/formats.py build/bin/toile` with the Python packages of `tests/dcc/requirements.txt`.

| format | reads back | other program, every frame | after a kill half way | size [MB] | writes [MB/s] | note |
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
            size = run.size()
            note = said.split(": ", 1)[1] if ": " in said else ""
            back, played = run.read_back(), run.play()
            frames = run.kill_half_way(seconds)
            print(f"| `{suffix}` | {back} | {played} | {frames} frames | {size / 1e6:.1f} | "
                  f"{payload / 1e6 / seconds:.0f} | {note} |", flush=True)
    print(f"""
The other program is Blender 5.0.1, for `.pvd` VTK 9.7.2; differences of 1e-7 m are its own rotation of axes in single
precision. Speed is that of `toile convert` from a PC2, its reading included, the fastest of {RUNS} runs. After a kill
those frames were read from the [partial](../guide/caches.md#when-a-run-is-killed) and equal those of the whole run;
half of the time is not half of the frames where a format computes or copies at the end (`.glb`, `.mdd`).""")
    return 0


if __name__ == "__main__":
    sys.exit(main())
