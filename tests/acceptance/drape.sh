#!/bin/bash
# drape.sh PATTERN BODY [OPTION...]   reads, meshes, drapes, simulates and certifies one garment
#
# PATTERN is a garment file or panel JSON; BODY a file, or "mannequin". Options go to toile drape, as --fabric silk.
# Prints one line for each step, and ends at the first that fails. Exit code: 0 if all pass, else 1.
# Environment: TOILE, the program (build/bin/toile); EDGE, of the mesh in metres (0.01); OUT, a folder that keeps
# the results (a temporary one, which stays if a step fails).
set -u

if [ $# -lt 2 ]; then
    sed -n 's/^# \?//; 2,7p' "$0" >&2
    exit 1
fi
pattern=$1 body=$2
shift 2
toile=${TOILE:-build/bin/toile}
edge=${EDGE:-0.01}
out=${OUT:-$(mktemp -d -t toile-drape-XXXXXX)}
mkdir -p "$out" || exit 1
name=$(basename "$pattern" .json)
name=$(printf %s "${name%.garment}" | LC_ALL=C tr -c 'A-Za-z0-9_-' _)
avatar=(--avatar "$body")
[ "$body" = mannequin ] && avatar=()

# step NAME COMMAND...   runs a command; its streams go to OUT/NAME.out and OUT/NAME.err
step() {
    local step=$1 start=$SECONDS
    shift
    if "$@" >"$out/$step.out" 2>"$out/$step.err"; then
        echo "$step: ok, $((SECONDS - start)) s$(told "$step")"
    else
        echo "$step: FAILED with exit code $?: $(grep 'toile: error:' "$out/$step.err" | tail -n 1); see $out"
        exit 1
    fi
}

# told NAME   the line of a step that is worth repeating
told() {
    case $1 in
    mesh) sed -n 's/^sewn: /; /p' "$out/mesh.out" ;;
    drape) sed -n 's/^draped after [^:]*: /; /p' "$out/drape.err" ;;
    check) sed -n 's/^certificate holds/; &/p' "$out/check.err" ;;
    esac
}

# has FILE TEXT   whether a result exists and contains the text
has() {
    grep -q -- "$2" "$1" || { echo "toile: error: $1: lacks $2" >&2; false; }
}

# results   what a drape has to leave
results() {
    has "$out/drape.json" '"class": "draped"' && has "$out/certificate.json" '"holds": true' &&
        has "$out/$name.obj" '^g ' && has "$out/scene.json" '"rest": "uv"' && has "$out/$name.png" PNG &&
        has "$out/fit.json" '"colour_range"'
}

# reported KEY   its number in drape.json
reported() {
    sed -n "s/^  \"$1\": \([0-9]*\),/\1/p" "$out/drape.json"
}

# info   the welded surface has as many vertices, pieces and border loops as the report says
info() {
    "$toile" info "$out/$name.obj" >"$out/info.txt" || return
    has "$out/info.txt" "^vertices: $(reported vertices)\$" && has "$out/info.txt" "^pieces: $(reported pieces)\$" &&
        has "$out/info.txt" "^border loops: $(reported border_loops)\$"
}

step show "$toile" pattern show "$pattern" -o "$out/$name.svg"
step mesh "$toile" pattern mesh "$pattern" --edge "$edge" -o "$out/panels.obj"
step drape "$toile" drape "$pattern" "${avatar[@]}" --edge "$edge" -o "$out" "$@"
step results results
step info info
step simulate "$toile" simulate "$out/scene.json" --frames 16 -o "$out/simulated"
step check "$toile" check "$out/simulated" --scene "$out/scene.json" --frames 16
[ -n "${OUT:-}" ] || rm -rf "$out"
exit 0
