#!/usr/bin/env bash
# fuzz.sh FOLDER TARGET...   runs fuzz targets, each for FUZZ_SECONDS (60), from the corpora in tests/fuzz
#
# What libFuzzer adds to a corpus goes to a scratch folder; an input that fails stays in the working folder, named after
# its target.
set -euo pipefail

folder=$1
shift
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

for target in "$@"; do
    echo "== $target"
    mkdir "$scratch/$target"
    "$folder/$target" "$scratch/$target" "tests/fuzz/corpus/${target#fuzz_}" -max_total_time="${FUZZ_SECONDS:-60}" \
        -timeout=20 -rss_limit_mb=3000 -artifact_prefix="$target-" -verbosity=0 -print_final_stats=1
done
