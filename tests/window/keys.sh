# Every key of the walk, in a real window, does what the same letter of --keys does without one, bit for bit.
source "$(dirname "$0")/common.sh"

letters=(w d U L s a D R t w t t)
names=(w d Up Left s a Down Right t w t t)

capture start.png --spp 2
capture end.png --spp 2 --keys "${letters[*]}" --frames frame-%02d.png
previous=start.png
for i in "${!letters[@]}"; do
    frame=$(printf 'frame-%02d.png' "$i")
    ! same "$previous" "$frame" || fail "key ${letters[i]} changes nothing"
    previous=$frame
done
same "$frame" end.png || fail "the last frame is not the picture"
same frame-09.png frame-11.png || fail "t twice does not give the first picture back"

start_display
start_walk --spp 2
expect start.png "the opening view"
for i in "${!names[@]}"; do
    press "${names[i]}"
    expect "$(printf 'frame-%02d.png' "$i")" "after key ${names[i]}"
done

# Presses that come faster than frames all count. (One key twice within a millisecond is one press to GLFW.)
for name in w w w Left Left; do press $name; done
capture fast.png --spp 2 --keys "${letters[*]} 3w 2L"
expect fast.png "after five keys at once"

# Keys of the command line come first; the exposure stays that of the opening view.
press q
end_walk 0
start_walk --spp 2 --keys "4w 3R"
press Up
capture keys.png --spp 2 --keys "4w 3R U"
expect keys.png "--keys and then a key"
press q
end_walk 0
