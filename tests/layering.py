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
MAX_FILES = 25  # sources of a folder

# Rooms, bottom of the order first, and which rooms each one's files may include besides its own. cuda/ and cpu/
# belong to the room that they lie in. The longest matching folder counts. A room that is listed alone stands for
# all that lies in it.
CORE = ["core"]
MAY_INCLUDE = {
    "core/base": [],
    "core/compute/cuda/runtime": ["core/base"],
    "core/compute": ["core/base", "core/compute/cuda/runtime"],
    "core/time": [],
    "core/mesh": ["core/base", "core/compute"],
    "core/linear": ["core/base", "core/compute", "core/mesh"],
    "core/quadrature/clusters": ["core/base", "core/compute", "core/mesh", "core/linear"],
    "core/quadrature/tables": ["core/base", "core/compute", "core/mesh", "core/linear", "core/quadrature/clusters"],
    "core/quadrature": ["core/base", "core/compute", "core/mesh", "core/linear", "core/quadrature/clusters",
                        "core/quadrature/tables"],
    "core/pd/energy": ["core/base", "core/compute", "core/mesh", "core/linear"],
    "core/pd/preconditioner": ["core/base", "core/compute", "core/linear", "core/pd/energy"],
    "core/pd/minimiser": ["core/base", "core/compute", "core/linear", "core/pd/energy"],
    "core/pd/newton": ["core/base", "core/compute", "core/linear", "core/quadrature/clusters", "core/pd/energy",
                       "core/pd/minimiser"],
    "core/pd/step": ["core/base", "core/compute", "core/linear", "core/quadrature/clusters", "core/pd/energy",
                     "core/pd/preconditioner", "core/pd/minimiser", "core/pd/newton"],
    "core/pd/rigid": ["core/base", "core/compute", "core/mesh", "core/pd/energy"],
    "core/pd/cuda": ["core/base", "core/compute", "core/linear", "core/quadrature", "core/pd/energy",
                     "core/pd/preconditioner", "core/pd/minimiser", "core/pd/newton", "core/pd/step"],
    "quadrature2d": CORE,
    "volume/mesh": CORE,
    "volume/meshing": CORE + ["volume/mesh"],
    "volume/energy": CORE + ["volume/mesh"],
    "garment/fabric": CORE,
    "garment/energy": CORE,
    "garment/energy/air": CORE + ["garment/energy"],
    "garment/energy/fold": CORE + ["garment/energy"],
    "garment/energy/strain_limit": CORE + ["garment/energy"],
    "garment/pattern": CORE + ["garment/energy", "quadrature2d"],
    "garment/pattern/place": CORE + ["garment/pattern"],
    "garment/pattern/mesh": CORE + ["garment/pattern"],
    "garment/seam": CORE,
    "collision/bvh": CORE,
    "collision/geometry": CORE + ["collision/bvh"],
    "collision/body": CORE + ["collision/bvh", "collision/geometry"],
    "collision/self": CORE + ["collision/bvh", "collision/geometry", "collision/body"],
    "collision/ccd": CORE + ["collision/bvh", "collision/geometry", "collision/self"],
    "collision/contact": CORE + ["collision/bvh", "collision/geometry", "collision/body", "collision/self",
                                 "collision/ccd"],
    # Certifies what contact detection did, so it knows nothing of its searches and rules.
    "collision/check": CORE + ["collision/bvh", "collision/geometry"],
    "collision/repair": CORE + ["collision/bvh", "collision/geometry", "collision/body", "collision/self",
                                "collision/ccd", "collision/contact", "collision/check"],
    "collision/skin": CORE + ["collision/bvh", "collision/check"],
    "avatars/model": CORE,
    "avatars/import": CORE + ["avatars/model"],
    "avatars/appearance": CORE + ["avatars/model", "avatars/import"],
    "avatars/mannequin": CORE + ["avatars/model"],
    "avatars/landmarks": CORE + ["avatars/model"],
    "avatars": CORE + ["avatars/model", "avatars/import", "avatars/mannequin", "avatars/landmarks"],
    "export": CORE,
}
BELOW_SCENES = CORE + ["quadrature2d", "volume", "collision", "avatars", "garment"]
MAY_INCLUDE |= {
    "scenes/format": BELOW_SCENES + ["export"],
    "scenes/garment_format": BELOW_SCENES + ["scenes/format"],
    "scenes/meshes": BELOW_SCENES + ["export", "scenes/format"],
    "scenes/colliders": BELOW_SCENES + ["export", "scenes/format", "scenes/meshes"],
    "scenes/method": BELOW_SCENES + ["scenes/format"],
    "scenes/surfaces": BELOW_SCENES + ["scenes/format", "scenes/meshes", "scenes/colliders"],
    "scenes/drape": BELOW_SCENES + ["scenes/colliders", "scenes/format", "scenes/garment_format", "scenes/world"],
    "scenes/world": BELOW_SCENES + ["scenes/format", "scenes/meshes", "scenes/colliders", "scenes/method",
                                    "scenes/surfaces"],
}
BELOW_APPS = BELOW_SCENES + ["scenes", "export"]
MAY_INCLUDE |= {
    "toile.h": BELOW_APPS,
    "apps/preview": BELOW_APPS,
    "apps/toile/terminal": BELOW_APPS,
    "apps/toile/cloth": BELOW_APPS,
    "apps/toile/caches": BELOW_APPS + ["apps/toile/terminal", "apps/toile/cloth"],
    "apps/toile/check": BELOW_APPS + ["apps/toile/terminal", "apps/toile/cloth", "apps/toile/caches"],
    "apps/toile/convert": BELOW_APPS + ["apps/toile/terminal", "apps/toile/caches", "apps/toile/check"],
    "apps/toile/maps": BELOW_APPS + ["apps/toile/cloth", "apps/preview"],
    "apps/toile/render": BELOW_APPS + ["apps/toile/terminal", "apps/toile/cloth", "apps/toile/caches", "apps/toile/check",
                                       "apps/toile/maps", "apps/preview"],
    "apps/toile/simulate": BELOW_APPS + ["apps/toile/terminal", "apps/toile/caches", "apps/toile/check"],
    "apps/toile/fit": BELOW_APPS + ["apps/toile/terminal", "apps/toile/cloth", "apps/toile/caches", "apps/toile/check",
                                    "apps/toile/maps", "apps/preview"],
    "apps/toile/pattern": BELOW_APPS + ["apps/toile/terminal"],
    "apps/toile/drape": BELOW_APPS + ["apps/toile/terminal", "apps/toile/cloth", "apps/toile/caches", "apps/toile/check",
                                      "apps/toile/render", "apps/toile/fit", "apps/toile/pattern", "apps/preview"],
    "apps/toile": BELOW_APPS + ["apps/toile/terminal"],
    "python": BELOW_APPS,
    # Nothing that ships includes research.
    "research/linear": CORE,
    "research/methods": CORE + ["garment"],
    "research/methods/jgs2": CORE,
    "research/methods/xpbd": CORE + ["garment", "research/methods"],
    "research/methods/vbd": CORE + ["garment", "research/methods"],
    "research/paper_rule": CORE + ["quadrature2d"],
    "research/scenes": BELOW_SCENES + ["scenes", "research"],
    "research/benchmarks": BELOW_SCENES + ["scenes", "research"],
    "research/bench": BELOW_APPS + ["apps/toile/terminal", "research"],
    "tests": BELOW_APPS + ["apps", "research", "toile.h"],
}

# Modules of CMake whose name is not their folder.
FOLDER_OF_MODULE = {"scene_format": "scenes/format", "garment_format": "scenes/garment_format",
                    "drape": "scenes/drape", "preview": "apps/preview", "app": "apps/toile",
                    "benchmarks": "research/benchmarks", "quadrature_figures": "research/benchmarks/quadrature",
                    "collision_check": "collision/check", "collision_repair": "collision/repair",
                    "collision_skin": "collision/skin",
                    "pattern_mesh": "garment/pattern/mesh", "volume_meshing": "volume/meshing"}

# Folders of programs within a module's folder.
PROGRAMS = ["research/bench"]

# Third-party headers by the start of their name, and the folders that own them. None: everybody may.
# Tests may use any, as an oracle.
OWNERS = {
    r"(unsupported/)?Eigen/": None,
    r"(suitesparse/)?(cholmod|SuiteSparse_config|umfpack|amd|camd|colamd|metis)\b": ["core/linear"],
    r"(cuda|cublas|cusparse|cusolver|cooperative_groups|nvtx)|(cub|thrust|nv)/": ["core/compute"],
    r"(tbb|oneapi|experimental)/": ["core/compute"],
    r"xxhash\.h": ["core/compute"],
    # The benchmark times Embree against collision.
    r"embree[34]/": ["collision/bvh", "research/benchmarks/near_pairs"],
    r"assimp/": ["avatars/import"],
    r"tiny_gltf\.h": ["export/gltf"],
    r"CGAL/": ["collision/check", "garment/pattern/mesh", "volume/meshing"],
    r"(libpng/)?png\.h": ["apps/preview"],
    r"j(peglib|error)\.h": ["apps/preview"],
    r"zlib\.h": [],  # comes with libpng; checksums of the tests
    r"boost/multiprecision/": [],  # comes with CGAL; rational numbers of the tests
    r"nlohmann/": ["avatars/import", "avatars/landmarks", "scenes/format", "scenes/garment_format", "apps"],
    r"CLI/": ["apps/toile", "research/bench"],
    r"benchmark/": ["research/benchmarks"],
    r"g(test|mock)/": [],
}
# Libraries that headers may show to everybody: TBB and vector types, because kernels are templates.
SHOWN_TO_ALL = r"(tbb|oneapi|experimental)/"

# The C++ library, C, and POSIX or processor headers.
SYSTEM_HEADER = re.compile(
    r"[a-z_]+$|(assert|errno|fcntl|float|glob|limits|math|poll|pthread|pwd|sched|signal|spawn|std\w+|string"
    r"|strings|malloc|time|unistd|immintrin|xmmintrin|x86intrin)\.h$|(linux|sys)/\w+\.h$")

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


def allowed_to_folder(folder):
    """What the rooms of a module's folder may include together."""
    rooms = [room for room in MAY_INCLUDE if is_below(room, folder)] or [layer_of(folder)]
    return {target for room in rooms if room for target in MAY_INCLUDE[room]}


def circle_of_rooms():
    """Rooms that may include each other in a circle, or None."""
    def rooms_of(room):
        for target in MAY_INCLUDE[room]:
            yield from (other for other in MAY_INCLUDE if is_below(other, target) and not is_below(room, target)
                        and other != room)

    done, path = set(), []

    def visit(room):
        if room in path:
            return path[path.index(room):] + [room]
        if room in done:
            return None
        path.append(room)
        circle = next(filter(None, map(visit, rooms_of(room))), None)
        path.pop()
        done.add(room)
        return circle

    return next(filter(None, map(visit, list(MAY_INCLUDE))), None)


def is_for_gpu(path):
    """True for what lies in a cuda/ folder or only CUDA code can include."""
    return "/cuda/" in path or path.endswith((".cu", ".cuh"))


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
    if any(is_below(path, program) for program in PROGRAMS):
        return None
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
            sources = sum(name.endswith(CXX) for name in files)
            if sources > MAX_FILES:
                self.fail(folder, 1, f"the folder has {sources} sources, at most {MAX_FILES} may be; make rooms")
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
        if file.endswith(".h") and is_for_gpu(header) and not is_for_gpu(file) and not is_below(file, "tests") \
                and not is_below(file, "research"):
            self.fail(file, line, f"an interface of the CPU's path may not include {header}; "
                                  "declare what it needs, or move it into cuda/")
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
            allowed = allowed_to_folder(folder)
            for dependency in dependencies:
                target = folder_of_module(dependency)
                # Where one room of a module may be included, so may the module be linked.
                if allowed and not any(is_below(target, room) or is_below(room, target) for room in allowed):
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
    "core/compute/types.h": "#include <Eigen/Core>\n#include <tbb/parallel_for.h>\n",
    "core/mesh/a.h": '#include "core/compute/types.h"\n',
    "core/mesh/a.cpp": '#include "core/mesh/a.h"\n#include <vector>\n#include <sys/stat.h>\n',
    "core/linear/solver.cpp": "#include <cholmod.h>\n",
    "garment/CMakeLists.txt": "add_module(garment\n    SOURCES energy/cloth.cpp\n    DEPENDS core)\n",
    "garment/energy/cloth.cpp": '#include "core/mesh/a.h"\n',
    "collision/bvh/near.cpp": "#include <embree3/rtcore.h>\n",
    "collision/bvh/near.h": "#include <vector>\n",
    "tests/core/a_test.cpp": '#include "core/mesh/a.h"\n#include <gtest/gtest.h>\n#include <nlohmann/json.hpp>\n',
    "build/generated/x.cpp": "#include <nowhere/x.h>\n",
}
GOOD_MODULES = {"core": [], "garment": ["core"], "collision": []}

# Files to replace, modules to replace, and the start of the failure expected.
VIOLATIONS = [
    ({"core/compute/types.h": '\n#include "core/mesh/a.h"\n'}, {},
     "core/compute/types.h:2: core/compute may not include core/mesh/a.h"),
    ({"garment/energy/cloth.cpp": '#include "core/mesh/a.h"\n#include "collision/bvh/near.h"\n'}, {},
     "garment/energy/cloth.cpp:2: garment/energy may not include collision/bvh/near.h"),
    ({"core/mesh/a.cpp": '#include "tests/core/a_test.cpp"\n'}, {},
     "core/mesh/a.cpp:1: core/mesh may not include tests/core/a_test.cpp"),
    ({"core/mesh/a.cpp": '#include "a.h"\n'}, {}, 'core/mesh/a.cpp:1: "a.h" is no file of the tree'),
    ({"collision/bvh/near.cpp": '#include "core/mesh/a.h"\n'}, {},
     "collision/bvh/near.cpp:1: includes core/mesh/a.h, but DEPENDS of add_module(collision) lacks core"),
    ({"garment/energy/cloth.cpp": "#include <vector>\n"}, {},
     "garment/CMakeLists.txt:3: garment depends on core but includes none of its headers"),
    ({}, {"garment": ["core", "collision"]}, "garment/CMakeLists.txt:1: garment may not depend on collision"),
    ({"garment/energy/cloth.cpp": '#include "core/mesh/a.h"\n#include <embree3/rtcore.h>\n'}, {},
     "garment/energy/cloth.cpp:2: <embree3/rtcore.h> belongs to collision/bvh and research/benchmarks/near_pairs alone"),
    ({"collision/contact/term.h": "", "collision/check/find.cpp": '#include "collision/contact/term.h"\n'}, {},
     "collision/check/find.cpp:1: collision/check may not include collision/contact/term.h"),
    ({"core/pd/step/step.cpp": "#include <suitesparse/cholmod.h>\n"}, {},
     "core/pd/step/step.cpp:1: <suitesparse/cholmod.h> belongs to core/linear alone"),
    ({"core/mesh/a.cpp": "#include <gtest/gtest.h>\n"}, {},
     "core/mesh/a.cpp:1: <gtest/gtest.h> belongs to tests alone"),
    ({"collision/bvh/near.h": '#include "collision/bvh/tree.h"\n', "collision/bvh/tree.h": "#include <embree3/rtcore.h>\n",
      "tests/core/b_test.cpp": '#include "collision/bvh/near.h"\n', "apps/toile/main.cpp": '#include "collision/bvh/near.h"\n'},
     {}, "apps/toile/main.cpp:1: collision/bvh/near.h shows <embree3/rtcore.h>, which belongs to collision/bvh and research/benchmarks/near_pairs alone"),
    ({"core/mesh/a.cpp": "#include <boost/any.hpp>\n"}, {}, "core/mesh/a.cpp:1: <boost/any.hpp> has no owner"),
    ({"extras/a.cpp": '#include "core/mesh/a.h"\n'}, {}, "extras/a.cpp:1: extras/a.cpp is in no known layer"),
    ({"core/mesh/long.cpp": "\n" * 601}, {}, "core/mesh/long.cpp:601: the file has 601 lines"),
    ({"core/utils/a.h": ""}, {}, "core/utils:1: no folder is called so"),
    ({f"core/mesh/file{i}.h": "" for i in range(26)}, {}, "core/mesh:1: the folder has 28 sources"),
    ({"core/mesh/cuda/a.h": "", "core/mesh/b.h": '#include "core/mesh/cuda/a.h"\n'}, {},
     "core/mesh/b.h:1: an interface of the CPU's path may not include core/mesh/cuda/a.h"),
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
    mistakes = []
    if circle := circle_of_rooms():
        mistakes.append("rooms may include each other in a circle: " + " -> ".join(circle))
    mistakes += [f"the good tree fails: {failure}" for failure in check_planted({}, {})]
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
