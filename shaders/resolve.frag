// Display values from the film's own tiles: round(255 clamp(sum * scale)), as the processor's resolve has it.
#version 450

layout(push_constant) uniform Film {
    int tiles_x;
    int tile_count;
};

const int tile_pixels = 64, tile_values = 3 * tile_pixels;  // FilmTile of film.h: rgb[3][tile_pixels]

// `tile_count` tiles, then one scale a tile (exposure / samples).
layout(set = 0, binding = 0, std430) readonly buffer Tiles { float values[]; };

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int tile = (pixel.y >> 3) * tiles_x + (pixel.x >> 3);
    // A tile is four 4x4 blocks, each in rows of four.
    int lane = ((pixel.y & 4) << 3) | ((pixel.x & 4) << 2) | ((pixel.y & 3) << 2) | (pixel.x & 3);
    int first = tile * tile_values + lane;
    float scale = values[tile_count * tile_values + tile];
    precise vec3 radiance = vec3(values[first], values[first + tile_pixels], values[first + 2 * tile_pixels]) * scale;
    precise vec3 level = floor(255.0 * clamp(radiance, 0.0, 1.0) + 0.5);
    color = vec4(level / 255.0, 1.0);
}
