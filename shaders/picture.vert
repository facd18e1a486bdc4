// One triangle that covers the viewport; `uv` is (0, 0) at its top left corner and (1, 1) at its bottom right one.
#version 450

layout(location = 0) out vec2 uv;

void main() {
    uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
