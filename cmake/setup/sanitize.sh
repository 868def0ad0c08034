#!/usr/bin/env bash
# sanitize.sh RELEASE SANITIZED JOBS   runs both demos and the fast tests of a build with sanitizers
#
# fast_tests.py says which tests are fast, from the release build's last run of ctest.
set -euo pipefail

release=$1
sanitized=$2
jobs=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

export ASAN_OPTIONS=detect_leaks=1:abort_on_error=0
export UBSAN_OPTIONS=print_stacktrace=1

for name in tablecloth skirt; do
    echo "== demo/$name, first frames"
    "$sanitized/bin/toile" simulate "scenes/demo/$name.json" -o "$scratch/$name" --frames 3 --no-cache --quiet --no-check
done

python3 cmake/setup/fast_tests.py "$release" "$sanitized" >"$scratch/tests"
ctest --test-dir "$sanitized" -I "$scratch/tests" -j "$jobs" --output-on-failure
