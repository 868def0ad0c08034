#!/usr/bin/env python3
"""Bodies that are moved through a hanging curtain, by shape, thickness and speed: a table in Markdown.

An arm of 80 cm (capsule, box, mesh) or a ball crosses 60 cm; the curtain of 0.8 x 1 m has cells of 4 cm. A cell says
  carried   the certificate holds
  ...       else what failed first, and whether the run has said so: "(told)" or "(SILENT)"
"""

import argparse
import collections
import json
import math
import pathlib
import subprocess
import tempfile

SPEEDS = [1, 5, 10, 20, 40]  # m/s
THICKNESSES = [0.02, 0.04, 0.08]  # m
SHAPES = ["capsule", "sphere", "box", "mesh"]


def write_arm(file, radius, length=0.8, around=12, along=16):
    """Closed cylinder along x, as an OBJ."""
    lines = []
    for j in range(along + 1):
        for i in range(around):
            angle = 2 * math.pi * i / around
            lines.append(f"v {length * (j / along - 0.5)} {radius * math.cos(angle)} {radius * math.sin(angle)}")
    lines += [f"v {-length / 2} 0 0", f"v {length / 2} 0 0"]
    first, last = (along + 1) * around + 1, (along + 1) * around + 2
    for j in range(along):
        for i in range(around):
            a, b = j * around + i + 1, j * around + (i + 1) % around + 1
            lines.append(f"f {a} {b} {b + around} {a + around}")
    for i in range(around):
        a, b = i + 1, (i + 1) % around + 1
        lines += [f"f {b} {a} {first}", f"f {along * around + a} {along * around + b} {last}"]
    file.write_text("\n".join(lines) + "\n")


def body_of(shape, thickness, folder):
    if shape == "capsule":
        return {"rotate_deg": [0, 0, 90], "capsule": {"radius": thickness / 2, "length": 0.8}}
    if shape == "sphere":
        return {"sphere": {"radius": thickness / 2}}
    if shape == "box":
        return {"box": {"size": [0.8, thickness, thickness]}}
    write_arm(folder / "arm.obj", thickness / 2)
    return {"file": "arm.obj"}


def scene_of(shape, thickness, speed, folder):
    begin, way = 0.3, 0.6
    return {
        "toile": 1,
        "frames": math.ceil((begin + way / speed) * 30) + 6,
        "avatars": [{
            "name": "arm", "translate": [0, 0.6, 0.3],
            "keyframes": [{"time": begin}, {"time": begin + way / speed, "translate": [0, 0, -way]}],
            **body_of(shape, thickness, folder)}],
        "cloths": [{"name": "curtain", "rectangle": {"size": [0.8, 1], "resolution": 0.04},
                    "rotate_deg": [90, 0, 0], "translate": [0, 0.6, 0]}],
        "attachments": [{"cloth": "curtain",
                         "select": {"box": {"lower": [-1, 1.08, -1], "upper": [1, 1.2, 1]}}}]}


def result_of(folder, run):
    found = json.loads((folder / "out/certificate.json").read_text())
    if found["holds"]:
        return "carried"
    frames = json.loads((folder / "run.json").read_text())["frames"]
    status = collections.Counter(frame["status"] for frame in frames)
    told = any(status[word] for word in ("yielded", "pinched", "stuck")) and run.returncode != 0
    what = (f"{found['passages']} points passed" if found["passages"] else
            f"{1e3 * found['max_penetration_m']:.0f} mm deep" if found["max_penetration_m"] > 1e-3 else
            f"{found['cloth_avatar_crossings']} crossings" if found["cloth_avatar_crossings"] else
            f"strain {found['max_strain']:.2f}")
    return what + (" (told)" if told else " (SILENT)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--toile", required=True, type=pathlib.Path, help="the program")
    parser.add_argument("--threads", default="1")
    parser.add_argument("--limit", default=120, type=float, help="seconds a run may take")
    options = parser.parse_args()
    print("| body | cm | " + " | ".join(f"{speed} m/s" for speed in SPEEDS) + " |")
    print("|---|---|" + "---|" * len(SPEEDS))
    for shape in SHAPES:
        for thickness in THICKNESSES:
            cells = []
            for speed in SPEEDS:
                with tempfile.TemporaryDirectory() as name:
                    folder = pathlib.Path(name)
                    (folder / "scene.json").write_text(json.dumps(scene_of(shape, thickness, speed, folder)))
                    try:
                        run = subprocess.run(
                            [options.toile.resolve(), "simulate", "scene.json", "-o", "out", "--report", "run.json",
                             "--threads", options.threads, "--quiet"],
                            cwd=folder, capture_output=True, timeout=options.limit)
                        cells.append(result_of(folder, run))
                    except subprocess.TimeoutExpired:
                        cells.append(f"above {options.limit:g} s")
            print(f"| {shape} | {100 * thickness:g} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
