// Sum over all layers of the cells.
uniform sampler3D u_source;

layout(location = 0) out vec4 o_sum;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < textureSize(u_source, 0).z; ++k) sum += texelFetch(u_source, ivec3(at, k), 0);
    o_sum = sum;
}
