// One slab of the occlusion sweep: filters the light that came through the slab before, and takes away what this one absorbs.
//
// LITERAL    0: our extinction form, 1: additive (Soltesova2010, 13-14), 2: multiplicative (Schott2009)
//
// State, one texel a column: (T, s). T: transmittance behind the slab (additive: accumulated occlusion O); s: the volume's value
// on the plane behind it, negative where nobody has looked yet.
#include "volume"
#include "clip"
#include "transfer"
#include "skip"

uniform sampler2D u_state;
uniform ivec2 u_shift;           // texel of this slab + u_shift = texel of the slab before, the same column
uniform ivec2 u_taps[3];         // footprint: pairs of texels +-u_taps[k] with weight u_weights[k + 1], the column itself with u_weights[0]
uniform vec4 u_weights;
uniform vec2 u_extent;           // texels of the grid
uniform mat3 u_enter;            // texture coordinates of a column where light enters the slab: u_enter * (texel, 1)
uniform mat3 u_leave;            // the same where it leaves
uniform float u_thickness;       // mm
uniform float u_path;            // length of the light's way through the slab over its thickness

layout(location = 0) out vec2 o_state;
layout(location = 1) out float o_visibility;

// Outside the grid nothing stands in the light.
#if LITERAL == 1
const float CLEAR = 0.0;
#else
const float CLEAR = 1.0;
#endif

float before(ivec2 texel) {
    bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(vec2(texel), u_extent));
    return inside ? texelFetch(u_state, texel, 0).r : CLEAR;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 column = here + u_shift;
    vec2 center = vec2(CLEAR, -1.0);
    if (all(greaterThanEqual(column, ivec2(0))) && all(lessThan(vec2(column), u_extent))) center = texelFetch(u_state, column, 0).rg;
    float light = u_weights.x * center.r;
    for (int k = 0; k < 3; ++k)
        light += u_weights[k + 1] * (before(column + u_taps[k]) + before(column - u_taps[k]));

    vec3 enter = u_enter * vec3(gl_FragCoord.xy, 1.0);
    vec3 leave = u_leave * vec3(gl_FragCoord.xy, 1.0);
    vec3 along = leave - enter;
    vec2 range = kept_range(enter, along, vec2(0.0, 1.0));
    float absorbed = 0.0, value = -1.0;                       // optical depth along the axis
    if (range.y > range.x && empty_run(enter, along, 0.0) < 1.0) {
        float s0 = center.g >= 0.0 ? center.g : volume_value(enter);
        value = volume_value(leave);
#ifdef TRANSFER_2D
        float magnitude = length(volume_gradient(0.5 * (enter + leave)));
#else
        const float magnitude = 0.0;
#endif
        absorbed = classify(s0, value, magnitude).a * u_thickness * (range.y - range.x);
    }
#if LITERAL == 1
    o_visibility = 1.0 / (1.0 + light);
    o_state = vec2(light + 1.0 - exp(-absorbed), value);
#elif LITERAL == 2
    o_visibility = light;
    o_state = vec2(light * exp(-absorbed), value);
#else
    o_visibility = light;
    o_state = vec2(light * exp(-absorbed * u_path), value);
#endif
}
