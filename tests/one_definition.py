#!/usr/bin/env python3
"""Finds types of one name that are defined twice: programs that link both would mix them without a word.

    one_definition.py --root ROOT   checks the sources of the tree
    one_definition.py --self-test   plants a type twice, and others that may be there twice

Reads namespaces and definitions as clang-format lays them out: from the first column on. Types of an anonymous
namespace belong to their file. Tests may repeat each other's names where no program has both. Failures are printed as
file:line. Exit code 1 if any.
"""

import argparse
import collections
import pathlib
import re
import sys
import tempfile

ROOMS = ["apps", "avatars", "collision", "core", "export", "garment", "quadrature2d", "research", "scenes",
         "tests", "volume"]
OPENS = re.compile(r"(?:inline )?namespace(?: ([\w:]+))? \{$")
CLOSES = re.compile(r"\} // namespace")
DEFINES = re.compile(r"(?:struct|class|union|enum|enum class)(?: alignas\([^)]*\))? (\w+)(?: final)?(?: :.*)?(?: \{.*)?$")
AHEAD = re.compile(r"[^{]*;$")  # of a declaration alone


def definitions(text):
    """(line number, qualified name) of every type that a file defines outside of anonymous namespaces."""
    spaces = []
    for number, line in enumerate(text.splitlines(), start=1):
        if opened := OPENS.match(line):
            spaces.append(opened[1])
        elif CLOSES.match(line):
            spaces.pop()
        elif None not in spaces and not AHEAD.match(line) and (defined := DEFINES.match(line)):
            yield number, "::".join([*spaces, defined[1]])


def program_of(path):
    """Folder of the test program that has this source; None: any program may have it, as headers of tests."""
    return path.parts[1] if path.parts[0] == "tests" and path.suffix in (".cpp", ".cu") else None


def failures(root):
    places = collections.defaultdict(list)
    for room in ROOMS:
        for path in sorted(root.joinpath(room).rglob("*")):
            if path.suffix in (".h", ".cuh", ".cpp", ".cu"):
                for number, name in definitions(path.read_text(encoding="utf-8")):
                    places[name].append((path.relative_to(root), number))
    if not places:
        yield f"{root}: has no types; name the root of the tree"
    for name, found in sorted(places.items()):
        for k, (path, number) in enumerate(found):
            others = [other for other, _ in found[:k] if program_of(other) in (None, program_of(path))
                      or program_of(path) is None]
            if others:
                yield f"{path}:{number}: {name} is defined in {others[0]} too; rename one of them, or move it into an " \
                      "anonymous namespace"


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        planted = {
            "core/a.cpp": "namespace toile {\n\nstruct Twice {\n};\n\nnamespace {\nclass Local {\n};\n} // namespace\n"
                          "enum class Side { kLeft };\n} // namespace toile\n",
            "core/b.h": "namespace toile {\nclass Twice : public Other {\n};\nclass Ahead;\nenum class Side { kLeft };\n\nnamespace {\nstruct Local {\n"
                        "};\n} // namespace\n} // namespace toile\nnamespace toile::other {\nstruct Twice {\n};\n"
                        "class Ahead;\n} // namespace toile::other\n",
            "tests/core/a.cpp": "struct Case {\n};\n",
            "tests/scenes/a.cpp": "struct Case {\n};\n",
        }
        for name, text in planted.items():
            root.joinpath(name).parent.mkdir(parents=True, exist_ok=True)
            root.joinpath(name).write_text(text, encoding="utf-8")
        found = list(failures(root))
        assert len(found) == 2, found
        assert found[0].startswith("core/b.h:5: toile::Side is defined in core/a.cpp too"), found
        assert found[1].startswith("core/b.h:2: toile::Twice is defined in core/a.cpp too"), found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path)
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_test:
        return self_test()
    found = list(failures(arguments.root))
    print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
