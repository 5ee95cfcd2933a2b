// Light that each point gets from its neighbourhood (Hernell2007), gathered over packed blocks.
//
// LOCAL      how lamps are combined with it: 1 product, 2 mix
// LIGHTS     number of lamps
// RESOLVED   1: it is in one texture in the volume's space, not in packed blocks
// FACING     surfaces that turn away from a lamp are darker
#include "blocks"

uniform sampler3D u_map;         // rgb: sum over directions; a: sum of their weights, less in matter
uniform vec3 u_map_scale, u_map_offset;  // the volume's texture coordinates to the map's, if it is resolved
uniform float u_brightness, u_bias;
uniform float u_share;           // of the lamps in a mix
uniform float u_facing;          // how much a surface's slope counts, 0 to 1

// Linear RGB from all around at a place of the volume: the mean of the directions so far (`u_unshadowed` is the marcher's).
vec3 light_around(vec3 t) {
#if RESOLVED
    vec4 sum = textureLod(u_map, t * u_map_scale + u_map_offset, 0.0);
#else
    vec4 sum = packed_value(u_map, t);
#endif
    vec3 mean = sum.rgb / max(sum.a, 1e-6);
    return u_brightness * (u_bias + mix(mean, max(mean, vec3(1.0)), u_unshadowed));
}

// Both together; the lamps' light is that which reaches the eye, that from all around is so for `color`.
vec3 with_lamps(vec3 color, vec3 around, vec3 lamps) {
#if LOCAL == 1
    return around * lamps;
#else
    return mix(color * around, lamps, u_share);
#endif
}

#if SHADING == 5
// Colour that a segment of opacity alpha sends to the eye; t is its middle.
vec3 local_lit(vec3 color, float alpha, vec3 t, vec3 view) {
    vec3 around = light_around(t);
    color *= alpha;
#if LIGHTS > 0
    vec3 lamps = vec3(0.0);
    Slope slope = slope_at(t, view);
    for (int l = 0; l < LIGHTS; ++l) {
        lamps += u_light_color[l] * mix(1.0, max(dot(slope.normal, u_towards[l]), 0.0), u_facing * slope.surface);
    }
    return with_lamps(color, around, color * lamps);
#else
    return color * around;
#endif
}
#endif
