# Q quits and T toggles whatever the keyboard's letters are, by label where they are Latin, else by place; Escape and
# Ctrl+Q quit on each. The window says whose it is.
source "$(dirname "$0")/common.sh"
command -v setxkbmap >/dev/null || fail "setxkbmap is needed (package x11-xkb-utils)"

place_of_q=24 place_of_a=38 place_of_x=53 place_of_t=28 control=37  # X keycodes of a PC's keyboard

capture start.png --spp 2
capture toggled.png --spp 2 --keys t

# quits LAYOUT KEYCODE...: these keys together end the walk.
quits() {
    local layout=$1 key
    shift
    for key in "$@"; do xdotool keydown "$key"; done
    for key in "$@"; do xdotool keyup "$key"; done
    until_true sh -c "! kill -0 $walk 2>/dev/null" || fail "$layout: keys $* do not quit"
    end_walk 0
}

start_display
for layout in us ru gr il ara; do
    setxkbmap "$layout"
    start_walk --spp 2
    expect start.png "$layout: the opening view"
    xdotool key --delay 0 $place_of_t
    expect toggled.png "$layout: after the key in the place of T"
    quits "$layout" $place_of_q
    start_walk --spp 2
    quits "$layout" $control $place_of_q
done

# AZERTY: the key labelled Q lies where A does elsewhere, and walks; with Ctrl it quits. The one labelled A does not.
setxkbmap fr
start_walk --spp 2
expect start.png "AZERTY: the opening view"
xdotool key --delay 0 $place_of_q
xdotool key --delay 0 $place_of_t
expect toggled.png "AZERTY: after T"
quits fr $control $place_of_a
start_walk --spp 2
quits fr Escape

# Dvorak: by label.
setxkbmap us -variant dvorak
start_walk --spp 2
quits dvorak $place_of_x

setxkbmap us
start_walk --spp 2
[[ $(ps -o comm= -p "$walk") == raywalk ]] || fail "the process is called $(ps -o comm= -p "$walk")"
xprop -id "$window" WM_CLASS | grep -q '"raywalk", "Raywalk"' || fail "$(xprop -id "$window" WM_CLASS)"
xprop -id "$window" _NET_WM_ICON | grep -q 'Icon (32 x 32)' || fail "the window has no icon"
quits us $place_of_q
