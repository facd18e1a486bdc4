#include "scenes/generate/ball_field.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace generate {
namespace {

constexpr const char* head = R"(# The sculpture, and a field of balls around it that ripples like a pond.
# Made by scenes/generate; changes here are lost at the next build.
Viewer
geo     1280 720
center  -8.0 8.0 17.0
target  0.4 3.6 0.0
up      0.0 1.0 0.0
fovy    40
anti    8

# A warm key from the left, a faint cool fill from the right behind the camera.
Light
origin      -14.0 20.0 12.0
color       WHITE
intensity   1.6

Light
origin      -14.0 20.0 12.0
color       YELLOW
intensity   0.22

Light
origin      16.0 9.0 20.0
color       WHITE
intensity   0.75

Plane
texture ImageTexture FLOOR ../textures/wood.png 8
normal  0.0 1.0 0.0
offset  0.0

Plane
texture ImageTexture FLOOR ../textures/brick.png 10
normal  0.0 0.0 1.0
offset  -14.0

Mesh
texture PureTexture PLASTIC WHITE
file    ../objs/sculpture.obj
center  0.0 4.6 0.0
radius  4.6
smooth  true
)";

constexpr double wall = -14;       // where the brick plane stands
constexpr double inner = 5.2;      // no balls nearer to the sculpture's middle
constexpr double spacing = 0.42;   // a ball covers pi spacing^2 of the floor
constexpr double wave_length = 6;  // of the ripples

}  // namespace

// A sunflower's spiral: each ball a golden angle further round, so that the floor is covered evenly.
std::string ball_field_scene(int count) {
    constexpr double golden_angle = std::numbers::pi * (3 - 2.2360679774997896);
    std::string text = head;
    const int first = static_cast<int>(inner * inner / (spacing * spacing));
    for (int made = 0, i = first; made < count; ++i) {
        const double distance = spacing * std::sqrt(i), angle = golden_angle * i;
        const double x = distance * std::cos(angle), z = distance * std::sin(angle);
        const double phase = 2 * std::numbers::pi * (distance - inner) / wave_length;
        const double radius = 0.20 + 0.13 * std::cos(phase);
        if (z - radius < wall) continue;
        const char* color = i % 21 == 0              ? "YELLOW"
                            : std::cos(phase) > 0.25 ? "CYAN"
                            : std::cos(phase) < -0.6 ? "WHITE"
                                                     : "BLUE";
        char ball[160];
        std::snprintf(ball, sizeof ball,
                      "\nSphere\ntexture PureTexture PLASTIC %s\ncenter  %.3f %.3f %.3f\nradius  %.3f\n", color, x,
                      radius, z, radius);
        text += ball;
        ++made;
    }
    return text;
}

}  // namespace generate
