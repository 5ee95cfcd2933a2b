// A slice in the light's way: what its slab lets through.
//
// SOFT       1: spreads the light that came so far by the lamp's aperture (whole buffer); 0: the factor alone (blended)
#include "volume"
#include "clip"
#include "transfer"
#include "solid"

uniform mat3 u_column;           // texel to texture coordinates of its column at height 0: u_column * (texel, 1)
uniform vec3 u_along;            // the column's way in texture coordinates per mm of height
uniform float u_height;          // of the slice, mm
uniform float u_spacing;         // mm
uniform float u_light_secant;    // of the light against the slices' normal
#if SOFT
uniform sampler2D u_light;
uniform ivec2 u_taps[3];         // footprint: pairs of texels +-u_taps[k] with weight u_weights[k + 1], the texel itself u_weights[0]
uniform vec4 u_weights;

// Outside the grid nothing stands in the light.
float before(ivec2 texel) {
    bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, textureSize(u_light, 0)));
    return inside ? texelFetch(u_light, texel, 0).r : 1.0;
}

float arriving(ivec2 texel) {
    float light = u_weights.x * before(texel);
    for (int k = 0; k < 3; ++k) light += u_weights[k + 1] * (before(texel + u_taps[k]) + before(texel - u_taps[k]));
    return light;
}
#endif

layout(location = 0) out float o_light;

float transmitted() {
    vec3 here = u_column * vec3(gl_FragCoord.xy, 1.0) + u_along * u_height;
    vec2 kept = kept_range(here, vec3(0.0), vec2(0.0, 1.0));
    if (kept.x >= kept.y) return 1.0;
    vec3 half_slab = u_along * (0.5 * u_spacing);
    float s0 = volume_value(here + half_slab), s1 = volume_value(here - half_slab);
    vec4 mean = classify(s0, s1, steepness(s0, s1, here));
    return exp(-SOLIDIFIED(mean.a, here, u_spacing) * u_spacing * u_light_secant);
}

void main() {
    o_light = transmitted();
#if SOFT
    o_light *= arriving(ivec2(gl_FragCoord.xy));
#endif
}
