// Light from lamps' textures (the light prepass), and what a slab returns of it.
//
// LIGHTS     number of lights
// GEOMETRY   geometry casts shadows on the volume
// NEAR       samples on the way to a lamp's texture, in which the ray caster itself looks for what stands close by

uniform sampler3D u_light0, u_light1, u_light2, u_light3;    // visibility times openness, and openness; one lamp each
uniform mat4 u_light_from_texture[4];    // the volume's texture coordinates to the lamp's
uniform vec3 u_to_light[4];              // from a point to where its light is asked for, the volume's texture coordinates
uniform float u_near_length[4];          // mm of optical path that this way counts as
uniform float u_near_end[4 * NEAR];      // shares of this way at which the ray caster looks, lamp by lamp, the last is 1

// Light that what stands between t, where the volume has this value, and the place where the lamp's texture is asked lets through; by one look if it is faint.
float near_field(int l, vec3 t, float value, bool faint) {
    vec3 along = u_to_light[l];
    vec2 kept = kept_range(t, along, vec2(0.0, 1.0));
    float depth = 0.0, begin = 0.0;
    for (int k = faint ? NEAR - 1 : 0; k < NEAR; ++k) {
        float end = u_near_end[l * NEAR + k], next = volume_value(t + along * end);
        depth += extinction_around(value, next, t + along * (0.5 * (begin + end))) * max(min(kept.y, end) - max(kept.x, begin), 0.0);
        value = next;
        begin = end;
    }
    return exp(-depth * u_near_length[l] - FACES_PASSED(t, along, kept, 1.0));
}

#if GEOMETRY
// How much of each texel geometry covers, slab by slab of a lamp's lattice, the slabs side by side (combined/cover.py).
uniform sampler2D u_cover0, u_cover1, u_cover2, u_cover3;
uniform ivec2 u_cover_size[4];           // texels of a slab
uniform int u_cover_columns[4];          // slabs in a row
uniform float u_cover_slabs[4];          // number of slabs
uniform float u_cover_way[4];            // slabs between a sample and where its light is asked for
uniform float u_cover_opacity;

// Light that geometry between a point of a lamp's texture and the place where its light is asked for lets through.
float near_cover(sampler2D cover, int l, vec3 at) {
    float s = at.z * (u_cover_slabs[l] + 1.0) - 1.0, begin = max(s - u_cover_way[l], 0.0), covered = 0.0;
    vec2 size = vec2(u_cover_size[l]), texel = clamp(at.xy * size, vec2(0.5), size - 0.5);
    vec2 picture = vec2(textureSize(cover, 0));
    // Which slab's corner: by floats, since software renderers divide integers one by one.
    float last = min(s, u_cover_slabs[l]), columns = float(u_cover_columns[l]);
    vec2 scale = 1.0 / picture;
    for (float j = floor(begin); j < last; j += 1.0) {
        float row = floor((j + 0.5) / columns);
        vec2 corner = vec2(j - row * columns, row) * size;
        covered += textureLod(cover, (corner + texel) * scale, 0.0).r * (min(s, j + 1.0) - max(begin, j));
    }
    return 1.0 - u_cover_opacity * min(covered, 1.0);
}
#define NEAR_COVER(l, at) near_cover(u_cover##l, l, at)
#else
#define NEAR_COVER(l, at) 1.0
#endif

// A lamp's visibility. Texels that stand in matter are dark by it; so they count less the less open they are, and a
// surface that light grazes is not striped by what lies below it.
float light_at(sampler3D light, vec3 at) {
    vec2 both = textureLod(light, at, 0.0).rg;
    return both.r / both.g;
}

// Where a sample's light is asked for in a lamp's texture, and where the sample itself lies in it.
vec3 asked_at(int l, vec3 t) { return (u_light_from_texture[l] * vec4(t + u_to_light[l], 1.0)).xyz; }
vec3 place_in(int l, vec3 t) { return (u_light_from_texture[l] * vec4(t, 1.0)).xyz; }

#ifndef SURFACES
// Visibility of all lights at slab i, for what a view ray meets at its two planes; what is faint needs no close look.
void visibilities(int i, Meeting front, Meeting back, bool faint, out float visible[4]) {
    #define LIGHT_IN(l) (u_rear[l] == 1 ? back.t : front.t)
    #define SEEN(l) visible[l] = near_field(l, LIGHT_IN(l), u_rear[l] == 1 ? back.value : front.value, faint) * light_at(u_light##l, asked_at(l, LIGHT_IN(l))) * NEAR_COVER(l, place_in(l, LIGHT_IN(l)));
#if LIGHTS > 0
    SEEN(0)
#endif
#if LIGHTS > 1
    SEEN(1)
#endif
#if LIGHTS > 2
    SEEN(2)
#endif
#if LIGHTS > 3
    SEEN(3)
#endif
}
#endif
