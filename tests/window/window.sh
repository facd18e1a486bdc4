# The window itself: sizes, hiding, ways to end, held keys, and sleep when there is nothing to do.
source "$(dirname "$0")/common.sh"
close_window=$3

start_display
start_walk --spp 3 --exposure 1 --stats stats.json # one that does not depend on the size
capture opening.png --spp 3 --exposure 1
expect opening.png "the opening view"

# Another size: the same camera, another picture.
for size in 200x300 640x200 320x240; do
    xdotool windowsize --sync "$window" ${size/x/ }
    capture resized.png --spp 3 --exposure 1
    expect resized.png "after a resize to $size"
done

# Hidden and shown again, the picture is drawn again.
xdotool windowunmap --sync "$window"
xdotool windowmap --sync "$window"
expect opening.png "after hiding and showing"
xdotool windowfocus --sync "$window"

# With every sample there, the program sleeps.
ticks() { awk '{print $14 + $15}' "/proc/$walk/stat"; }
sleep 1
before=$(ticks)
sleep 2
used=$(($(ticks) - before)) # hundredths of a second
[[ $used -le 6 ]] || fail "$used ticks of processor time in 2 s of nothing to do"

# A held key moves by time. The floor and ceiling are wide: this machine may be busy.
begin=$(date +%s%N)
xdotool keydown w
sleep 1.5
xdotool keyup w
held=$((($(date +%s%N) - begin) / 1000000)) # milliseconds
press q
end_walk 0
walked=$(awk -F'[ "]+' '/"center"/ {print (17.2 - $6) / 0.5}' stats.json)
awk -v steps="$walked" -v ms=$held 'BEGIN {exit !(steps > 0.3 * ms / 100 && steps < 3 * ms / 100)}' ||
    fail "$walked steps in $held ms"

# The other ways to end.
start_walk --spp 1
"$close_window" "$window"
end_walk 0
start_walk --spp 1
press Escape
end_walk 0
for signal in INT TERM; do
    start_walk
    kill -$signal "$walk"
    end_walk 130
done

# A French keyboard: walking by the places of the keys; the key labelled A, in the place of Q, does not quit.
setxkbmap fr
size=320x240
start_walk --spp 1
press z q a # the places of W, A, Q
capture azerty.png --spp 1 --keys "w a"
expect azerty.png "on a French keyboard"
press Escape
end_walk 0
