#version 330 core
// Sends each triangle to the layer of the target that its depth names, and tells the fragments which that is.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

flat out int v_layer;

void main() {
    int layer = int(gl_in[0].gl_Position.z + 0.5);
    for (int k = 0; k < 3; ++k) {
        gl_Position = vec4(gl_in[k].gl_Position.xy, 0.0, 1.0);
        gl_Layer = v_layer = layer;
        EmitVertex();
    }
    EndPrimitive();
}
