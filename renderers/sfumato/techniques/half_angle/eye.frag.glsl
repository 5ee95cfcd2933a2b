// A slice on its way to the eye: colour and opacity of the slab around it, in the light that reaches the slab.
//
// REVERSE    1: the light comes from behind the subject, it enters a slab on the side that is away from the eye
// EMISSION   tissue gives off light
// SOLID      cut faces are solid: matter looks as if it went on behind them
#include "ray"
#include "volume"
#include "clip"
#include "transfer"
#include "solid"

uniform sampler2D u_light;                  // transmittance towards the light, before this slice
uniform mat4x2 u_light_from_world;          // world mm to [0, 1]^2 over the light buffer
uniform vec3 u_light_color;                 // linear RGB times intensity; 0 without a light
uniform vec3 u_light_half;                  // half of the light's way through a slab, in texture coordinates
uniform float u_light_secant;               // of the light against the slices' normal
uniform float u_facing;                     // 1 / what a solid surface that faces the viewer returns
uniform vec3 u_axis;                        // the slices' normal, to the light's side
uniform float u_height;                     // mm along it
uniform float u_spacing;                    // mm

layout(location = 0) out vec4 o_color;

// What a slab returns of the light that enters it; optical depths through the slab along the eye's and the light's way.
float returned(float eye, float light) {
#if REVERSE
    float gap = light - eye;
    return eye * exp(-eye) * (abs(gap) < 1e-4 ? 1.0 : (1.0 - exp(-gap)) / gap);
#else
    return (1.0 - exp(-eye - light)) * eye / max(eye + light, 1e-20);
#endif
}

uniform float u_unshadowed;          // 1: all light arrives, nothing is in its way

void main() {
    Ray ray = view_ray(gl_FragCoord.xy);
    float slope = dot(u_axis, ray.direction);
    // A ray that grazes the slices would stay in one for ever.
    slope = slope < 0.0 ? min(slope, -1e-3) : max(slope, 1e-3);
    float secant = length(ray.direction) / abs(slope);
    float z = (u_height - dot(u_axis, ray.origin)) / slope;
    float half_slab = 0.5 * u_spacing / slope;       // from the slice to where light enters, in view depth; signed

    vec3 a = (u_texture_from_world * vec4(ray.origin, 1.0)).xyz;
    vec3 b = (u_texture_from_world * vec4(ray.direction, 0.0)).xyz;
    vec3 here = a + b * z;
    vec2 kept = kept_range(here, vec3(0.0), vec2(0.0, 1.0));    // the slice as a whole or not at all: jitter smooths the edge
    if (kept.x >= kept.y) discard;
    float enter = volume_value(a + b * (z + half_slab)), leave = volume_value(a + b * (z - half_slab));
    float magnitude = steepness(enter, leave, here);
    vec4 mean = classify(enter, leave, magnitude);
    if (mean.a <= 0.0) discard;

    float depth = mean.a * u_spacing * secant, solid = 1.0;
#ifdef SOLID
    // The first slice behind a cut face is the face.
    float came = kept_range(a, b, vec2(-1e30, 1e30)).x;
    bool first = z - came <= 2.0 * abs(half_slab) && cut_face(a, b, came) != vec3(0.0);
    if (first) solid = max(min(mean.a * u_solid, SOLID_DEPTH) / depth, 1.0);
#endif
    depth *= solid;
    float alpha = 1.0 - exp(-depth);
    // The light has its own way through the slab: on a wall that slants, not as much solid as the eye's.
    float light_depth = classify(volume_value(here + u_light_half), volume_value(here - u_light_half), magnitude).a;
    light_depth *= u_spacing * u_light_secant * solid;
    vec3 at = ray.origin + ray.direction * z;
    float visible = textureLod(u_light, u_light_from_world * vec4(at, 1.0), 0.0).r;
    float lit = mix(visible * u_facing * returned(depth, light_depth), alpha, u_unshadowed);
    vec3 c = mean.rgb / mean.a * u_light_color * lit;
#if EMISSION
    c += alpha * classify_emission(enter, leave, magnitude) / mean.a;
#endif
    o_color = vec4(c, alpha);
}
