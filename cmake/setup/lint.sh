#!/usr/bin/env bash
# lint.sh BUILD_FOLDER   clang-format and clang-tidy on the sources that changed
#
# Changed against LINT_BASE if set, else against where the branch left main, else against the parent commit;
# all files where there is none of these. Sources not yet committed count as changed.
# LINT_SECONDS (480): after it no further file goes to clang-tidy; those left out are named.
set -euo pipefail

build_folder=$1
seconds=${LINT_SECONDS:-480}
jobs=${LINT_JOBS:-$(nproc)}

# The commit to compare with; fails where there is none.
base_commit() {
    local main fork
    if [[ -n ${LINT_BASE:-} ]]; then
        echo "$LINT_BASE"
        return
    fi
    for main in origin/main main; do
        fork=$(git merge-base HEAD "$main" 2>/dev/null) || continue
        if [[ $fork != "$(git rev-parse HEAD)" ]]; then
            echo "$fork"
            return
        fi
    done
    git rev-parse --verify -q 'HEAD^'
}

# Sources that changed and still exist, one a line. Outside a repository every source counts.
changed_sources() {
    local base
    if ! git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
        find . -path './build*' -prune -o -path ./out -prune -o -type f -print | sed 's|^\./||'
    elif base=$(base_commit); then
        git diff --name-only --diff-filter=d "$base" --
        git ls-files --others --exclude-standard
    else
        git ls-files --cached --others --exclude-standard
    fi
}

# One file for xargs: prints what clang-tidy finds, or the file's name into `skipped` once time is up.
tidy_one() {
    if ((EPOCHSECONDS >= deadline)); then
        echo "$1" >>"$skipped"
        return
    fi
    # GCC's warning names are unknown to clang, and matrices of eight numbers side by side need 64 bytes, which GCC
    # lets pass with less; the count of suppressed warnings is of no interest.
    clang-tidy -p "$database" --quiet --extra-arg=-Wno-unknown-warning-option \
        --extra-arg=-DEIGEN_MAX_STATIC_ALIGN_BYTES=64 "$1" 2> >(
        grep -vE '^[0-9]+ warnings? (generated|treated)|^Suppressed|^Use -header-filter' >&2 || true
    )
}
export -f tidy_one

listed=$(changed_sources) || { echo "error: git can't list what changed since '${LINT_BASE:-HEAD}'" >&2 && exit 1; }
mapfile -t sources < <(grep -E '\.(cpp|h|cu)$' <<<"$listed" | sort -u)
echo "Lint: ${#sources[@]} changed sources"
((${#sources[@]})) || exit 0

clang-format --dry-run -Werror "${sources[@]}" ||
    { echo "error: the format differs; 'make format' rewrites it" >&2 && exit 1; }
echo "clang-format: good"

# Only what the build compiles has flags to be checked with.
mapfile -t compiled < <(printf '%s\n' "${sources[@]}" | grep '\.cpp$' |
    while read -r file; do grep -qF "/$file\"" "$build_folder/compile_commands.json" && echo "$file"; done)
((${#compiled[@]})) || exit 0

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
skipped=$scratch/skipped
touch "$skipped"

# GCC's precompiled headers are nothing to clang.
sed -E 's# -Winvalid-pch -include [^ ]+/cmake_pch\.hxx##' "$build_folder/compile_commands.json" >"$scratch/compile_commands.json"
database=$scratch
start=$EPOCHSECONDS
deadline=$((start + seconds))
export database deadline skipped
good=true
printf '%s\0' "${compiled[@]}" | xargs -0 -n 1 -P "$jobs" bash -c 'tidy_one "$1"' _ || good=false

left_out=$(wc -l <"$skipped")
echo "clang-tidy: $((${#compiled[@]} - left_out)) of ${#compiled[@]} files in $((EPOCHSECONDS - start)) s"
((left_out == 0)) || sed 's/^/clang-tidy: no time left for /' "$skipped"
$good || { echo "error: clang-tidy found the mistakes above" >&2 && exit 1; }
