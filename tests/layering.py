#!/usr/bin/env python3
"""Holds the tree to its layers: who may include whom, who owns which third-party library, how long files get.

    layering.py --root ROOT [--layers FILE]   checks the tree; FILE lists the modules as CMake knows them
    layering.py --self-test                   plants one violation of each kind and expects to find it

FILE has one "module:dependency;dependency" per line, the global property TOILE_LAYERS of
cmake/AddModule.cmake. Failures are printed as file:line: what is wrong and what to do. Exit code 1 if any.
"""

import argparse
import os
import re
import sys
import tempfile

MAX_LINES = 600

# Which folders of ours each folder's files may include, besides their own. Bottom of the order first; the
# longest matching folder counts.
BELOW_SCENES = ["core", "quadrature2d", "volume", "collision", "avatars", "garment"]
MAY_INCLUDE = {
    "core/backend": [],
    "core/mesh": ["core/backend"],
    "core/linear": ["core/backend", "core/mesh"],
    "core/quadrature": ["core/backend", "core/mesh", "core/linear"],
    "core/pd": ["core/backend", "core/mesh", "core/linear", "core/quadrature"],
    "quadrature2d": ["core"],
    "volume": ["core"],
    "collision": ["core"],
    # Certifies what contact detection did, so it knows nothing of it.
    "collision/crossings": ["core", "collision/distance.h", "collision/surface_edges.h"],
    "collision/untangle": ["core", "collision", "collision/crossings"],
    "avatars": ["core"],
    "export": ["core"],
    "garment": ["core", "quadrature2d"],
    "scenes/format": BELOW_SCENES,
    "scenes": BELOW_SCENES + ["scenes/format"],
    "apps/render": BELOW_SCENES + ["scenes", "export"],
    "apps/toile": BELOW_SCENES + ["scenes", "export", "apps/render", "benchmarks"],
    "python": BELOW_SCENES + ["scenes", "export"],
    "benchmarks/quadrature": ["core", "quadrature2d"],
    "benchmarks": ["core", "quadrature2d", "garment", "collision", "avatars", "scenes"],
    "tests": BELOW_SCENES + ["scenes", "export", "apps", "benchmarks"],
}

# Modules of CMake whose name is not their folder.
FOLDER_OF_MODULE = {"scene_format": "scenes/format", "render": "apps/render",
                    "quadrature_figures": "benchmarks/quadrature", "crossings": "collision/crossings",
                    "untangle": "collision/untangle"}

# Third-party headers by the start of their name, and the folders that own them. None: everybody may.
# Tests may use any, as an oracle.
OWNERS = {
    r"(unsupported/)?Eigen/": None,
    r"(suitesparse/)?(cholmod|SuiteSparse_config|umfpack|amd|camd|colamd|metis)\b": ["core/linear"],
    r"(cuda|cublas|cusparse|cusolver|cooperative_groups|nvtx)|(cub|thrust|nv)/": ["core/backend"],
    r"(tbb|oneapi|experimental)/": ["core/backend"],
    r"xxhash\.h": ["core/backend"],
    r"embree[34]/": ["collision", "benchmarks/near_pairs"],  # the benchmark times Embree against collision
    r"assimp/": ["avatars"],
    r"CGAL/": ["collision/crossings", "garment/pattern"],
    r"(libpng/)?png\.h": ["apps/render"],
    r"boost/multiprecision/": [],  # comes with CGAL; rational numbers of the tests
    r"nlohmann/": ["scenes/format", "apps"],
    r"CLI/": ["apps"],
    r"benchmark/": ["benchmarks"],
    r"g(test|mock)/": [],
}
# Libraries that headers may show to everybody: TBB and vector types, because kernels are templates.
SHOWN_TO_ALL = r"(tbb|oneapi|experimental)/"

# The C++ library, C, and POSIX or processor headers.
SYSTEM_HEADER = re.compile(
    r"[a-z_]+$|(assert|errno|fcntl|float|glob|limits|math|poll|pthread|pwd|sched|signal|spawn|std\w+|string"
    r"|strings|malloc|time|unistd|immintrin|xmmintrin|x86intrin)\.h$|sys/\w+\.h$")

CODE = (".h", ".cpp", ".cu", ".cuh", ".py", ".cmake", ".sh", ".txt")
CXX = (".h", ".cpp", ".cu", ".cuh")
FORBIDDEN_FOLDERS = ("utils", "util", "helpers")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def is_below(path, folder):
    return path == folder or path.startswith(folder + "/")


def folders_of_tree(root):
    """Folders of the tree relative to root with their files; without what is hidden, built or produced."""
    for folder, subfolders, files in os.walk(root):
        top = folder == root
        subfolders[:] = sorted(name for name in subfolders if not name.startswith(".") and not (
            top and (name in ("build", "out") or name.startswith("build-"))))
        yield os.path.relpath(folder, root).replace(os.sep, "/"), sorted(files)


def layer_of(path):
    """The longest folder of MAY_INCLUDE that the path lies in, or None."""
    layers = [folder for folder in MAY_INCLUDE if is_below(path, folder)]
    return max(layers, key=len, default=None)


def read_layers(file):
    """Dependencies per module from the file that CMake wrote."""
    modules = {}
    with open(file, encoding="utf-8") as lines:
        for line in lines:
            if ":" in line:
                name, dependencies = line.strip().split(":", 1)
                modules[name] = [word for word in dependencies.split(";") if word]
    return modules


def folder_of_module(module):
    return FOLDER_OF_MODULE.get(module, module)


def module_of(path, modules):
    """The module of CMake that the path belongs to, or None (programs and tests are no modules)."""
    owners = [module for module in modules if is_below(path, folder_of_module(module))]
    return max(owners, key=lambda module: len(folder_of_module(module)), default=None)


class Check:
    def __init__(self, root, modules):
        self.root = root
        self.modules = modules
        self.failures = []
        self.used = {module: set() for module in modules}  # modules that each module includes
        self.own_includes = []  # (file, line, header) within the tree
        self.foreign = {}  # header of ours -> third-party headers that whoever includes it sees too

    def fail(self, file, line, what):
        self.failures.append(f"{file}:{line}: {what}")

    def tree(self):
        for folder, files in folders_of_tree(self.root):
            if os.path.basename(folder) in FORBIDDEN_FOLDERS:
                self.fail(folder, 1, "no folder is called so; move each file to its first user")
            for name in files:
                if name.endswith(CODE):
                    self.file(name if folder == "." else f"{folder}/{name}")
        self.declared_dependencies()
        self.shown_libraries()
        return self.failures

    def file(self, file):
        with open(os.path.join(self.root, file), encoding="utf-8") as stream:
            lines = stream.read().splitlines()
        if len(lines) > MAX_LINES and "_generated." not in file:
            self.fail(file, MAX_LINES + 1, f"the file has {len(lines)} lines, at most {MAX_LINES} may be; split it")
        if not file.endswith(CXX):
            return
        for number, text in enumerate(lines, start=1):
            if match := INCLUDE.match(text):
                quote, header = match.groups()
                if quote == '"':
                    self.own_include(file, number, header)
                else:
                    self.foreign_include(file, number, header)

    def own_include(self, file, line, header):
        if not os.path.isfile(os.path.join(self.root, header)):
            self.fail(file, line, f'"{header}" is no file of the tree; write it from the root, '
                                  "or a third party's in <>")
            return
        self.own_includes.append((file, line, header))
        layer, target = layer_of(file), layer_of(header)
        if layer is None or target is None:
            stranger = file if layer is None else header
            self.fail(file, line, f"{stranger} is in no known layer; add its folder to {os.path.basename(__file__)}")
            return
        if target != layer and not any(is_below(header, folder) for folder in MAY_INCLUDE[layer]):
            allowed = ", ".join(MAY_INCLUDE[layer]) or "nothing of ours"
            self.fail(file, line, f"{layer} may not include {header}; it may include {allowed}")
            return

        module, used = module_of(file, self.modules), module_of(header, self.modules)
        if module and used and module != used:
            self.used[module].add(used)
            if used not in self.modules[module]:
                self.fail(file, line, f"includes {header}, but DEPENDS of add_module({module}) lacks {used}")

    def foreign_include(self, file, line, header):
        for start, owners in OWNERS.items():
            if not re.match(start, header):
                continue
            if owners is None or is_below(file, "tests"):
                return
            if not any(is_below(file, folder) for folder in owners):
                self.fail(file, line, f"<{header}> belongs to {' and '.join(owners) or 'tests'} alone; "
                                      "go through that folder's interface")
            elif not re.match(SHOWN_TO_ALL, header):
                self.foreign.setdefault(file, {})[header] = owners
            return
        if not SYSTEM_HEADER.match(header):
            self.fail(file, line, f"<{header}> has no owner; name one in {os.path.basename(__file__)}")

    def declared_dependencies(self):
        """What CMake declares must be allowed and used."""
        for module, dependencies in self.modules.items():
            folder = folder_of_module(module)
            file = f"{folder}/CMakeLists.txt"
            layer = layer_of(folder)
            for dependency in dependencies:
                target = folder_of_module(dependency)
                # Where single headers of a module may be included, so may it be linked.
                if layer and not any(is_below(target, allowed) or is_below(allowed, target)
                                     for allowed in MAY_INCLUDE[layer]):
                    self.fail(file, self.line_of(file, dependency), f"{folder} may not depend on {target}")
                elif dependency not in self.used[module]:
                    self.fail(file, self.line_of(file, dependency),
                              f"{module} depends on {dependency} but includes none of its headers")

    def shown_libraries(self):
        """Headers that show a library may be included, through any chain of headers, by its owners only."""
        grown = True
        while grown:
            before = sum(map(len, self.foreign.values()))
            for file, _, header in self.own_includes:
                if header in self.foreign and not is_below(file, "tests"):
                    self.foreign.setdefault(file, {}).update(self.foreign[header])
            grown = sum(map(len, self.foreign.values())) > before

        for file, line, header in self.own_includes:
            for library, owners in self.foreign.get(header, {}).items():
                if not any(is_below(file, folder) for folder in owners + ["tests"]):
                    self.fail(file, line, f"{header} shows <{library}>, which belongs to {' and '.join(owners)} "
                                          "alone; include the library in source files or private headers there")

    def line_of(self, file, word):
        """The first line after DEPENDS that holds the word; 1 where there is none."""
        try:
            with open(os.path.join(self.root, file), encoding="utf-8") as stream:
                lines = stream.read().splitlines()
        except FileNotFoundError:
            return 1
        start = next((i for i, text in enumerate(lines) if "DEPENDS" in text), 0)
        return next((i + 1 for i in range(start, len(lines)) if re.search(rf"\b{word}\b", lines[i])), 1)


# A small tree that obeys every rule.
GOOD_TREE = {
    "core/CMakeLists.txt": "add_module(core SOURCES mesh/a.cpp)\n",
    "core/backend/types.h": "#include <Eigen/Core>\n#include <tbb/parallel_for.h>\n",
    "core/mesh/a.h": '#include "core/backend/types.h"\n',
    "core/mesh/a.cpp": '#include "core/mesh/a.h"\n#include <vector>\n#include <sys/stat.h>\n',
    "core/linear/solver.cpp": "#include <cholmod.h>\n",
    "garment/CMakeLists.txt": "add_module(garment\n    SOURCES cloth.cpp\n    DEPENDS core)\n",
    "garment/cloth.cpp": '#include "core/mesh/a.h"\n',
    "collision/near.cpp": "#include <embree3/rtcore.h>\n",
    "collision/near.h": "#include <vector>\n",
    "tests/core/a_test.cpp": '#include "core/mesh/a.h"\n#include <gtest/gtest.h>\n#include <nlohmann/json.hpp>\n',
    "build/generated/x.cpp": "#include <nowhere/x.h>\n",
}
GOOD_MODULES = {"core": [], "garment": ["core"], "collision": []}

# Files to replace, modules to replace, and the start of the failure expected.
VIOLATIONS = [
    ({"core/backend/types.h": '\n#include "core/mesh/a.h"\n'}, {},
     "core/backend/types.h:2: core/backend may not include core/mesh/a.h"),
    ({"garment/cloth.cpp": '#include "core/mesh/a.h"\n#include "collision/near.h"\n'}, {},
     "garment/cloth.cpp:2: garment may not include collision/near.h"),
    ({"core/mesh/a.cpp": '#include "tests/core/a_test.cpp"\n'}, {},
     "core/mesh/a.cpp:1: core/mesh may not include tests/core/a_test.cpp"),
    ({"core/mesh/a.cpp": '#include "a.h"\n'}, {}, 'core/mesh/a.cpp:1: "a.h" is no file of the tree'),
    ({"collision/near.cpp": '#include "core/mesh/a.h"\n'}, {},
     "collision/near.cpp:1: includes core/mesh/a.h, but DEPENDS of add_module(collision) lacks core"),
    ({"garment/cloth.cpp": "#include <vector>\n"}, {},
     "garment/CMakeLists.txt:3: garment depends on core but includes none of its headers"),
    ({}, {"garment": ["core", "collision"]}, "garment/CMakeLists.txt:1: garment may not depend on collision"),
    ({"garment/cloth.cpp": '#include "core/mesh/a.h"\n#include <embree3/rtcore.h>\n'}, {},
     "garment/cloth.cpp:2: <embree3/rtcore.h> belongs to collision and benchmarks/near_pairs alone"),
    ({"collision/crossings/find.cpp": '#include "collision/near.h"\n'}, {},
     "collision/crossings/find.cpp:1: collision/crossings may not include collision/near.h"),
    ({"core/pd/step.cpp": "#include <suitesparse/cholmod.h>\n"}, {},
     "core/pd/step.cpp:1: <suitesparse/cholmod.h> belongs to core/linear alone"),
    ({"core/mesh/a.cpp": "#include <gtest/gtest.h>\n"}, {},
     "core/mesh/a.cpp:1: <gtest/gtest.h> belongs to tests alone"),
    ({"collision/near.h": '#include "collision/tree.h"\n', "collision/tree.h": "#include <embree3/rtcore.h>\n",
      "tests/core/b_test.cpp": '#include "collision/near.h"\n', "apps/toile/main.cpp": '#include "collision/near.h"\n'},
     {}, "apps/toile/main.cpp:1: collision/near.h shows <embree3/rtcore.h>, which belongs to collision and benchmarks/near_pairs alone"),
    ({"core/mesh/a.cpp": "#include <boost/any.hpp>\n"}, {}, "core/mesh/a.cpp:1: <boost/any.hpp> has no owner"),
    ({"extras/a.cpp": '#include "core/mesh/a.h"\n'}, {}, "extras/a.cpp:1: extras/a.cpp is in no known layer"),
    ({"core/mesh/long.cpp": "\n" * 601}, {}, "core/mesh/long.cpp:601: the file has 601 lines"),
    ({"core/utils/a.h": ""}, {}, "core/utils:1: no folder is called so"),
]


def check_planted(files, modules):
    with tempfile.TemporaryDirectory() as root:
        for name, content in {**GOOD_TREE, **files}.items():
            path = os.path.join(root, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as stream:
                stream.write(content)
        return Check(root, {**GOOD_MODULES, **modules}).tree()


def self_test():
    mistakes = [f"the good tree fails: {failure}" for failure in check_planted({}, {})]
    for files, modules, expected in VIOLATIONS:
        failures = check_planted(files, modules)
        if len(failures) != 1 or not failures[0].startswith(expected):
            mistakes.append(f"expected one failure '{expected}...', got {failures}")
    return mistakes


def main():
    parser = argparse.ArgumentParser(description="Checks the layers of the tree.")
    parser.add_argument("--root", default=os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    parser.add_argument("--layers", help="modules and their DEPENDS, written by CMake")
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()

    if arguments.self_test:
        failures, done = self_test(), f"{len(VIOLATIONS)} planted violations found"
    else:
        modules = read_layers(arguments.layers) if arguments.layers else {}
        failures, done = Check(arguments.root, modules).tree(), "the layers hold"
    print("\n".join(failures) if failures else done)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
