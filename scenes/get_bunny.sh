#!/usr/bin/env bash
# Brings the Stanford bunny (69,666 triangles) out of Debian's package glmark2-data, which is fetched but not installed, and
# makes scenes/bunny.scene for it. Both stay out of git.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
mesh=usr/share/glmark2/models/bunny.obj
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [[ -f /$mesh ]]; then
    cp "/$mesh" "$work/bunny.obj"
else
    (cd "$work" && apt-get download -q -o APT::Sandbox::User="$(id -un)" glmark2-data >&2 && dpkg-deb -x glmark2-data_*.deb . && mv "$mesh" bunny.obj)
fi
mv "$work/bunny.obj" "$root/objs/bunny.obj"

cat > "$root/scenes/bunny.scene" <<'SCENE'
# The Stanford bunny on a table, with a mirror behind it. Made by get_bunny.sh.
Viewer
geo     960 720
center  1.4 3.6 8.5
target  0.0 1.7 0.0
up      0.0 1.0 0.0
fovy    36
anti    4

Light
area        6 0.5
origin      -6.0 9.0 6.0
color       WHITE
intensity   0.75

Light
origin      7.0 6.0 8.0
color       WHITE
intensity   0.28

Plane
texture ImageTexture FLOOR ../textures/wood.png 6
normal  0.0 1.0 0.0
offset  0.0

Plane
texture PureTexture A_BIT_MIRROR BLUE
normal  0.0 0.0 1.0
offset  -5.0

Mesh
texture PureTexture PLASTIC WHITE
file    ../objs/bunny.obj
center  0.0 1.75 0.0
radius  2.4
smooth  true
SCENE
echo "The bunny is in $root/objs/bunny.obj. Walk around it with ./run.sh bunny" >&2
