// The one ray caster: marches the segments first..last-1 of every view ray, front to back, over what earlier passes left.
//
// SLICES     samples lie on planes that face the viewer; otherwise at equal distances along each ray
// SHADING    0: unlit, 1: light from swept layers, 2: by the gradient (Blinn-Phong), without shadows, 3: light from lamps' textures, 4: light kept in the volume's space,
//            5: light of each point's neighbourhood, 6: light that lies beside the values in the volume's texture
// LIGHTS     number of lights
// LITERAL    1: the published occlusion forms, which light a sample by its opacity, not by the slab term
// SPECULAR   the swept lights have gradient-based highlights
// LOCAL      the lamps' light is combined with that of each point's neighbourhood. 0: not, 1: product, 2: mix
// ADAPTIVE   longer steps where blocks are coarse
// EMISSION   tissue gives off light
// SURFACE    rays end at opaque surfaces that were drawn before
// GEOMETRY   geometry casts shadows on the volume
// SOLID      cut faces are solid: matter looks as if it went on behind them
#include "ray"
#include "volume"
#include "clip"
#include "transfer"
#include "solid"
#include "skip"
#include "slope"
uniform vec3 u_light_color[4];       // linear RGB times intensity
uniform vec3 u_towards[4];           // unit vector to the light, world

uniform sampler2D u_previous;    // colour and opacity so far
uniform bool u_start;            // there is nothing so far
uniform float u_z0;              // depth of plane 0 in mm (slices), or the samples' offset in steps, in (-1, 0] (rays)
uniform float u_step;            // sampling distance in mm
uniform float u_together;        // longest way that is shaded together, mm of depth
uniform int u_first, u_last;     // segments of this pass
uniform float u_near;            // mm
uniform float u_far;             // mm
uniform float u_ambient, u_diffuse, u_specular, u_shininess;
uniform float u_unshadowed;      // 1: all light arrives, nothing is in its way

#if SHADING == 1 || SHADING == 3
// Where a view ray meets a plane of the stack, and the value there.
struct Meeting { vec2 lateral; vec3 t; float value; };
uniform int u_rear[4];               // 1: behind the subject, its light enters a slab at the back
#include "slab"
#endif
#if SHADING == 1
#include "occlusion"
#elif SHADING == 3
#include "light_volume"
#elif SHADING == 4
#include "world_light"
#endif
#if LOCAL > 0
#include "local_light"
#endif

#if SHADING == 6
uniform float u_light_scale;         // linear light that 1 in the volume's texture stands for
#endif

#if SURFACE
uniform sampler2D u_surface;         // linear depth in a; wider than the picture by u_margin on each side
uniform int u_margin;
#endif

layout(location = 0) out vec4 o_color;

// What a ray can still let through before it counts as opaque.
const float OPAQUE = 0.999;
// Whether shading costs so much more than looking that it pays to wait until all neighbours have something to shade.
const bool LOOK_ON = SHADING > 0 && SHADING < 6;
// Share of the picture up to which segments are shaded together; the published forms shade each.
#if LITERAL
const float THIN = 0.0;
#else
const float THIN = 0.05;
#endif
// Share of the picture up to which one look tells what stands close by.
const float FAINT = 0.03;

// What the volume's texture holds at a place: its value, and the light there if it lies beside it.
struct Reading { float value; vec3 light; };

Reading reading_at(vec3 t) {
#if SHADING == 6
    vec4 texel = textureLod(u_volume, t, 0.0);
    return Reading(texel.r, texel.gba);
#else
    return Reading(volume_value(t), vec3(0.0));
#endif
}

// The last plane at or before a depth, but not beyond the ray's end.
int plane_before(float z, float z0, float dz, float end) { return int(floor((min(z, end + dz) - z0) / dz)); }

#if SHADING == 2
// Blinn-Phong; the normal is turned to the viewer, since a gradient has no outside.
vec3 phong(vec3 gradient, vec3 view, vec3 color, float alpha) {
    float strength = length(gradient);
    vec3 normal = strength > 0.0 ? gradient / strength : view;
    if (dot(normal, view) < 0.0) normal = -normal;
    vec3 result = color * u_ambient;
    for (int l = 0; l < LIGHTS; ++l) {
        float facing = max(dot(normal, u_towards[l]), 0.0);
        float shine = facing > 0.0 ? pow(max(dot(normal, normalize(u_towards[l] + view)), 0.0), u_shininess) : 0.0;
        result += u_light_color[l] * (color * (u_diffuse * facing) + alpha * u_specular * shine * strength / (strength + u_edge));
    }
    return result;
}
#endif

#if SHADING == 1 || SHADING == 3
// Light that comes back from slabs of such a depth each that are opaque by alpha together, per light.
vec4 returned_light(float depth, float secant, float alpha) {
#if LITERAL
    return vec4(alpha);
#else
    return slab_term(depth, secant) * (alpha / max(1.0 - exp(-depth * secant), 1e-20));
#endif
}

// Colour that a slab of the occlusion methods sends to the eye.
vec3 lit(int i, Meeting front, Meeting back, bool faint, vec3 color, float alpha, vec4 returned, vec3 t, vec3 view) {
    vec3 result = vec3(0.0);
#if SPECULAR
    vec3 gradient = shading_gradient(t);
    float strength = length(gradient);
    if (dot(gradient, view) < 0.0) gradient = -gradient;
#endif
    float visible[4];
    visibilities(i, front, back, faint, visible);
    for (int l = 0; l < LIGHTS; ++l) {
        visible[l] = max(visible[l], u_unshadowed);
        // Ambient is what no shadow takes away, not even a sample's own; a fully lit surface stays as bright as it is.
        result += u_light_color[l] * color * mix(visible[l] * returned[l], alpha, max(u_ambient, u_unshadowed));
#if SPECULAR
        if (strength > 0.0 && dot(gradient, u_towards[l]) > 0.0) {
            float shine = pow(max(dot(gradient / strength, normalize(u_towards[l] + view)), 0.0), u_shininess);
            result += u_light_color[l] * (visible[l] * alpha * u_specular * shine * strength / (strength + u_edge));
        }
#endif
    }
#if LOCAL > 0
    result = with_lamps(alpha * color, light_around(t), result);
#endif
    return result;
}
#endif

void main() {
    vec4 sum = u_start ? vec4(0.0) : texelFetch(u_previous, ivec2(gl_FragCoord.xy), 0);
    o_color = sum;
    if (sum.a >= 1.0) return;

    Ray ray = view_ray(gl_FragCoord.xy);
    float secant = length(ray.direction);
    vec3 a = (u_texture_from_world * vec4(ray.origin, 1.0)).xyz;
    vec3 b = (u_texture_from_world * vec4(ray.direction, 0.0)).xyz;
    float end = u_far;
#if SURFACE
    // The last step before a surface is a part of a step (Schott2012, Alg. 2).
    end = min(end, texelFetch(u_surface, ivec2(gl_FragCoord.xy) + u_margin, 0).a);
#endif
    vec2 range = kept_range(a, b, vec2(u_near, end));
    if (range.x >= range.y) return;

#if SLICES
    float dz = u_step, z0 = u_z0;
#else
    float dz = u_step / secant, z0 = range.x + u_z0 * dz;
#endif
    int first = int(floor((range.x - z0) / dz)), i = max(u_first, first);
    float z = max(range.x, z0 + float(i) * dz);
    Reading here = reading_at(a + b * z);
    vec3 view = -ray.direction / secant;

#ifdef SOLID
    // Only the pass that meets the face shows it.
    bool entering = i == first;
    vec3 face = entering ? cut_face(a, b, range.x) : vec3(0.0);
    entering = dot(face, face) > 0.0;
#endif

    // Loops where branches would do: software renderers run both sides of a branch, but leave a loop when all have.
    bool known = true;           // whether `here` is what lies at z
    while (sum.a < OPAQUE && i < u_last && z < range.y) {
        // 1. Over what is empty, to the last plane before its end.
        int skipped = plane_before(z + empty_run(a, b, z), z0, dz, range.y);
        while (skipped > i && i < u_last && z < range.y) {
            i = skipped;
            z = z0 + float(i) * dz;
            known = false;
#ifdef SOLID
            entering = false;
#endif
            skipped = plane_before(z + empty_run(a, b, z), z0, dz, range.y);
        }
        if (!known) here = reading_at(a + b * z);
        known = true;
        // 2. Through the block, one segment at least.
        float leave = min(z + max(block_run(a, b, z), 1e-3 * dz), range.y);
#if ADAPTIVE
        int most = samples_as_one(a + b * (0.5 * (z + leave)));
#endif
        while (sum.a < OPAQUE && i < u_last && z < leave) {
            float left = 1.0 - sum.a;
            int taken = 1, j = i;
            float z_end = z, magnitude = 0.0, lean = 0.0;
            Reading next = here;
            vec4 through = vec4(0.0);       // optical depth along the axis (a) and colour times it, from z to z_end
            vec3 glow = vec3(0.0);
            // 3. On to the next segment in which something is visible. What is thin is shaded together: light changes
            // little in so short a way, and to ask for it is what costs most.
            while (j < u_last && z_end < leave) {
#if ADAPTIVE
                taken = clamp(int(ceil((leave - z_end) / dz)), 1, most);
#endif
                float z_next = min(z0 + float(j + taken) * dz, range.y);
                Reading there = reading_at(a + b * z_next);
                float way = max(z_next - z_end, 0.0), value = there.value;
#ifdef SOLID
                if (entering) { way = u_solid; value = next.value; }
#endif
#ifdef TRANSFER_2D
                magnitude = steepness(next.value, value, a + b * (0.5 * (z_end + z_next)));
#endif
                vec4 part = classify(next.value, value, magnitude);
#ifdef SOLID
                way = min(way, max(SOLID_DEPTH / max(part.a, 1e-20), z_next - z_end));
                g_face = entering && way * part.a > THIN ? face : j > i ? g_face : vec3(0.0);
                entering = false;
#endif
                part *= way;
                if (LOOK_ON && through.a > 0.0 && left * (through.a + part.a) > THIN) break;
                through += part;
                lean += part.a * float(j - i);
#if EMISSION
                glow += way * classify_emission(next.value, value, magnitude);
#endif
                z_end = z_next;
                next = there;
                j += taken;
                if (!LOOK_ON) break;
                if (through.a <= 0.0) {
                    z = z_end;
                    here = next;
                    i = j;
                } else if (left * (through.a + part.a) > THIN || z_end + dz - z > u_together) break;
            }
            if (LOOK_ON && through.a <= 0.0) break;

            // 4. Shade it.
            float depth = through.a;
            float alpha = 1.0 - exp(-depth * secant);
            vec3 color = through.rgb / max(depth, 1e-20);
#if SHADING == 1 || SHADING == 3
            // Segments that are shaded together get the light of their middle one, as much as they count.
            float number = float(j - i), middle = lean / max(depth, 1e-20);
#if SHADING == 1
            middle = floor(middle + 0.5);   // light is known slab by slab
#endif
            float z_front = z0 + (float(i) + middle) * dz, z_back = z_front + dz;
            vec2 values = mix(vec2(here.value), vec2(next.value), vec2(middle, middle + 1.0) / number);
            Meeting front = Meeting(ray.lateral0 + ray.lateral1 * z_front, a + b * z_front, values.x);
            Meeting back = Meeting(ray.lateral0 + ray.lateral1 * z_back, a + b * z_back, values.y);
            vec4 returned = returned_light(depth / number, secant, alpha);
            vec3 c = lit(i + int(middle), front, back, left * depth <= FAINT, color, alpha, returned, a + b * (0.5 * (z + z_end)), view);
#elif SHADING == 4
            float z_mid = 0.5 * (z + z_end);
#if FACING || SPECULAR
            vec3 c = world_lit(color, alpha, a + b * z_mid, ray.origin + ray.direction * z_mid, view);
#else
            vec3 c = alpha * color * world_light(a + b * z_mid);
#endif
#elif SHADING == 5
            vec3 c = local_lit(color, alpha, a + b * (0.5 * (z + z_end)), view);
#elif SHADING == 2
            vec3 c = alpha * phong(shading_gradient(a + b * (0.5 * (z + z_end))), view, color, 1.0);
#elif SHADING == 6
            vec3 c = alpha * color * (0.5 * u_light_scale * (here.light + next.light));
#else
            vec3 c = alpha * color;
#endif
#if EMISSION
            c += alpha * glow / max(depth, 1e-20);
#endif
            sum += (1.0 - sum.a) * vec4(c, alpha);
            z = z_end;
            here = next;
            i = j;
        }
    }
    if (sum.a >= OPAQUE) sum /= sum.a;
    o_color = sum;
}
