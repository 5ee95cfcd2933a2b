// Adds the light of a lamp that has no visibility of its own in the light cache.
flat in int v_layer;
uniform sampler3D u_lamp;
uniform vec3 u_color;                // linear RGB times intensity

layout(location = 0) out vec4 o_world;

void main() {
    o_world = vec4(u_color * texelFetch(u_lamp, ivec3(ivec2(gl_FragCoord.xy), v_layer), 0).r, 0.0);
}
