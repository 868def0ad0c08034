"""Runs `toile convert`, and other scripts of this folder."""

import os
import pathlib
import subprocess
import sys
import time

FOLDER = pathlib.Path(__file__).parent

# The packages of requirements.txt are in this interpreter, Pixar's USD among them.
os.environ.setdefault("TOILE_PYTHON", sys.executable)

# Extensions of caches that Toile writes, in the order of tables; names of files of several frames.
FORMATS = {".pc2": "skirt.pc2", ".mdd": "skirt.mdd", ".abc": "skirt.abc", ".usda": "skirt.usda", ".usdc": "skirt.usdc",
           ".glb": "skirt.glb", ".obj": "skirt_####.obj", ".ply": "skirt_####.ply", ".pvd": "skirt.pvd"}


def convert(toile, source, target, *options):
    """@return seconds, and the line that it says; ends the script if it fails"""
    command = [toile, "convert", str(source), str(target), "--quiet", *options]
    start = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    return time.perf_counter() - start, done.stdout.strip()


def writes(toile, suffix):
    """Whether this toile knows an extension."""
    done = subprocess.run([toile, "convert", "--help"], capture_output=True, text=True, check=True)
    return suffix in done.stdout


def script(name, *arguments):
    """@return exit code, and the lines that it prints, without what the programs in it say"""
    done = subprocess.run([sys.executable, str(FOLDER / name), *map(str, arguments)], capture_output=True, text=True,
                          check=False)
    return done.returncode, done.stdout.splitlines(), done.stderr.strip()


def compare(cache, references, *options):
    """@return whether every frame is equal or within the error of the format, and what compare.py says of it"""
    code, lines, errors = script("compare.py", cache, *references, *options)
    said = [line.removeprefix(f"{cache}: ") for line in lines if "largest difference" in line]
    return code == 0, said or [errors.splitlines()[-1] if errors else "nothing was said"]
