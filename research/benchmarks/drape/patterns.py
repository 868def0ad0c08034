#!/usr/bin/env python3
"""Sewing patterns by `toile drape`: a table in Markdown of what became of each.

Patterns of GarmentCode are draped on gc_mean_all.obj in cotton. The older templates are on smpl_f_template.obj: skirts
in cotton, the others in jersey, as they are cut narrower than that body (bust 87 of 97 cm).
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import tempfile

DATA = pathlib.Path(os.environ.get("TOILE_DATA_DIR", "../shared/data"))
JERSEY = ["tee", "dress_sleeveless", "pants_flare"]  # templates
STAGES = ["mesh", "sew", "press", "settle", "drape"]


def garments():
    for file in sorted(DATA.glob("patterns/garmentcode/*_specification.json")):
        yield file, "gc_mean_all.obj", "cotton"
    for file in sorted(DATA.glob("patterns/garment_pattern_generator/*.json")):
        if "pattern" in json.loads(file.read_text()):
            yield file, "smpl_f_template.obj", "jersey" if file.stem in JERSEY else "cotton"


def drape(toile, file, body, fabric, edge, threads, limit, out):
    folder = out / f"{file.parent.name}_{file.stem}"
    subprocess.run([toile, "drape", file, "--avatar", DATA / "bodies" / body, "--fabric", fabric, "--edge", str(edge),
                    "--threads", str(threads), "--time-limit", str(limit), "-o", folder, "--quiet"],
                   capture_output=True, check=False)
    report = folder / "drape.json"
    return json.loads(report.read_text()) if report.exists() else {"class": "no report", "message": ""}


def row(file, fabric, report):
    name = file.stem.removesuffix("_specification").removesuffix("_mean_all")
    seconds = {stage: 0.0 for stage in STAGES}
    for stage in report.get("stages", []):
        seconds[stage["name"]] += stage["seconds"]
    gaps = [seam["gap_before_weld_m"] for seam in report.get("seams", []) if seam["gap_before_weld_m"] is not None]
    strain = report.get("strain", {}).get(fabric, {"max": 0.0, "p99": 0.0, "mean": 0.0})
    return (f"| {name} | {fabric} | {report.get('vertices', 0)} | "
            + " | ".join(f"{seconds[stage]:.1f}" for stage in STAGES)
            + f" | {1000 * max(gaps, default=0.0):.1f} | {100 * strain['max']:.1f} / {100 * strain['p99']:.1f} / "
            f"{100 * strain['mean']:.1f} | {report.get('pieces', 0)}, {report.get('border_loops', 0)}, "
            f"{report.get('euler_characteristic', 0)} | {report['class']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--toile", default="build/bin/toile")
    parser.add_argument("--edge", type=float, default=0.02, help="[m]")
    parser.add_argument("--threads", type=int, default=2, help="of each drape")
    parser.add_argument("--jobs", type=int, default=1, help="drapes at once")
    parser.add_argument("--time-limit", type=float, default=600, help="[s] of each")
    parser.add_argument("--out", type=pathlib.Path, help="keeps the results")
    parser.add_argument("--only", default="", help="part of a file's name")
    options = parser.parse_args()
    print("| pattern | fabric | vertices | mesh s | sew s | press s | settle s | drape s | widest gap mm | "
          "strain max / p99 / mean % | pieces, loops, Euler | class |\n" + "|---" * 12 + "|", flush=True)
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        out = options.out or pathlib.Path(temporary)
        chosen = [garment for garment in garments() if options.only in garment[0].stem]
        reports = pool.map(lambda g: drape(options.toile, *g, options.edge, options.threads, options.time_limit, out),
                           chosen)
        messages = []
        for (file, _, fabric), report in zip(chosen, reports):
            print(row(file, fabric, report), flush=True)
            if report["message"]:
                messages.append(f"* {file.stem}: {report['message']}")
    print("\n" + "\n".join(messages))


if __name__ == "__main__":
    main()
