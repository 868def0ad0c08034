#!/usr/bin/env python3
"""Writes a small cache in every format with toile, and compares each, as another program plays it, frame by frame.

    python3 tests/dcc/compare_all.py build/bin/toile build/dcc/caches

Prints a table, and exits with 1 if a comparison fails. A format that this toile does not write is SKIPPED.
"""

import argparse
import pathlib
import sys

from conversion import FORMATS, compare, convert, script, writes


def comparisons(folder):
    """Source, target, options of toile convert, options of compare.py, references."""
    skirt, both = [folder / "skirt.pc2"], [folder / "skirt.pc2", folder / "tee.pc2"]
    faces = ["--mesh", str(folder / "skirt.obj"), "--fps", "24"]
    other = ["--unit", "cm", "--up", "z", "--start-frame", "1001"]
    all_of = [("skirt.pc2", name, faces, ["--mesh", folder / "skirt.obj"], skirt) for name in FORMATS.values()]
    for suffix in (".mdd", ".abc", ".usda", ".usdc", ".obj", ".ply", ".pvd"):
        name = "maya" + FORMATS[suffix].removeprefix("skirt")
        all_of.append(("skirt.pc2", name, faces + other, ["--mesh", folder / "skirt.obj", *other], skirt))
    # glTF is in metres with Y up and begins at 0, whatever is asked for.
    all_of.append(("skirt.pc2", "maya.glb", faces + other, [], skirt))
    for suffix in (".abc", ".usda", ".usdc", ".glb"):
        all_of.append(("outfit.abc", "both" + suffix, [], [], both))
    return all_of


def main():
    parser = argparse.ArgumentParser(description="Compare caches of all formats, as other programs play them.")
    parser.add_argument("toile", help="the program")
    parser.add_argument("folder", type=pathlib.Path, help="for the caches")
    options = parser.parse_args()
    code, _, errors = script("make_cache.py", options.folder)
    if code != 0:
        sys.exit(errors)
    failed = skipped = 0
    print("| cache | options | result | of each mesh |\n|---|---|---|---|")
    for source, target, to_convert, to_compare, references in comparisons(options.folder):
        shown = " ".join(word for word in to_convert if str(options.folder) not in word and word != "--mesh")
        if not writes(options.toile, pathlib.Path(target).suffix):
            print(f"| {target} | {shown} | SKIPPED | this toile does not write it |")
            skipped += 1
            continue
        output = options.folder / "written" / target
        convert(options.toile, options.folder / source, output, *to_convert)
        is_equal, said = compare(output, references, *to_compare)
        print(f"| {target} | {shown} | {'equal' if is_equal else 'FAILED'} | {' <br> '.join(said)} |", flush=True)
        failed += not is_equal
    print(f"\n{failed} failed, {skipped} skipped")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
