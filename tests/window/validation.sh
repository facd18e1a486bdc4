# The Khronos validation layer, with synchronisation validation, has nothing to say about window and capture, whichever
# way frames go.
source "$(dirname "$0")/common.sh"

export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
VK_LOADER_DEBUG=layer "$program" "$scene" --size 64x48 --capture probe.png >probe.log 2>&1 || fail "capture under validation"
grep -q 'Insert instance layer.*VK_LAYER_KHRONOS_validation' probe.log ||
    fail "the validation layer is needed (package vulkan-validationlayers)"

silent() { # nothing but the program's own lines
    ! grep -v '^raywalk: ' "$@" | grep -q . || fail "validation: $(grep -hv '^raywalk: ' "$@" | head -5)"
}

start_display
for resolve in processor device; do
    export RAYWALK_RESOLVE=$resolve
    "$program" "$scene" --size $size --capture end.png --keys "2w t L" --frames frame-%d.png >capture.log 2>&1 ||
        fail "capture with the $resolve resolving"
    silent capture.log

    start_walk --spp 2 # the first frame is a preview, and so is scaled
    capture opening.png --spp 2 >opening.log
    expect opening.png "the opening view, resolved by the $resolve"
    xdotool keydown d
    sleep 0.5
    xdotool keyup d
    for s in "400 200" "100 300" "320 240"; do
        xdotool windowsize --sync "$window" $s
        sleep 0.3
    done
    xdotool windowunmap --sync "$window"
    xdotool windowmap --sync "$window"
    xdotool windowfocus --sync "$window"
    sleep 0.3
    press t
    sleep 0.3
    press q
    end_walk 0
    silent walk.out walk.err opening.log
done
