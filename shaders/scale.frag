// Brings a frame of another size (or byte order) to the window.
#version 450

layout(constant_id = 0) const bool smooth_cubic = false;  // Catmull-Rom instead of bilinear
layout(constant_id = 1) const bool srgb_target = false;   // the target encodes what it is given: undo that first

layout(set = 0, binding = 0) uniform sampler2D frame;  // linear filter, clamped to its edge

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

// Catmull-Rom over 4x4 texels in nine bilinear taps: the two middle weights of an axis are positive and so share one
// tap between their texels.
vec3 catmull_rom(vec2 position, vec2 size) {
    vec2 middle = floor(position - 0.5) + 0.5;
    vec2 f = position - middle;

    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;

    vec2 at[3] = vec2[](middle - 1.0, middle + w2 / w12, middle + 2.0);
    vec2 weight[3] = vec2[](w0, w12, w3);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            sum += textureLod(frame, vec2(at[x].x, at[y].y) / size, 0.0).rgb * weight[x].x * weight[y].y;
    return clamp(sum, 0.0, 1.0);
}

vec3 srgb_decode(vec3 v) {
    return mix(v / 12.92, pow((v + 0.055) / 1.055, vec3(2.4)), greaterThan(v, vec3(0.04045)));
}

void main() {
    vec3 display;
    if (smooth_cubic) {
        vec2 size = vec2(textureSize(frame, 0));
        display = catmull_rom(uv * size, size);
    } else {
        display = textureLod(frame, uv, 0.0).rgb;
    }
    color = vec4(srgb_target ? srgb_decode(display) : display, 1.0);
}
