#version 330 core
// Triangles that cover the viewport, one for each layer; `layers.geom.glsl` sends each to its own.
void main() {
    int corner = gl_VertexID % 3;
    gl_Position = vec4(vec2(corner & 1, corner >> 1) * 4.0 - 1.0, float(gl_VertexID / 3), 1.0);
}
