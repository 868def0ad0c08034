#!/usr/bin/env bash
# gallery.sh TOILE [NAME...]   makes the pictures of docs/guide/gallery.md, or those named, with the program TOILE
#
# Results go to out/gallery, pictures to docs/images/gallery. Bodies and patterns are read from TOILE_DATA_DIR
# (../shared/data); pictures that need it are skipped without it. Environment: THREADS (0, all),
# EDGE of draped meshes in metres (0.015).
set -euo pipefail

toile=$1
shift
names=("$@")
((${#names[@]})) || names=(tablecloth soft_cushion soft_figure outfit_walk tee_pants gathered_walk circle_dance suit_dance runway)
export TOILE_DATA_DIR=${TOILE_DATA_DIR:-../shared/data}
threads=${THREADS:-0}
edge=${EDGE:-0.015}
patterns=$TOILE_DATA_DIR/patterns/garmentcode
body=$TOILE_DATA_DIR/avatars/gc_mean_all.glb
pictures=docs/images/gallery
mkdir -p "$pictures"

has_data() {
    [ -d "$TOILE_DATA_DIR" ] || { echo "SKIPPED: $1 needs the data set of TOILE_DATA_DIR" >&2; false; }
}

# picture NAME SCENE FRAME [WIDTH HEIGHT]   simulates up to a frame, certifies it, and draws the frame
picture() {
    local folder=out/gallery/$1/simulated
    "$toile" simulate "$2" -o "$folder" --frames $(($3 + 1)) --threads "$threads" --quiet --no-check
    # A picture whose certificate does not hold is still worth looking at; exit code 1 says just that.
    "$toile" check "$folder" --scene "$2" --frames $(($3 + 1)) -o "$folder/certificate.json" --quiet || (($? == 1))
    draw "$1" "$2" "$3" "${4:-480}" "${5:-640}" "$folder"/*.pc2
}

# draw NAME SCENE FRAME WIDTH HEIGHT CACHE...
draw() {
    "$toile" render "${@:6}" --scene "$2" --frames "$3" --width "$4" --height "$5" --samples 256 \
        -o "$pictures/$1.png" --quiet
}

# drape NAME CLIP FABRICS PATTERN... [OPTION...]
drape() {
    "$toile" drape "${@:4}" --clip "$2" --fabric "$3" --edge "$edge" --threads "$threads" --time-limit 3600 \
        -o "out/gallery/$1" --quiet
}

# The first frame of a drape, at rest.
draw_rest() {
    draw "$1" "out/gallery/$1/scene.json" 0 480 640 "${@:2}"
}

for name in "${names[@]}"; do
    echo "== $name"
    case $name in
    tablecloth) picture "$name" scenes/demo/tablecloth.json 89 640 480 ;;
    soft_cushion) picture "$name" scenes/details/soft_cushion.json 22 640 480 ;;
    soft_figure) picture "$name" scenes/details/soft_figure.json 40 ;;
    outfit_walk)
        drape "$name" walk cotton,jersey assets/a_line_skirt.garment.json assets/tee.garment.json
        picture "$name" "out/gallery/$name/scene.json" 100
        ;;
    tee_pants)
        has_data "$name" || continue
        drape "$name" walk denim,jersey "$patterns"/{pants,tee}_mean_all_specification.json --avatar "$body"
        draw_rest "$name" "out/gallery/$name/"{pants,tee}_mean_all_specification.obj
        ;;
    gathered_walk)
        has_data "$name" || continue
        drape "$name" walk jersey "$patterns/dress_gathered_mean_all_specification.json" --avatar "$body"
        picture "$name" "out/gallery/$name/scene.json" 100
        ;;
    circle_dance)
        has_data "$name" || continue
        drape "$name" dance jersey "$patterns/dress_circle_mean_all_specification.json" --avatar "$body"
        picture "$name" "out/gallery/$name/scene.json" 220
        ;;
    suit_dance)
        has_data "$name" || continue
        picture "$name" scenes/gallery/suit_dance.json 80
        ;;
    runway)
        has_data "$name" || continue
        picture "$name" scenes/gallery/runway.json 70 800 480
        ;;
    *)
        echo "gallery.sh: no picture is called $name" >&2
        exit 2
        ;;
    esac
done
