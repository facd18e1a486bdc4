# Ten thousand keys in a real window, with another size after each hundred: a random walk (fixed seed) that returns to its
# start again and again. Memory stays flat once all sizes were seen, and at the end the window shows what the same
# letters give without one: no key was lost. A shorter walk goes under the validation layer, synchronisation too.
source "$(dirname "$0")/common.sh"
press_keys=$3

# walk_letters ROUNDS: in each round fifty random keys and the same backwards, undone. None comes twice in a row: GLFW
# takes a release and a press of the same key within 20 ms for the keyboard's own repetition.
walk_letters() {
    awk -v rounds="$1" 'BEGIN {
        srand(20)
        count = split("w s a d U D L R t", keys)
        split("s w d a D U R L t", undoes)
        for (round = 0; round < rounds; ++round) {
            for (i = 1; i <= 50; ++i) {
                do k = 1 + int(count * rand())
                while (k == last || (i == 50 && keys[k] == "t"))
                walked[i] = last = k
                print keys[k]
            }
            for (i = 50; i >= 1; --i) print undoes[walked[i]]
            last = index_of(undoes[walked[1]])
        }
    }
    function index_of(key,  k) { for (k = 1; k <= count; ++k) if (keys[k] == key) return k }'
}
declare -A name_of=([w]=w [s]=s [a]=a [d]=d [U]=Up [D]=Down [L]=Left [R]=Right [t]=t)
sizes=("200 300" "640 200" "97 61" "400 300" "320 240")
resident() { awk '/^VmRSS/ {print $2}' "/proc/$walk/status"; } # KiB

# camera_of FILE: center and target in the statistics of a walk, six numbers.
camera_of() { grep -oE '"(center|target)": "[^"]*"' "$1" | cut -d'"' -f4 | tr '\n' ' '; }
# The scene as the walk's last camera sees it.
scene_at_the_end() {
    awk -v camera="$(camera_of stats.json)" 'BEGIN { split(camera, c) }
        /^center / && !done { print "center", c[1], c[2], c[3]; next }
        /^target / { print "target", c[4], c[5], c[6]; done = 1; next }
        { print }' "$scene"
}

# soak ROUNDS: a walk of so many hundred keys and six more, in perspective at the end. Memory, KiB after each round, goes
# to memory.txt.
soak() {
    local rounds=$1 letters round last=(w d U R w a)
    mapfile -t letters < <(walk_letters "$rounds"; printf '%s\n' "${last[@]}")
    "$program" "$scene" --size $size --exposure 1 --spp 1 --quiet --keys "${letters[*]} q" --stats script.json ||
        fail "the script of the same keys"
    start_walk --spp 2 --exposure 1 --stats stats.json
    : >memory.txt
    for ((round = 0; round < rounds; ++round)); do
        press_letters "${letters[@]:100 * round:100}"
        xdotool windowsize --sync "$window" ${sizes[round % ${#sizes[@]}]}
        sleep 0.2
        kill -0 "$walk" 2>/dev/null || fail "the program ended in round $round"
        resident >>memory.txt
    done
    xdotool windowsize --sync "$window" ${size/x/ }
    press_letters "${last[@]}"
    until_true window_stands || fail "the window does not come to rest"
    mv shot.png last.png
    press q
    end_walk 0

    # A lost key is half a unit, or 3.6 degrees. A machine so busy that a press lasts more than a tenth of a second adds
    # a little to a step.
    echo "$(camera_of script.json)" "$(camera_of stats.json)" | awk '{
        far = sqrt(($1 - $7)^2 + ($2 - $8)^2 + ($3 - $9)^2)
        turned = sqrt(($4 - $1 - $10 + $7)^2 + ($5 - $2 - $11 + $8)^2 + ($6 - $3 - $12 + $9)^2)
        printf "%g units and %g radians from where the script ends\n", far, turned
        exit far > 0.25 || turned > 0.03
    }' || fail "keys were lost: the walk ended at $(camera_of stats.json), the script at $(camera_of script.json)"
    mkdir -p scenes
    ln -sfn "$sources/objs" objs
    scene_at_the_end >scenes/end.scene
    scene=scenes/end.scene capture end.png --spp 2 --exposure 1 --allow-path "$sources"
    same last.png end.png || fail "the window (last.png) did not show what its camera saw (end.png)"
}
press_letters() {
    local letter names=()
    for letter in "$@"; do names+=("${name_of[$letter]}"); done
    "$press_keys" "${names[@]}"
}
# With its two samples there is a picture that stays.
window_stands() {
    xdotool getwindowname "$window" | grep -q ' - 2 samples' && shot before.png && sleep 0.5 && shot shot.png &&
        same before.png shot.png
}

start_display
soak 100
awk '{at[NR] = $1}
     END {
        for (i = 21; i <= 40; ++i) early = at[i] > early ? at[i] : early
        for (i = NR - 19; i <= NR; ++i) late = at[i] > late ? at[i] : late
        printf "memory: %d KiB at most in rounds 21 to 40, %d in the last 20\n", early, late
        exit late > early * 1.02 + 1024
     }' memory.txt || fail "memory grows: $(tr '\n' ' ' <memory.txt)"

export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
soak 10
! grep -hv '^raywalk: ' walk.out walk.err | grep -q . || fail "validation: $(grep -hv '^raywalk: ' walk.out walk.err | head -5)"
