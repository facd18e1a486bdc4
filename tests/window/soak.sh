# Ten thousand keys in a real window, with another size after each hundred: a random walk (fixed seed) that returns to its
# start again and again. Memory stays flat once all sizes were seen, and at the end the window shows what the same
# letters give without one: no key was lost. A shorter walk goes under the validation layer, synchronisation too.
source "$(dirname "$0")/common.sh"

# walk_letters ROUNDS: in each round fifty random keys and the same backwards, undone. None comes twice in a row: GLFW
# takes a release and a press of the same key within 20 ms for the keyboard's own repetition. (And of one key it sees
# one press in a millisecond, hence the delay below.)
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

# soak ROUNDS OUT: a walk of so many hundred keys and seven more; the picture it should end with is OUT. Memory, KiB after
# each round, goes to memory.txt.
soak() {
    local rounds=$1 out=$2 letters round at names
    mapfile -t letters < <(walk_letters "$rounds")
    local last=(w d U R w a t)
    capture "$out" --spp 2 --exposure 1 --keys "${letters[*]} ${last[*]}"
    start_walk --spp 2 --exposure 1
    : >memory.txt
    for ((round = 0; round < rounds; ++round)); do
        names=()
        for ((at = 100 * round; at < 100 * round + 100; ++at)); do names+=("${name_of[${letters[at]}]}"); done
        xdotool key --delay 2 "${names[@]}"
        xdotool windowsize --sync "$window" ${sizes[round % ${#sizes[@]}]}
        sleep 0.2
        kill -0 "$walk" 2>/dev/null || fail "the program ended in round $round"
        resident >>memory.txt
    done
    xdotool windowsize --sync "$window" ${size/x/ }
    for at in "${last[@]}"; do press "${name_of[$at]}"; done
    expect "$out" "after $rounds rounds"
    press q
    end_walk 0
}

start_display
soak 100 end.png
awk '{at[NR] = $1}
     END {
        for (i = 21; i <= 40; ++i) early = at[i] > early ? at[i] : early
        for (i = NR - 19; i <= NR; ++i) late = at[i] > late ? at[i] : late
        printf "memory: %d KiB at most in rounds 21 to 40, %d in the last 20\n", early, late
        exit late > early * 1.02 + 1024
     }' memory.txt || fail "memory grows: $(tr '\n' ' ' <memory.txt)"

export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
soak 10 validated.png
! grep -hv '^raywalk: ' walk.out walk.err | grep -q . || fail "validation: $(grep -hv '^raywalk: ' walk.out walk.err | head -5)"
