// One slab of the light prepass: a bundle of directions steps from plane to plane, each by one fetch, and loses what the slab absorbs.
//
// DIRECTIONS  number of directions, a multiple of 4: four in each state
// LAST        DIRECTIONS / 4: the attachment after the states
// HOLLOW      nothing stands in these tiles: the light only passes
// VOLUME      the volume casts shadows
// GEOMETRY    geometry does
//
// The states hold the directions' transmittances behind the slab before. The grid's border is always clear, so that no fetch leaves it.
#if !HOLLOW && VOLUME
#include "volume"
#include "clip"
#include "transfer"
#include "solid"
#endif
#if !HOLLOW && GEOMETRY
#include "cover"
#endif

uniform sampler2D u_state0, u_state1, u_state2, u_state3, u_state4, u_state5;
uniform vec2 u_offset[DIRECTIONS];   // step towards the light, in texels
uniform vec3 u_secants;              // smallest, middle and largest secant of the directions
uniform vec4 u_weight0[DIRECTIONS / 4], u_weight1[DIRECTIONS / 4], u_weight2[DIRECTIONS / 4];    // each direction's, of those three
uniform vec4 u_share[DIRECTIONS / 4];  // what each direction counts for in the mean
uniform vec2 u_texel_size;           // 1 / texels of the grid
uniform mat3 u_enter;                // texture coordinates of a column where light enters the slab: u_enter * (texel, 1)
uniform mat3 u_leave;                // the same where it leaves
uniform float u_thickness;           // mm

layout(location = 0) out vec4 o_state0;
#if DIRECTIONS > 4
layout(location = 1) out vec4 o_state1;
#endif
#if DIRECTIONS > 8
layout(location = 2) out vec4 o_state2;
#endif
#if DIRECTIONS > 12
layout(location = 3) out vec4 o_state3;
#endif
#if DIRECTIONS > 16
layout(location = 4) out vec4 o_state4;
#endif
#if DIRECTIONS > 20
layout(location = 5) out vec4 o_state5;
#endif
layout(location = LAST) out vec2 o_light;     // visibility times openness, and openness: what is dark by standing in matter does not count

const float LEAST = 1.0 / 256.0;

vec4 arriving(sampler2D state, int first) {
    vec2 at = gl_FragCoord.xy;
    return vec4(textureLod(state, (at + u_offset[first]) * u_texel_size, 0.0).r, textureLod(state, (at + u_offset[first + 1]) * u_texel_size, 0.0).g,
        textureLod(state, (at + u_offset[first + 2]) * u_texel_size, 0.0).b, textureLod(state, (at + u_offset[first + 3]) * u_texel_size, 0.0).a);
}

void main() {
#if HOLLOW
    #define PASS(came, group) came
#else
#if GEOMETRY
    vec2 passed = cover_passes(ivec2(gl_FragCoord.xy));
#else
    const vec2 passed = vec2(1.0);
#endif
#if VOLUME
    vec3 enter = u_enter * vec3(gl_FragCoord.xy, 1.0);
    vec3 leave = u_leave * vec3(gl_FragCoord.xy, 1.0);
    vec2 range = kept_range(enter, leave - enter, vec2(0.0, 1.0));
    vec3 middle = 0.5 * (enter + leave);
    float s0 = volume_value(enter), s1 = volume_value(middle), s2 = volume_value(leave);
#ifdef TRANSFER_2D
    float steep = is_seen(s0, s1) || is_seen(s1, s2) ? length(volume_gradient(middle)) : 0.0;
    vec2 tau = vec2(classify(s0, s1, steep).a, classify(s1, s2, steep).a);
#else
    vec2 tau = vec2(classify_extinction(s0, s1), classify_extinction(s1, s2));
#endif
    // Optical depths of the slab's halves along the axis.
    vec2 halves = tau * u_thickness * max(vec2(min(range.y, 0.5) - range.x, range.y - max(range.x, 0.5)), 0.0);
    float absorbed = halves.x + halves.y + FACES_PASSED(enter, leave - enter, range, 1.0);
#else
    const vec2 halves = vec2(0.0);
    const float absorbed = 0.0;
#endif
    // exp(-absorbed * secant) of all directions from three of them, by Lagrange's polynomial.
    vec3 left = exp(-absorbed * u_secants) * passed.x;
    #define PASS(came, group) (came * (left.x * u_weight0[group] + left.y * u_weight1[group] + left.z * u_weight2[group]))
#endif
    #define TAKE(result, state, group) came = arriving(state, 4 * group); result = PASS(came, group); sum += came * u_share[group];
    vec4 sum = vec4(0.0), came;
    TAKE(o_state0, u_state0, 0)
#if DIRECTIONS > 4
    TAKE(o_state1, u_state1, 1)
#endif
#if DIRECTIONS > 8
    TAKE(o_state2, u_state2, 2)
#endif
#if DIRECTIONS > 12
    TAKE(o_state3, u_state3, 3)
#endif
#if DIRECTIONS > 16
    TAKE(o_state4, u_state4, 4)
#endif
#if DIRECTIONS > 20
    TAKE(o_state5, u_state5, 5)
#endif
#if HOLLOW
    const float open = 1.0, half_left = 1.0;
#else
    float half_left = exp(-halves.x * u_secants.y) * 0.5 * (1.0 + passed.x);
    float open = max(exp(-2.0 * absorbed) * passed.y * passed.y, LEAST);
#endif
    o_light = vec2(dot(sum, vec4(1.0)) * half_left * open, open);
}
