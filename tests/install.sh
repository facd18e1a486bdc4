#!/usr/bin/env bash
# tests/install.sh BUILD_FOLDER: what `cmake --install` puts somewhere else works there, by itself, from any folder.
set -euo pipefail
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

cmake --install "$1" --prefix "$prefix" >"$prefix/log"
for file in bin/raywalk lib/raywalk/raywalk_png_jpeg lib/raywalk/raywalk_openimageio share/man/man1/raywalk.1 \
    share/doc/raywalk/{LICENSE,README.md,FORMAT.md} share/raywalk/scenes/cornell_box.scene share/raywalk/objs/teapot.obj \
    share/raywalk/textures/wood.png; do
    [[ -s $prefix/$file ]] || fail "$file is not installed"
done
[[ -z $(find "$prefix" -name '*.cpp' -o -name '*.a' -o -name CMakeLists.txt) ]] || fail "sources are installed"

mkdir "$prefix/elsewhere" && cd "$prefix/elsewhere"
raywalk=$prefix/bin/raywalk
# By names, in every kind of picture; a teapot on a texture is a mesh and an image read, with its own helpers.
"$raywalk" cornell_box -q --size 32x24 --spp 1 -render box.png || fail "cornell_box"
"$raywalk" teapot -q --size 32x24 --spp 1 -render teapot.exr || fail "teapot"
"$raywalk" teapot.scene -q --size 32x24 --spp 1 -render teapot.jpg || fail "teapot.scene"
[[ -s box.png && -s teapot.exr && -s teapot.jpg ]] || fail "no picture"

# The manual knows every option.
for option in $("$raywalk" --help | grep -oE '^  (-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+'); do
    grep -q "^\.B.*${option//-/\\\\-}" "$prefix/share/man/man1/raywalk.1" || fail "the manual does not know $option"
done
