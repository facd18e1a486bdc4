# Without a display, a driver or the Vulkan library, the walk ends with code 4 and says what to do; -render works.
source "$(dirname "$0")/common.sh"
without_vulkan=$3 # a library to preload: there is no libvulkan then

# refused WORDS ARGUMENTS...: exit code 4, and these words on stderr.
refused() {
    local words=$1 code=0
    shift
    timeout $patience "$program" "$scene" --size $size "$@" >walk.out 2>walk.err || code=$?
    [[ $code -eq 4 ]] || fail "$*: exit code $code, not 4"
    grep -q '^raywalk: error: ' walk.err || fail "$*: no error is told"
    for word in $words; do grep -q -e "$word" walk.err || fail "$*: the message does not name $word"; done
    [[ ! -s walk.out ]] || fail "$*: stdout is not empty"
}

refused "display --capture -render"
DISPLAY=:77777 refused "display --capture -render"
VK_DRIVER_FILES=/nonexistent refused "VK_DRIVER_FILES.*/nonexistent unset -render" --capture out.png
(unset VK_DRIVER_FILES; export VK_ICD_FILENAMES=/missing; refused "VK_ICD_FILENAMES.*/missing unset" --capture out.png)
LD_PRELOAD=$without_vulkan refused "libvulkan.so.1 mesa-vulkan-drivers -render" --capture out.png
[[ ! -e out.png ]] || fail "a picture although there is no device"

start_display
VK_DRIVER_FILES=/nonexistent refused "VK_DRIVER_FILES.*/nonexistent unset"
LD_PRELOAD=$without_vulkan refused "libvulkan.so.1 mesa-vulkan-drivers -render"

# A display that ends in the middle of the walk.
start_walk --quiet
kill "$display_server"
end_walk 4
display_server=
grep -q '^raywalk: error: the display was lost' walk.err || fail "the lost display is not told"
[[ $(wc -l <walk.err) -le 2 ]] || fail "somebody else writes about the lost display"

# 16 bits a pixel: the driver presents to it, and offers no format.
start_display 16
refused "show.*on.this.display -render"
unset DISPLAY

LD_PRELOAD=$without_vulkan VK_DRIVER_FILES=/nonexistent "$program" "$scene" --size $size --quiet -render out.png ||
    fail "-render needs Vulkan or a display"
[[ -s out.png ]] || fail "-render wrote nothing"

# Interrupted, a capture is a whole picture of what there was.
"$program" "$scene" --size 640x480 --spp 1000000 --capture partial.png >walk.out 2>walk.err &
walk=$!
sleep 1.5
kill -INT "$walk"
end_walk 130
[[ $(identify -format '%wx%h' partial.png) == 640x480 ]] || fail "the interrupted capture is not whole"
[[ -z $(find . -name '*partial*' ! -name partial.png) ]] || fail "temporary files are left"
