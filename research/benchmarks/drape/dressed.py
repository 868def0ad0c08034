#!/usr/bin/env python3
"""Garments that are draped on gc_mean_all.glb and follow a clip: a table in Markdown of what became of each.

Runs `toile drape --clip`, `toile simulate` and `toile check` for every outfit.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import tempfile
import time

DATA = pathlib.Path(os.environ.get("TOILE_DATA_DIR", "../shared/data"))
OUTFITS = [  # patterns of GarmentCode, innermost first; fabrics; clips
    (["tee_mean_all"], ["cotton"], ["walk", "dance"]),
    (["pants_mean_all"], ["denim"], ["walk"]),
    (["pants_mean_all", "tee_mean_all"], ["denim", "jersey"], ["walk", "dance"]),
    (["dress_gathered_mean_all"], ["cotton"], ["walk", "dance"]),
    (["dress_circle_mean_all"], ["cotton"], ["walk", "dance"]),
    (["circle_skirt_mean_all"], ["cotton"], ["walk"]),
    (["pencil_skirt_mean_all"], ["cotton"], ["walk"]),
    (["long_sleeve_turtle_mean_all"], ["jersey"], ["walk"]),
]


def run(*command):
    """Whether a command succeeded, its seconds, and the last line that it wrote to stderr."""
    start = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    lines = done.stderr.strip().splitlines()
    return done.returncode == 0, time.monotonic() - start, lines[-1] if lines else ""


def dress(toile, patterns, fabrics, clip, edge, threads, out):
    folder = out / ("_".join(patterns).replace("_mean_all", "") + "_" + clip)
    files = [DATA / "patterns/garmentcode" / f"{name}_specification.json" for name in patterns]
    row = {"name": folder.name}
    is_done, row["drape"], row["says"] = run(
        toile, "drape", *files, "--avatar", DATA / "avatars/gc_mean_all.glb", "--clip", clip, "--fabric",
        ",".join(fabrics), "--edge", edge, "--threads", threads, "--time-limit", 3600, "-o", folder, "--quiet")
    if not is_done:
        return row
    is_done, row["simulate"], row["says"] = run(
        toile, "simulate", folder / "scene.json", "--threads", threads, "-o", folder / "simulated", "--quiet")
    if not is_done:
        return row
    _, row["check"], row["says"] = run(toile, "check", folder / "simulated", "--scene",
                                          folder / "scene.json", "--quiet")
    certificate = json.loads((folder / "simulated/certificate.json").read_text())
    row["frames"], row["holds"] = certificate["frames"], certificate["holds"]
    row["strain"], row["depth"] = certificate["max_strain"], certificate["max_penetration_m"]
    return row


def text(row):
    if "frames" not in row:
        return f"| {row['name']} | {row['drape']:.0f} | | | | | {row['says']} |"
    return (f"| {row['name']} | {row['drape']:.0f} | {row['simulate']:.0f} | {row['frames']} | "
            f"{100 * row['strain']:.1f} | {1000 * row['depth']:.1f} | "
            f"{'holds' if row['holds'] else row['says']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--toile", default="build/bin/toile")
    parser.add_argument("--edge", type=float, default=0.02, help="[m]")
    parser.add_argument("--threads", type=int, default=2, help="of each run")
    parser.add_argument("--jobs", type=int, default=1, help="runs at once")
    parser.add_argument("--out", type=pathlib.Path, help="keeps the results")
    parser.add_argument("--only", default="", help="part of a row's name")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        out = args.out or pathlib.Path(temporary)
        rows = [pool.submit(dress, args.toile, patterns, fabrics, clip, args.edge, args.threads, out)
                for patterns, fabrics, clips in OUTFITS for clip in clips
                if args.only in "_".join(patterns) + "_" + clip]
        print("| outfit, clip | drape s | simulate s | frames | strain max % | depth mm | certificate |")
        print("|---|---|---|---|---|---|---|")
        for row in rows:
            print(text(row.result()), flush=True)


if __name__ == "__main__":
    main()
