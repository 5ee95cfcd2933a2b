// One slab of the occlusion sweep: filters the light that came through the slab before, and takes away what this one absorbs.
//
// LITERAL    0: our extinction form, 1: additive (Soltesova2010, 13-14), 2: multiplicative (Schott2009)
// HOLLOW     nothing stands in these tiles: filter only
// VOLUME     the volume casts shadows
// GEOMETRY   geometry does
// FILTER     0: this slab passes light on along its columns; the next filtering makes up for it
//
// State, one texel a column: (T, s). T: transmittance behind the slab (additive: accumulated occlusion O); s: the volume's value
// on the plane behind it, negative where nobody has looked. The grid's border is always clear, so that no fetch leaves the grid.
// (Software renderers execute both sides of a branch: this shader has none that would save work.)
#if !HOLLOW
#include "volume"
#include "clip"
#include "transfer"
#include "solid"
#endif
#if !HOLLOW && GEOMETRY
#include "cover"
#endif

uniform sampler2D u_state;
uniform ivec2 u_shift;           // texel of this slab + u_shift = texel of the slab before, the same column
uniform ivec2 u_taps[3];         // footprint: pairs of texels +-u_taps[k] with weight u_weights[k + 1], the column itself with u_weights[0]
uniform vec4 u_weights;
uniform mat3 u_enter;            // texture coordinates of a column where light enters the slab: u_enter * (texel, 1)
uniform mat3 u_leave;            // the same where it leaves
uniform float u_thickness;       // mm
uniform float u_path;            // length of the light's way through the slab over its thickness

layout(location = 0) out vec2 o_state;
layout(location = 1) out float o_visibility;

float before(ivec2 texel) { return texelFetch(u_state, texel, 0).r; }

void main() {
    ivec2 column = ivec2(gl_FragCoord.xy) + u_shift;
    vec2 center = texelFetch(u_state, column, 0).rg;
#if FILTER
    float light = u_weights.x * center.r;
    for (int k = 0; k < 3; ++k)
        light += u_weights[k + 1] * (before(column + u_taps[k]) + before(column - u_taps[k]));
#else
    float light = center.r;
#endif

#if HOLLOW
    const float absorbed = 0.0, value = -1.0;
#else
    vec3 enter = u_enter * vec3(gl_FragCoord.xy, 1.0);
    vec3 leave = u_leave * vec3(gl_FragCoord.xy, 1.0);
    vec2 range = kept_range(enter, leave - enter, vec2(0.0, 1.0));
    float value = volume_value(leave);
    // Tiles are swept from one slab before anything in them can be seen: where nobody has looked there is nothing to see.
    float s0 = center.g >= 0.0 ? center.g : value;
    float tau = extinction_around(s0, value, 0.5 * (enter + leave));
    float absorbed = tau * u_thickness * max(range.y - range.x, 0.0);    // optical depth along the axis
    absorbed = float(VOLUME) * (absorbed + FACES_PASSED(enter, leave - enter, range, 1.0));
#endif
#if !HOLLOW && GEOMETRY
    float passed = cover_passes(ivec2(gl_FragCoord.xy)).x;
#else
    const float passed = 1.0;
#endif

#if LITERAL == 1
    o_visibility = 1.0 / (1.0 + light);
    o_state = vec2(light + 1.0 - exp(-absorbed) * passed, value);
#elif LITERAL == 2
    o_visibility = light;
    o_state = vec2(light * exp(-absorbed) * passed, value);
#else
    o_visibility = light;
    o_state = vec2(light * exp(-absorbed * u_path) * passed, value);
#endif
}
