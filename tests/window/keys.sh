# Every key of the walk, in a real window, does what the same letter of --keys does without one, bit for bit.
source "$(dirname "$0")/common.sh"

letters=(w d U L s a D R t w t t ']' ']' '[' '[' '[')
names=(w d Up Left s a Down Right t w t t bracketright bracketright bracketleft bracketleft bracketleft)

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
same frame-11.png frame-15.png || fail "as many [ as ] do not give the first picture back"
capture scripted.png --spp 2 --exposure 1 --keys "3]" --frames bright-%d.png
capture scaled.png --spp 2 --exposure 1.953125
same scripted.png scaled.png || fail "3] is not the exposure times 1.25 ^ 3"
same bright-2.png scaled.png || fail "the last frame of 3] is not the picture"
capture scaled.png --spp 2 --exposure 1.5625
same bright-1.png scaled.png || fail "the second frame of 3] is not the exposure times 1.25 ^ 2"

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
start_walk --spp 2 --keys "4w 2[ 3R"
capture opening.png --spp 2 --keys "4w 2[ 3R"
expect opening.png "--keys"
press Up bracketleft
capture keys.png --spp 2 --keys "4w 3R U 3["
expect keys.png "--keys and then a key"
press q
end_walk 0
