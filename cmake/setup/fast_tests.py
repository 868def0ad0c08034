#!/usr/bin/env python3
"""fast_tests.py TIMED OTHER   the tests of one build that are fast in another, as a file for `ctest -I`

TIMED is a build folder in which ctest has run; OTHER one with the same tests and sanitizers, of whose programs some
may not be built. Fast: below a tenth of a second without sanitizers, which is below a second with them.
"""

import json
import pathlib
import subprocess
import sys

LIMIT_S = 0.1


def seconds_of(build):
    """Mean seconds of every test that ctest has timed."""
    costs = pathlib.Path(build, "Testing", "Temporary", "CTestCostData.txt")
    if not costs.is_file():
        sys.exit(f"error: {costs}: not found; run ctest in {build} first")
    seconds = {}
    for line in costs.read_text(encoding="utf-8").splitlines():
        if line == "---":  # the names of failed tests follow
            break
        name, runs, mean = line.rsplit(" ", 2)
        if int(runs):
            seconds[name] = float(mean)
    return seconds


def tests_of(build):
    listed = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], check=True, capture_output=True)
    return json.loads(listed.stdout)["tests"]


def is_built(test, build):
    """False where the command names a program of the build that is not there. CTest lists no command at all where
    the program is the first word."""
    programs = pathlib.Path(build, "bin").resolve()
    words = map(pathlib.Path, test.get("command", []))
    return "command" in test and all(word.exists() for word in words if word.parent == programs)


def main():
    timed, other = sys.argv[1:]
    seconds = seconds_of(timed)
    tests = tests_of(other)
    fast = [number for number, test in enumerate(tests, start=1)
            if seconds.get(test["name"], LIMIT_S) < LIMIT_S and is_built(test, other)]
    if not fast:
        sys.exit(f"error: no test of {other} is fast in {timed}")
    print(f"fast tests: {len(fast)} of {len(tests)}", file=sys.stderr)
    print("0,0,0," + ",".join(map(str, fast)))


if __name__ == "__main__":
    main()
