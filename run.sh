#!/usr/bin/env bash
# ./run.sh [SCENE [OPTIONS]]: builds Raywalk, installing what is missing, and walks through SCENE (a file, or the name of one
# of scenes/; scenes/cornell_box.scene where none is named). OPTIONS are the program's own: see ./run.sh --help.
# Without a display a short walk is captured into pictures instead.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
source "$root/.ci/prepare.sh"

scene=$root/scenes/cornell_box.scene
if [[ $# -gt 0 && $1 != -* ]]; then
    scene=$1
    shift
fi

vulkan_driver=$(vulkan_driver_package)
need_packages "${build_packages[@]}" ${vulkan_driver:+"$vulkan_driver"}
is_configured release || configure release RAYWALK_TESTS=OFF
build release raywalk scene_files
provide_runtime_folder
raywalk=$root/build/release/raywalk

# Only now: some scenes are made by the build.
named=$root/scenes/${scene%.scene}.scene
if [[ ! -e $scene && -f $named ]]; then scene=$named; fi

given() {  # given OPTION: whether the command line holds it
    local word
    for word in "${arguments[@]}"; do [[ $word == "$1" || $word == "$1="* ]] && return; done
    return 1
}
arguments=("$@")
for option in -render --render --capture --check --help -h --version; do
    given "$option" && exec "$raywalk" "$scene" "$@"
done

if [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]]; then
    status=0
    "$raywalk" "$scene" "$@" || status=$?
    [[ $status -eq 4 ]] || exit "$status"
fi

name=$(basename "$scene" .scene)
folder=$root/build/walk/$name
say "No window can be opened here, so a short walk is captured instead."
mkdir -p "$folder"
rm -f "$folder"/walk-*.png
given --keys || arguments+=(--keys "6w4L4R2U2D4a4d6s")
given --frames || arguments+=(--frames "$folder/walk-%04d.png")
given --spp || arguments+=(--spp 4)
"$raywalk" "$scene" --capture "$folder/$name.png" "${arguments[@]}"
say "The pictures are in $folder: walk-*.png after every key, $name.png at the end."
