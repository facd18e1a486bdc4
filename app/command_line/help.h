// What --help says before and after the options; lines of at most 100 columns.
#pragma once

namespace raywalk {

inline constexpr const char* help_start =
    R"(raywalk: walk through a ray-traced scene, or render it

usage:
  raywalk SCENE                 walk through the scene in a window: a file, or the name of one
                                that ships, such as cornell_box
  raywalk SCENE -render OUT     render a picture, write it to the file OUT

the walk:
  W S A D        a small step forward, back, left, right (hold to go on)
  arrow keys     turn up, down, left, right (hold to go on)
  T              orthographic or perspective projection
  [ ]            darker, brighter
  Q, Ctrl+Q, Escape  quit
)";

inline constexpr const char* help_end =
    R"(examples:
  raywalk cornell_box
  raywalk scenes/cornell_box.scene -render box.png
  raywalk scenes/cornell_box.scene -render box.exr --size 1920x1080 --spp 64
  raywalk scenes/cornell_box.scene -render left.png --keys '8w 5L'
  raywalk scenes/cornell_box.scene --capture end.png --keys '8w 5L' --frames 'walk-%04d.png'

exit codes: 0 done, 1 failed, 2 wrong command line, 3 wrong scene, mesh or image, 4 no display or no
Vulkan device to walk with, 130 interrupted (the part of the picture that was ready is saved))";

}  // namespace raywalk
