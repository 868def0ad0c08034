#!/usr/bin/env bash
# demo.sh TOILE   simulates the demo scenes with the program TOILE and draws what came out
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

made=()
for name in tablecloth skirt; do
    scene=scenes/demo/$name.json
    folder=out/$name
    echo "== $name: $scene"
    "$toile" simulate "$scene" -o "$folder" --report "$folder/report.json" --no-check
    # A demo whose certificate does not hold is still worth looking at; exit code 1 says just that.
    "$toile" check "$folder" --scene "$scene" -o "$folder/certificate.json" || (($? == 1))
    caches=("$folder"/*.pc2)
    "$toile" render "${caches[0]}" --scene "$scene" -o "$folder/$name.png" --sheet 4 \
        --frames "$(frames_for_sheet "$scene")"
    made+=("$folder/$name.png" "${caches[@]}")
    if command -v ffmpeg >/dev/null; then
        "$toile" render "${caches[0]}" --scene "$scene" -o "$folder/$name.mp4" --width 640 --height 360 --samples 2
        made+=("$folder/$name.mp4")
    fi
done

cat <<TEXT

Done. Look at:
$(printf '  %s\n' "${made[@]}")

Next:
  - Play a cache in Blender: import the OBJ beside the PC2, add a Mesh Cache modifier, format PC2.
  - Change a number in scenes/demo/tablecloth.json and run
      $toile simulate scenes/demo/tablecloth.json -o out/mine
  - See what the program can do: $toile --help
TEXT
command -v ffmpeg >/dev/null || echo "  - Install ffmpeg and run 'make demo' again for MP4 films."
