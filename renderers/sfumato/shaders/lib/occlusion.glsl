// Light that reaches a slab of the view-aligned stack.
//
// NEAR       slabs before a sample, on the light's way, in which the ray caster itself looks for what stands close by
// GEOMETRY   geometry casts shadows on the volume
// SURFACES   surfaces ask for their light, instead of samples of the volume

uniform sampler2DArray u_layers;     // visibility; light l's slab i is layer l * u_layers_per_light + i mod u_layers_per_light
uniform int u_layers_per_light;
uniform ivec2 u_swept;               // first slab that was swept, and the last
uniform vec3 u_to_light[4];          // from a plane to the next one towards the light, texture coordinates
uniform float u_path[4];             // length of the light's way through a slab over its thickness
uniform ivec2 u_shear[4];            // columns' shift per plane, 1/32768 texel, signed (sweep: shear)
uniform vec2 u_lattice_origin[4];    // lateral position (mm) of texel coordinate 0 at plane 0
uniform float u_texel;               // mm
uniform vec2 u_lattice_size;         // texels

float layer_of(int l, int i) { return float(l * u_layers_per_light + i - (i / u_layers_per_light) * u_layers_per_light); }

#if NEAR > 0
// Light that what stands within NEAR slabs of t, a point where the volume has this value, lets through to it; by one look if it is faint.
float near_field(int l, vec3 t, float value, bool faint) {
    vec3 along = u_to_light[l];
    vec2 kept = kept_range(t, along, vec2(0.0, float(NEAR)));
    float depth = 0.0;
    int stride = faint ? NEAR : 1;
    for (int k = 0; k < NEAR; k += stride) {
        float begin = float(k), end = float(k + stride), next = volume_value(t + along * end);
        depth += extinction_around(value, next, t + along * (0.5 * (begin + end))) * max(min(kept.y, end) - max(kept.x, begin), 0.0);
        value = next;
    }
    return exp(-depth * u_step * u_path[l] - FACES_PASSED(t, along, kept, float(NEAR)));
}
#endif

#ifdef SURFACES
uniform vec3 u_to_light_view[4];     // from a plane to the next one towards the light: lateral x, y and depth in mm

// Light that reaches a place between two planes (lateral x, y and depth in mm): what it met before the one and the other,
// followed along its columns and mixed (Schott2012, Eq. 1-3; Alg. 4).
float partial_occlusion(int l, vec3 at) {
    float plane = (at.z - u_z0) / u_step;
    float q = clamp(plane - float(u_rear[l]), float(u_swept.x), float(u_swept.y));
    int i = int(q);
    vec2 column = (at.xy - u_lattice_origin[l]) / u_texel + vec2(u_shear[l]) / 32768.0 * plane;
    float between[2];
    for (int k = 0; k < 2; ++k) {
        int slab = min(i + k, u_swept.y);
        ivec2 base = (u_shear[l] * (slab + u_rear[l])) >> 15;
        between[k] = textureLod(u_layers, vec3((column - vec2(base)) / u_lattice_size, layer_of(l, slab)), 0.0).r;
    }
    return mix(between[0], between[1], q - float(i));
}
#else

#if GEOMETRY
uniform sampler2D u_cover0, u_cover1, u_cover2, u_cover3;
uniform int u_cover_columns[4];          // slabs in a row
uniform float u_cover_opacity;

// Light that geometry lets through in the slabs between a sample and where its light is asked for; `texel` is that of slab i.
float near_cover(sampler2D cover, int l, int i, int at, vec2 texel) {
    float covered = 0.0;
    vec2 picture = vec2(textureSize(cover, 0)), inside = clamp(texel, vec2(0.5), u_lattice_size - 0.5);
    ivec2 base = (u_shear[l] * (i + u_rear[l])) >> 15;
    for (int k = 1; k <= abs(at - i); ++k) {
        // In front light, layer `at` knows what lies before slab `at`; in light from behind, what lies behind it.
        int j = at > i ? i + k : i - k;
        vec2 there = clamp(inside + vec2(base - ((u_shear[l] * (j + u_rear[l])) >> 15)), vec2(0.5), u_lattice_size - 0.5);
        // By floats: software renderers divide integers one by one.
        float columns = float(u_cover_columns[l]), row = floor((float(j) + 0.5) / columns);
        vec2 corner = vec2(float(j) - row * columns, row) * u_lattice_size;
        covered += textureLod(cover, (corner + there) / picture, 0.0).r;
    }
    return 1.0 - u_cover_opacity * min(covered, 1.0);
}
#define NEAR_COVER(l, i, at, texel) near_cover(u_cover##l, l, i, at, texel)
#else
#define NEAR_COVER(l, i, at, texel) 1.0
#endif

// Texel of light l at slab i for a sample at `lateral` (mm) on the plane where the light enters the slab.
vec2 texel_of(int l, int i, vec2 lateral) {
    ivec2 moved = u_shear[l] * (i + u_rear[l]);
    return (lateral - u_lattice_origin[l]) / u_texel + vec2(moved & 32767) / 32768.0;
}

// The slab at which a sample asks for its light.
int asked_slab(int l, int i) {
#if NEAR > 0
    return u_rear[l] == 1 ? min(i + NEAR, u_swept.y) : max(i - NEAR, u_swept.x);
#else
    return i;
#endif
}

// Visibility of light l at slab i. `texel` and t are the sample's place on the plane where the light enters the slab.
float visibility(int l, int i, vec2 texel, vec3 t, float value, bool faint) {
    float near = 1.0;
    int at = asked_slab(l, i);
#if NEAR > 0
    // The lattice is as coarse as the voxels: what is close is looked for on the pixel's own way to the light, and the
    // lattice is asked a little nearer to the light, where its columns have not yet entered the surface themselves.
    near = near_field(l, t, value, faint);
    // A column keeps its number from plane to plane, but not its texel.
    texel += vec2(((u_shear[l] * (i + u_rear[l])) >> 15) - ((u_shear[l] * (at + u_rear[l])) >> 15));
#endif
    return near * textureLod(u_layers, vec3(texel / u_lattice_size, layer_of(l, at)), 0.0).r;
}

// Visibility of all lights at slab i, for what a view ray meets at its two planes; what is faint needs no close look.
void visibilities(int i, Meeting front, Meeting back, bool faint, out float visible[4]) {
    vec2 texels[4];
    for (int l = 0; l < LIGHTS; ++l) {
        bool rear = u_rear[l] == 1;
        texels[l] = texel_of(l, i, rear ? back.lateral : front.lateral);
        visible[l] = visibility(l, i, texels[l], rear ? back.t : front.t, rear ? back.value : front.value, faint);
    }
    #define COVERED(l) visible[l] *= NEAR_COVER(l, i, asked_slab(l, i), texels[l]);
#if GEOMETRY
#if LIGHTS > 0
    COVERED(0)
#endif
#if LIGHTS > 1
    COVERED(1)
#endif
#if LIGHTS > 2
    COVERED(2)
#endif
#if LIGHTS > 3
    COVERED(3)
#endif
#endif
}
#endif
