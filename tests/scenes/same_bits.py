#!/usr/bin/env python3
"""Holds every scene to recorded bits: what `toile simulate` writes on the CPU may not change by a single one.

    same_bits.py --toile PATH --scenes DIR --hashes FILE [--only NAME]...           compares with what is recorded
    same_bits.py --toile PATH --scenes DIR --hashes FILE [--only NAME]... --record  records what the program writes

--hashes is a JSON file:

    "frames"    {scene: how many frames are simulated}, scenes by their path below --scenes
    "left_out"  {scene: why it is not simulated}; every scene has to be in one of the two
    "hashes"    {fingerprint: {scene: SHA-256 of the caches}}

Bits are those of a machine and a build: the instruction set, the compiler and the libraries decide how sums are
rounded. The fingerprint names all of that. Where nothing is recorded for it the test is skipped (exit code 77) and
says how to record; that takes a program that is known to be right.

Scenes are simulated with `--solver direct` unless they name a method: `auto` measures time, so its bits differ from
run to run. The number of threads changes no bits. --record runs each scene twice, with one thread and with all, and
records only what is the same. CHANGED marks scenes whose recorded hash was another one.

Scenes that read ${TOILE_DATA_DIR} are skipped by name where the environment does not say where that is, or files are
missing there.

Exit codes: 0 the same or recorded, 1 different or failed, 2 bad arguments, 77 nothing could be compared.
"""

import argparse
import concurrent.futures
import ctypes
import dataclasses
import hashlib
import json
import os
import pathlib
import platform
import re
import shlex
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
DATA_VARIABLE = "TOILE_DATA_DIR"

# Extensions of the instruction set that compilers and libraries choose their arithmetic by.
ARITHMETIC_FLAGS = re.compile(r"(sse4_|avx|fma|f16c|amx|asimd|sve)")


class Failure(Exception):
    """Ends the test with a message."""


# ---- What decides the bits -----------------------------------------------------------------------------------------


def fingerprint(program):
    """The build of a program and the machine it runs on, as far as they decide about bits, in one readable line."""
    return "; ".join([compiler(build_folder(program)), processor(), libraries(program)])


def build_folder(program):
    """The folder that CMake built the program in."""
    for folder in program.parents:
        if (folder / "CMakeCache.txt").is_file():
            return folder
    raise Failure(f"{program} is in no build folder of CMake: the compiler it was built with is not known")


def compiler(build):
    """Compilers and flags, as CMake wrote them down. nvcc compiles host code too, with code of its own around it."""
    cxx = language(build, "CXX")
    kind = cached(build, "CMAKE_BUILD_TYPE")
    words = [cxx["COMPILER_ID"], cxx["COMPILER_VERSION"], kind, cached(build, "CMAKE_CXX_FLAGS"),
             cached(build, f"CMAKE_CXX_FLAGS_{kind.upper()}")]
    if cached(build, "TOILE_NATIVE") == "ON":
        words += ["-march=native"] + native_tuning(cxx["COMPILER"])
    cuda = language(build, "CUDA")
    words.append(f"CUDA {cuda['COMPILER_VERSION']}" if cuda else "no CUDA")
    return " ".join(word for word in words if word)


def language(build, name):
    """What CMake found out about a language's compiler; empty where the build does not use the language."""
    for file in sorted(build.glob(f"CMakeFiles/*/CMake{name}Compiler.cmake")):
        entries = re.findall(rf'^set\(CMAKE_{name}_(\w+) "(.*)"\)', file.read_text(), re.MULTILINE)
        return dict(entries)
    return {}


def cached(build, name):
    """An entry of CMake's cache, empty if there is none."""
    found = re.search(rf"^{name}:\w+=(.*)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE)
    return found.group(1) if found else ""


def native_tuning(path):
    """The processor that -march=native tunes for: it decides where multiply and add are fused. GCC only."""
    answer = subprocess.run([path, "-march=native", "-Q", "--help=target"], capture_output=True, text=True)
    found = re.search(r"^\s*-mtune=\s+(\S+)", answer.stdout, re.MULTILINE)
    return [f"-mtune={found.group(1)}"] if found else []


def processor():
    """Architecture and instruction set, not the model."""
    text = pathlib.Path("/proc/cpuinfo").read_text()
    found = re.search(r"^(?:flags|Features)\s*:(.*)$", text, re.MULTILINE)
    flags = sorted(flag for flag in found.group(1).split() if ARITHMETIC_FLAGS.match(flag)) if found else []
    return " ".join([platform.machine()] + flags)


def libraries(program):
    """The distribution, whose libraries the program takes, and the BLAS, which is chosen at each start."""
    system = platform.freedesktop_os_release()
    words = [system.get("ID", "?"), system.get("VERSION_ID", "?"), blas(program)]
    if os.environ.get("OPENBLAS_L2_SIZE"):
        words.append("OPENBLAS_L2_SIZE=" + os.environ["OPENBLAS_L2_SIZE"])
    return " ".join(words)


def blas(program):
    """The BLAS that the program loads. OpenBLAS tells which processor it takes this for (OPENBLAS_CORETYPE)."""
    loaded = subprocess.run(["ldd", program], capture_output=True, text=True).stdout
    found = re.search(r"lib(?:open)?blas\S* => (\S+)", loaded)
    if not found:
        return "no shared BLAS"
    path = os.path.realpath(found.group(1))
    library = ctypes.CDLL(path)
    if not hasattr(library, "openblas_get_config"):
        return path
    library.openblas_get_config.restype = ctypes.c_char_p
    return library.openblas_get_config().decode().strip()


# ---- One scene -----------------------------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class Scene:
    """A scene file, and how much of it is simulated."""

    name: str
    file: pathlib.Path
    frames: int

    def missing(self):
        """What the scene reads and this machine does not have; empty if it has everything."""
        data = os.environ.get(DATA_VARIABLE)
        for path in re.findall(r"\$\{" + DATA_VARIABLE + r"\}/([^\"]+)", self.file.read_text()):
            if not data:
                return f"the environment variable {DATA_VARIABLE} is not set"
            if not os.path.exists(os.path.join(data, path)):
                return f"{os.path.join(data, path)} does not exist"
        return ""

    def command(self, program, folder, threads):
        """The command that simulates it; threads 0: all."""
        method = json.loads(self.file.read_text()).get("solver", {}).get("method", "auto")
        solver = ["--solver", "direct"] if method == "auto" else []
        return [str(program), "simulate", str(self.file), "-o", str(folder), "--frames", str(self.frames),
                "--backend", "cpu", *solver, "--threads", str(threads), "--no-check", "--no-cache", "--quiet"]


def simulate(program, scene, threads):
    """Runs a scene; returns the hash of its caches and the seconds it took."""
    with tempfile.TemporaryDirectory(prefix="toile_same_bits_") as folder:
        command = scene.command(program, folder, threads)
        start = time.monotonic()
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            raise Failure(f"exit code {run.returncode} of {shlex.join(command)}\n{run.stderr.strip()}")
        return hash_of_caches(pathlib.Path(folder)), time.monotonic() - start


def hash_of_caches(folder):
    """SHA-256 over names and contents of all PC2 files, by name."""
    files = sorted(folder.rglob("*.pc2"))
    if not files:
        raise Failure("the run has written no PC2")
    total = hashlib.sha256()
    for file in files:
        content = file.read_bytes()
        total.update(f"{file.relative_to(folder).as_posix()}\0{len(content)}\0".encode())
        total.update(content)
    return total.hexdigest()


def reproducible_hash(program, scene, _):
    """The hash of a scene, if one thread and all threads agree about it, and the seconds of both runs."""
    alone, alone_seconds = simulate(program, scene, 1)
    together, together_seconds = simulate(program, scene, 0)
    if alone != together:
        raise Failure(f"NOT REPRODUCIBLE: one thread writes {alone}, all threads {together}")
    return alone, alone_seconds + together_seconds


# ---- All scenes ----------------------------------------------------------------------------------------------------


def scenes_to_run(arguments, book):
    """The scenes of the book, or those that --only names. Fails where a scene file is in neither of its lists."""
    known = set(book["frames"]) | set(book.get("left_out", {}))
    there = {file.relative_to(arguments.scenes).as_posix() for file in arguments.scenes.glob("*/*.json")}
    if there - known:
        raise Failure(f"{arguments.hashes} says nothing about {', '.join(sorted(there - known))}: give the frames to "
                      "simulate (\"frames\") or the reason why not (\"left_out\"), then --record")
    if known - there:
        raise Failure(f"{arguments.hashes} names scenes that do not exist: {', '.join(sorted(known - there))}")
    names = [name if name.endswith(".json") else name + ".json" for name in arguments.only] or list(book["frames"])
    unknown = [name for name in names if name not in book["frames"]]
    if unknown:
        raise Failure(f"--only {unknown[0]}: not one of {', '.join(book['frames'])}")
    return [Scene(name, arguments.scenes / name, book["frames"][name]) for name in names]


def without_missing(scenes):
    """The scenes whose data is there; names the others."""
    complete = []
    for scene in scenes:
        missing = scene.missing()
        if missing:
            report("SKIPPED", scene, missing)
        else:
            complete.append(scene)
    return complete


def report(word, scene, text):
    """One line of the output."""
    print(f"{word:<9} {scene.name}: {text}", flush=True)


def each_result(arguments, scenes, run):
    """Runs scenes, several at a time; yields each with its hash, None where the run failed, and its seconds."""
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        running = {pool.submit(run, arguments.toile, scene, arguments.threads): scene for scene in scenes}
        for future in concurrent.futures.as_completed(running):
            scene = running[future]
            try:
                yield scene, *future.result()
            except Failure as failure:
                report("FAILED", scene, failure)
                yield scene, None, 0.0


def compare(arguments, scenes, recorded):
    """Holds scenes to their recorded hashes; returns the names of those that differ or fail."""
    bad = []
    for scene, found, seconds in each_result(arguments, scenes, simulate):
        if found is not None and found == recorded[scene.name]:
            report("same", scene, f"{scene.frames} frames, {seconds:.1f} s")
            continue
        bad.append(scene.name)
        if found is not None:
            command = scene.command(arguments.toile, "out/same_bits", arguments.threads)
            report("DIFFERS", scene, f"{found}, recorded is {recorded[scene.name]}. To look at it:\n"
                                     f"          {shlex.join(command)}")
    return bad


def record(arguments, scenes, recorded):
    """Puts hashes of scenes into `recorded`; returns the names of those that fail."""
    bad = []
    for scene, found, seconds in each_result(arguments, scenes, reproducible_hash):
        if found is None:
            bad.append(scene.name)
            continue
        changed = scene.name in recorded and recorded[scene.name] != found
        report("CHANGED" if changed else "recorded", scene, f"{scene.frames} frames, {seconds:.1f} s for two runs")
        recorded[scene.name] = found
    return bad


def write_book(file, book):
    """Writes the JSON file as a whole or not at all."""
    book["hashes"] = {machine: dict(sorted(of.items())) for machine, of in sorted(book["hashes"].items())}
    partial = file.with_name(file.name + ".partial")
    partial.write_text(json.dumps(book, indent=2) + "\n")
    os.replace(partial, file)


# ---- The program ---------------------------------------------------------------------------------------------------


def run_comparison(arguments, book, machine):
    """Compares what is recorded for this fingerprint; returns the exit code."""
    recorded = book["hashes"].get(machine, {})
    wanted = scenes_to_run(arguments, book)
    unrecorded = [scene for scene in wanted if scene.name not in recorded]
    if unrecorded:
        tell_how_to_record(arguments, machine, unrecorded if recorded else [])
    scenes = without_missing(scene for scene in wanted if scene.name in recorded)
    bad = compare(arguments, scenes, recorded)
    if bad:
        print(f"\nFAILED: {len(bad)} of {len(scenes)} scenes do not have the recorded bits: {', '.join(sorted(bad))}")
        return 1
    print(f"\n{len(scenes)} of {len(wanted)} scenes compared, all with the same bits" if scenes
          else "\nSKIPPED: no scene was compared")
    return 0 if scenes else SKIPPED


def tell_how_to_record(arguments, machine, scenes):
    """Says that hashes are missing, of some scenes or of all, and the command that records them."""
    of = ", ".join(scene.name for scene in scenes) or "any scene"
    only = [word for scene in scenes for word in ("--only", scene.name)]
    command = [sys.executable, __file__, "--toile", str(arguments.toile), "--scenes", str(arguments.scenes),
               "--hashes", str(arguments.hashes), *only, "--record"]
    variable = f"{DATA_VARIABLE}={shlex.quote(os.environ.get(DATA_VARIABLE, 'FOLDER'))}"
    print(f"SKIPPED: {arguments.hashes} has no hashes of {of} for this machine and build:\n"
          f"    {machine}\nBuild a state that is known to be right, and record its bits:\n"
          f"    {variable} {shlex.join(command)}\n", flush=True)


def run_recording(arguments, book, machine):
    """Records scenes for this fingerprint and writes the file; returns the exit code."""
    print(f"Recording for {machine}")
    recorded = book["hashes"].setdefault(machine, {})
    bad = record(arguments, without_missing(scenes_to_run(arguments, book)), recorded)
    book["hashes"][machine] = {name: found for name, found in recorded.items() if name in book["frames"]}
    write_book(arguments.hashes, book)
    if bad:
        print(f"\nFAILED: not recorded: {', '.join(sorted(bad))}")
    return 1 if bad else 0


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--toile", type=pathlib.Path, required=True, metavar="PATH", help="the program, in its build")
    parser.add_argument("--scenes", type=pathlib.Path, required=True, metavar="DIR", help="folder of the scenes")
    parser.add_argument("--hashes", type=pathlib.Path, required=True, metavar="FILE", help="what is recorded")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="a scene: demo/skirt; repeatable")
    parser.add_argument("--record", action="store_true", help="write hashes into FILE instead of comparing")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="scenes at a time, 2 unless told")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="threads of a scene; 0, the default: all")
    arguments = parser.parse_args()
    for name in ("toile", "scenes", "hashes"):
        path = getattr(arguments, name).resolve()
        setattr(arguments, name, path)
        if not path.exists():
            parser.error(f"--{name}: {path} does not exist")
    return arguments


def main():
    arguments = parse_arguments()
    try:
        book = json.loads(arguments.hashes.read_text())
        run = run_recording if arguments.record else run_comparison
        return run(arguments, book, fingerprint(arguments.toile))
    except Failure as failure:
        print(f"FAILED: {failure}")
        return 1


if __name__ == "__main__":
    sys.exit(main())
