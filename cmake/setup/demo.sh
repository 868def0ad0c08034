#!/usr/bin/env bash
# demo.sh TOILE   drapes a table and a walking mannequin with the program TOILE, and draws what came out
set -euo pipefail

toile=$1
sheet_pictures=12

# Every n-th frame so that at most sheet_pictures are left: "first:last:step".
frames_for_sheet() { # scene
    python3 - "$1" $sheet_pictures <<'PYTHON'
import json, sys
last = json.load(open(sys.argv[1]))["frames"] - 1
print(f"0:{last}:{max(1, -(-last // (int(sys.argv[2]) - 1)))}")
PYTHON
}

# show NAME SCENE   simulates a scene into out/NAME, certifies and draws it
show() {
    local name=$1 scene=$2 folder=out/$1/simulated
    "$toile" simulate "$scene" -o "$folder" --report "$folder/report.json" --no-check
    # A demo whose certificate does not hold is still worth looking at; exit code 1 says just that.
    "$toile" check "$folder" --scene "$scene" -o "$folder/certificate.json" || (($? == 1))
    local caches=("$folder"/*.pc2)
    "$toile" render "${caches[@]}" --scene "$scene" -o "out/$name/$name.png" --sheet 4 \
        --frames "$(frames_for_sheet "$scene")"
    made+=("out/$name/$name.png" "${caches[@]}")
    if command -v ffmpeg >/dev/null; then
        "$toile" render "${caches[@]}" --scene "$scene" -o "out/$name/$name.mp4" --width 640 --height 360 --samples 2
        made+=("out/$name/$name.mp4")
    fi
}

made=()
echo "== tablecloth: scenes/demo/tablecloth.json"
show tablecloth scenes/demo/tablecloth.json
echo "== dressed_walk: a skirt and a tee, from their patterns to a walk"
"$toile" drape assets/a_line_skirt.garment.json assets/tee.garment.json --fabric cotton,jersey --edge 0.02 --clip walk \
    -o out/dressed_walk
made+=(out/dressed_walk/a_line_skirt_tee.png)
show dressed_walk out/dressed_walk/scene.json

cat <<TEXT

Done. Look at:
$(printf '  %s\n' "${made[@]}")

Next:
  - Play a cache in Blender: import the OBJ beside the PC2, add a Mesh Cache modifier, format PC2.
  - Change a number in scenes/demo/tablecloth.json and run
      $toile simulate scenes/demo/tablecloth.json -o out/mine
  - Sew a pattern of your own: $toile drape PATTERN --avatar BODY (docs/guide/draping.md)
  - See what the program can do: $toile --help
TEXT
command -v ffmpeg >/dev/null || echo "  - Install ffmpeg and run 'make demo' again for MP4 films."
