// Light from one direction for each texel of a layer of the packed texture (Hernell2007, Eq. 2; Fig. 2).
//
// COLORED    tissue gives off light, which is gathered too (Eq. 4)
#include "volume"
#include "clip"
#include "transfer"
#include "solid"
#include "texels"

uniform sampler3D u_origins;     // where rays begin, see origins.frag.glsl
uniform vec3 u_ray;              // the direction in texture coordinates, per mm
uniform float u_offset, u_radius;  // mm
uniform float u_samples;         // along the ray, for the finest level
uniform vec2 u_steps[5];         // per level: samples, and how much longer each is than the one before
uniform float u_gamma;           // exponent on what a sample lets through (Eq. 5)
uniform float u_weight;          // of this direction
uniform bool u_ends;             // light comes from the rays' ends alone (Fig. 1, left)
uniform float u_unit_distance;   // mm

layout(location = 0) out vec4 o_light;

// Extinction per mm at a place, and what it gives off.
float matter(vec3 t, out vec3 shining) {
    shining = vec3(0.0);
#if COLORED
    float there, value = seen_value(t, there), gradient = 0.0;
    if (there == 0.0) return 0.0;
#ifdef TRANSFER_2D
    gradient = steepness(value, value, t);
    float tau = classify(value, value, gradient).a;
#else
    float tau = classify_extinction(value, value);
#endif
    shining = classify_emission(value, value, gradient) / max(tau, 1e-20) * (1.0 - exp(-tau * u_unit_distance));
    return SOLIDIFIED(tau, t, 0.0);
#else
    return matter_at(t);
#endif
}

void main() {
    // 1. Which block is this, and where in the volume does the texel lie?
    ivec3 at = ivec3(ivec2(gl_FragCoord.xy), u_layer);
    Texel texel = texel_at(at);
    if (!texel.there) discard;
    vec4 origin = texelFetch(u_origins, at, 0);
    vec3 t = texel.t + origin.xyz * u_voxel;

    // 2. Fewer steps the coarser the block is, d (1 + 2^(finest - level)) / 2 in the mean. All begin with one of d, and
    // lengthen by and by: what is near counts most, and would tell one block from the next.
    float samples = u_steps[texel.level].x, growth = u_steps[texel.level].y;
    float length_mm = u_radius - u_offset;

    // 3. Along the ray each sample brings its share of the light that those before it let through.
    float through = 1.0, share = 1.0 / u_samples, at_share = 0.0;
    vec3 light = vec3(0.0), shining;
    float weight = u_weight * origin.a;
    for (float m = 0.0; m < samples && through > 1e-3; ++m) {
        float tau = matter(t + u_ray * (u_offset + (at_share + 0.5 * share) * length_mm), shining);
        light += weight * share * through * (1.0 + shining);
        through *= exp(-tau * u_gamma * share * length_mm);
        at_share += share;
        share *= growth;
    }
    if (u_ends) light = vec3(weight * through);
#if COLORED
    o_light = vec4(light, weight);
#else
    o_light = vec4(light.r, weight, 0.0, 0.0);
#endif
}
