# Sourced by the window tests: a display of their own, the program in it, keys, pictures.
# Called as: bash TEST.sh PROGRAM SOURCE_FOLDER; what a test made stays in the folder TEST.work beside it when it fails.
set -euo pipefail

program=$1 sources=$2
scene=$sources/scenes/cornell_box.scene
size=320x240
patience=60 # seconds until something that will not come counts as missing

work=$PWD/$(basename "$0" .sh).work
rm -rf "$work"
mkdir -p "$work"
mkdir -m 700 "$work/runtime"
cd "$work"
export XDG_RUNTIME_DIR=$work/runtime # Mesa complains without one
unset DISPLAY WAYLAND_DISPLAY VK_INSTANCE_LAYERS VK_LAYER_ENABLES RAYWALK_RESOLVE

walk= display_server=
finish() {
    local code=$?
    [[ -z $walk ]] || kill -KILL "$walk" 2>/dev/null || true
    [[ -z $display_server ]] || kill "$display_server" 2>/dev/null || true
    if [[ $code -eq 0 ]]; then rm -rf "$work"; else echo "see $work" >&2; fi
}
trap finish EXIT

fail() {
    echo "FAILED: $*" >&2
    for log in walk.out walk.err; do [[ ! -s $log ]] || sed "s/^/$log: /" "$log" >&2; done
    exit 1
}
for tool in Xvfb xdotool import compare; do
    command -v $tool >/dev/null || fail "$tool is needed (packages xvfb xdotool imagemagick)"
done
# The software driver, so that every machine shows the same.
export VK_DRIVER_FILES
VK_DRIVER_FILES=$(find /usr/share/vulkan/icd.d -name 'lvp_icd*.json' | head -1)
[[ -n $VK_DRIVER_FILES ]] || fail "the software Vulkan driver is needed (package mesa-vulkan-drivers)"

# until_true COMMAND...: repeats it until it succeeds; fails when patience ends.
until_true() {
    local end=$((SECONDS + patience))
    until "$@"; do
        [[ $SECONDS -lt $end ]] || return 1
        sleep 0.1
    done
}

start_display() {  # start_display [BITS A PIXEL]
    # -noreset: it would forget its keyboard, and turn clients away for a moment, whenever the last client leaves.
    rm -f display
    Xvfb -noreset -displayfd 3 -screen 0 "1600x1000x${1:-24}" -nolisten tcp 3>display 2>xvfb.log &
    display_server=$!
    until_true test -s display || fail "Xvfb did not start"
    export DISPLAY=:$(<display)
}

# start_walk ARGUMENTS...: the program in a window that has the focus; sets $walk and $window.
start_walk() {
    "$program" "$scene" --size $size "$@" >walk.out 2>walk.err &
    walk=$!
    window=$(timeout $patience xdotool search --sync --onlyvisible --name '^Raywalk - ' | head -1)
    [[ -n $window ]] || fail "no window came"
    xdotool windowfocus --sync "$window"
}

# end_walk CODE: waits for the program and checks how it ended.
end_walk() {
    local code=0
    until_true sh -c "! kill -0 $walk 2>/dev/null" || fail "the program does not end"
    wait "$walk" || code=$?
    walk=
    [[ $code -eq $1 ]] || fail "exit code $code, not $1"
}

press() { xdotool key --delay 0 "$@"; } # each goes down and up again at once
shot() { # where there is no such window, import would wait for a click on one
    xdotool getwindowname "$window" >/dev/null 2>&1 || fail "the window is gone"
    timeout 10 import -window "$window" "$1"
}
same() { [[ $(compare -metric AE "$1" "$2" null: 2>&1) == 0 ]]; }
window_shows() { shot shot.png && same shot.png "$1"; }
# expect FILE WHAT: the window comes to show this picture.
expect() { until_true window_shows "$1" || fail "$2: the window (shot.png) is not $1"; }

# capture OUT ARGUMENTS...: what the window should show, made without one.
capture() {
    local out=$1
    shift
    "$program" "$scene" --size $size --quiet --capture "$out" "$@" || fail "--capture $out $*: exit code $?"
}
