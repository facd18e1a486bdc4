# A window that others cover traces nothing; uncovered it goes on.
source "$(dirname "$0")/common.sh"

samples_of() { xdotool getwindowname "$1" | sed -n 's/.* - \([0-9]*\) of [0-9]* samples.*/\1/p'; }
more_than() { [[ $(samples_of "$window") -gt $1 ]]; }

start_display
start_walk --spp 16777216
until_true more_than 3 || fail "no samples come"
below=$window below_walk=$walk

size=800x600
start_walk --spp 16777216
until_true more_than 1 || fail "the second walk shows nothing"
before=none
stands() {  # since half a second ago
    before=$(samples_of "$below")
    sleep 0.5
    [[ $(samples_of "$below") == "$before" ]]
}
until_true stands || fail "the covered walk goes on"
xdotool key --delay 0 q
end_walk 0
walk=$below_walk window=$below
until_true more_than "$before" || fail "the uncovered walk does not go on"
xdotool windowfocus --sync "$window" key --delay 0 q
end_walk 0
