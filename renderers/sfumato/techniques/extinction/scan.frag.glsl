// Running sums along the first axis of a texture, four steps at a time; the result is turned by one axis, so three
// scans make a summed-area table in the old order: result(p, q, r) = sum over k <= r of source(k, p, q).
//
// QUANTISE   1: the source holds numbers, which are rounded to whole quanta, up or down by chance, so sums stay unbiased
uniform int u_layer;                 // first of the four layers
uniform usampler2D u_state;          // sums up to the layer before
uniform bool u_start;
#if QUANTISE
uniform sampler3D u_source;
uniform vec4 u_scale;                // quanta per unit
#else
uniform usampler3D u_source;
#endif

layout(location = 0) out uvec4 o_state;
layout(location = 1) out uvec4 o_sum0;
layout(location = 2) out uvec4 o_sum1;
layout(location = 3) out uvec4 o_sum2;
layout(location = 4) out uvec4 o_sum3;

#if QUANTISE
float chance(uvec3 v) {  // pcg3d (Jarzynski and Olano 2020), one number of it
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    return float(v.x >> 8u) / 16777216.0;
}
#endif

uvec4 source(ivec3 at) {
#if QUANTISE
    return uvec4(floor(texelFetch(u_source, at, 0) * u_scale + chance(uvec3(at))));
#else
    return texelFetch(u_source, at, 0);
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uvec4 sum = u_start ? uvec4(0u) : texelFetch(u_state, at, 0);
    o_sum0 = sum + source(ivec3(u_layer, at));
    o_sum1 = o_sum0 + source(ivec3(u_layer + 1, at));
    o_sum2 = o_sum1 + source(ivec3(u_layer + 2, at));
    o_sum3 = o_sum2 + source(ivec3(u_layer + 3, at));
    o_state = o_sum3;
}
