// Surfaces shaded, and the volume over them (Schott2012, Alg. 6).
//
// LIGHTS     number of lamps
// SLICED     0: light from lamps' textures, 1: from the view's slices
// NEAR       samples on the way to where a lamp's texture is asked; slabs, if it is sliced
#include "ray"
#include "volume"
#include "clip"
#include "transfer"
#include "solid"
#define SURFACES 1
#if SLICED
uniform int u_rear[4];               // 1: behind the subject, its light enters a slab at the back
uniform float u_z0, u_step;          // depth of plane 0, distance of planes; mm
#include "occlusion"
#else
#include "light_volume"
#endif

uniform vec3 u_light_color[4];       // linear RGB times intensity
uniform vec3 u_towards[4];           // unit vector to the lamp, world
uniform sampler2D u_over;            // the volume as seen before the surfaces
uniform sampler2D u_surface;         // normal, and linear depth in mm in a; wider than the picture by u_margin on each side
uniform sampler2D u_surface_color;
uniform int u_margin;
uniform float u_nothing;             // depth where there is no surface
uniform float u_ambient;             // share of each lamp that no shadow takes away
uniform float u_unshadowed;          // 1: all light arrives, nothing is in its way
uniform float u_surface_ambient, u_surface_diffuse, u_surface_specular, u_surface_shininess;
uniform float u_vicinity;            // strength
uniform float u_lift[4];             // mm: texel of each lamp's light volume
uniform float u_lift_share[4];       // the same as a part of the way to where a lamp's light is asked for
uniform int u_show;                  // 0: the picture, 1: occlusion, 2: partial occlusion alone, 3: vicinity occlusion alone
#include "vicinity"

layout(location = 0) out vec4 o_color;

// Light that the sweep says arrives at a surface point (the paper's partial occlusion).
#if SLICED
#define PARTIAL(l) partial(l, p, normal)
float partial(int l, vec3 p, vec3 normal) {
#else
#define PARTIAL(l) partial(l, u_light##l, p, normal)
float partial(int l, sampler3D light, vec3 p, vec3 normal) {
#endif
    float cosine = dot(normal, u_towards[l]);
    // Off the texels that the surface itself covers; the more, the more the lamp grazes it.
    float texels = 0.5 + 1.5 * sqrt(max(1.0 - cosine * cosine, 0.0));
    vec3 lifted = p + normal * (u_lift[l] * texels);
    // The way that is looked through is as much longer as the surface point was lifted towards the lamp.
    float longer = 1.0 + u_lift_share[l] * texels * max(cosine, 0.0);
#if SLICED
    vec3 from_eye = lifted - u_eye, t = (u_texture_from_world * vec4(p, 1.0)).xyz;
    vec3 at = vec3(dot(from_eye, u_right), dot(from_eye, u_up), dot(from_eye, u_forward)) + float(NEAR) * u_to_light_view[l];
#if NEAR > 0
    return pow(near_field(l, t, volume_value(t), false), longer) * partial_occlusion(l, at);
#else
    return partial_occlusion(l, at);
#endif
#else
    vec3 t = (u_texture_from_world * vec4(p, 1.0)).xyz, t_lifted = (u_texture_from_world * vec4(lifted, 1.0)).xyz;
    return pow(near_field(l, t, volume_value(t), false), longer) * light_at(light, asked_at(l, t_lifted));
#endif
}

vec3 surface_color(vec3 p, vec3 view, vec3 normal, vec3 color, float z) {
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    float swept[4] = float[4](1.0, 1.0, 1.0, 1.0);
#if LIGHTS > 0
    swept[0] = PARTIAL(0);
#endif
#if LIGHTS > 1
    swept[1] = PARTIAL(1);
#endif
#if LIGHTS > 2
    swept[2] = PARTIAL(2);
#endif
#if LIGHTS > 3
    swept[3] = PARTIAL(3);
#endif
    vec3 term = vec3(0.0);
    for (int l = 0; l < LIGHTS; ++l) {
        float facing = max(dot(normal, u_towards[l]), 0.0);
        float close = u_vicinity > 0.0 ? mix(1.0, vicinity(l, p + normal * u_vicinity_bias, u_towards[l], z), u_vicinity) : 1.0;
        float occlusion = max(swept[l] * close, u_unshadowed);
        float shine = facing > 0.0 ? pow(max(dot(normal, normalize(u_towards[l] + view)), 0.0), u_surface_shininess) : 0.0;
        sum += u_light_color[l] * (color * mix(occlusion, 1.0, u_ambient) * (u_surface_ambient + u_surface_diffuse * facing)
            + occlusion * u_surface_specular * shine);
        float share = dot(u_light_color[l], vec3(1.0));
        term += share * vec3(occlusion, swept[l], close);
        weight += share;
    }
    term /= max(weight, 1e-9);
    return u_show == 0 ? sum : vec3(u_show == 1 ? term.x : u_show == 2 ? term.y : term.z);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 over = texelFetch(u_over, pixel, 0);
    vec4 shape = texelFetch(u_surface, pixel + u_margin, 0);
    o_color = over;
    if (shape.a >= u_nothing || over.a >= 1.0) return;
    Ray ray = view_ray(gl_FragCoord.xy);
    vec3 color = texelFetch(u_surface_color, pixel + u_margin, 0).rgb;
    vec3 shaded = surface_color(ray.origin + ray.direction * shape.a, -normalize(ray.direction), shape.xyz, color, shape.a);
    o_color = over + (1.0 - over.a) * vec4(shaded, 1.0);
}
