#!/usr/bin/env bash
# make.sh [NAME...]: renders the README's pictures of the shipped scenes, or of those named, with build/release/raywalk.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd)
cd "$root/scenes"

if [[ $# -gt 0 ]]; then
    names=("$@")
else
    names=()
    for scene in *.scene; do names+=("${scene%.scene}"); done
fi
for name in "${names[@]}"; do
    [[ $name == bunny ]] && continue  # not shipped
    width=400
    [[ $name == sculpture_with_spheres ]] && width=1280
    # The shape of the scene's own picture.
    size=$(awk -v width="$width" '$1 == "geo" { printf "%dx%d", width, width * $3 / $2 + 0.5; exit }' "$name.scene")
    ../build/release/raywalk "$name.scene" -render "pictures/$name.jpg" --size "$size" --spp 64 --quiet
done
