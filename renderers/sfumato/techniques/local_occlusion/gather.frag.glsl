// Light from one direction for each texel of a layer of the packed texture (Hernell2007, Eq. 2; Fig. 2).
//
// COLORED    tissue gives off light, which is gathered too (Eq. 4)
#include "volume"
#include "clip"
#include "transfer"

uniform usampler3D u_bricks;     // reverse index: per brick of 16^3 texels its level, and where its blocks begin in the list
uniform usampler2D u_list;       // place (xyz) of each block in the volume; w = 0: no block
uniform int u_layer;
uniform vec3 u_ray;              // the direction in texture coordinates, per mm
uniform float u_offset, u_radius;  // mm
uniform float u_samples;         // along the ray, for the finest level
uniform float u_gamma;           // exponent on what a sample lets through (Eq. 5)
uniform float u_weight;          // of this direction
uniform float u_voxel_mm;
uniform bool u_ends;             // light comes from the rays' ends alone (Fig. 1, left)
uniform float u_unit_distance;   // mm

layout(location = 0) out vec4 o_light;

const int EDGE = 16, FINEST = 4, LIST_WIDTH = 1024;
const float LEAST_OPEN = 1e-3;

// Extinction per mm at a place, and what it gives off; nothing where it is cut away or in an empty block.
float matter(vec3 t, out vec3 shining) {
    vec3 q = t * u_blocks_per_unit;
    uvec4 block = block_at(ivec3(floor(q)));
    float there = float(is_shown(block)) * kept_point(t);
    shining = vec3(0.0);
    if (there == 0.0) return 0.0;
    float value = textureLod(u_packed, packed_place(block, q - floor(q)), 0.0).r, gradient = 0.0;
#ifdef TRANSFER_2D
    gradient = length(volume_gradient(t));
    float tau = classify(value, value, gradient).a;
#else
    float tau = classify_extinction(value, value);
#endif
#if COLORED
    shining = classify_emission(value, value, gradient) / max(tau, 1e-20) * (1.0 - exp(-tau * u_unit_distance));
#endif
    return tau;
}

void main() {
    // 1. Which block is this, and where in the volume does the texel lie?
    ivec3 at = ivec3(ivec2(gl_FragCoord.xy), u_layer);
    uvec2 brick = texelFetch(u_bricks, at / EDGE, 0).rg;
    if (brick.r == 255u) discard;
    int level = int(brick.r), res = 1 << level, across = EDGE >> level;
    ivec3 local = at % EDGE, sub = local / res;
    int entry = int(brick.g) + sub.x + across * (sub.y + across * sub.z);
    uvec4 block = texelFetch(u_list, ivec2(entry % LIST_WIDTH, entry / LIST_WIDTH), 0);
    if (block.w == 0u) discard;
    vec3 t = (vec3(block.xyz) + (vec3(local % res) + 0.5) / float(res)) / u_blocks_per_unit;

    // 2. Steps lengthen as the block's resolution falls: d (1 + 2^(finest - level)) / 2. But not the first: what a
    // sample brings before anything stands in its way would tell one block from the next.
    float samples = max(2.0, floor(u_samples * 2.0 / (1.0 + float(1 << (FINEST - level))) + 0.5));
    float length_mm = u_radius - u_offset, first = 1.0 / u_samples, rest = (1.0 - first) / (samples - 1.0);

    // 3. Along the ray each sample brings its share of the light that those before it let through.
    float through = 1.0, share = first, at_share = 0.0;
    vec3 light = vec3(0.0), shining;
    // What stands in matter counts less between texels: else surfaces would be striped by what lies below them.
    float weight = u_weight * max(exp(-matter(t, shining) * u_voxel_mm), LEAST_OPEN);
    for (float m = 0.0; m < samples && through > 1e-3; ++m) {
        float tau = matter(t + u_ray * (u_offset + (at_share + 0.5 * share) * length_mm), shining);
        light += weight * share * through * (1.0 + shining);
        through *= exp(-tau * u_gamma * share * length_mm);
        at_share += share;
        share = rest;
    }
    if (u_ends) light = vec3(weight * through);
#if COLORED
    o_light = vec4(light, weight);
#else
    o_light = vec4(light.r, weight, 0.0, 0.0);
#endif
}
