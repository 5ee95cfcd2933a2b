// Light that reaches a slab of the view-aligned stack, and what the slab returns of it.
//
// NEAR       slabs before a sample, on the light's way, in which the ray caster itself looks for what stands close by

uniform sampler2DArray u_layers;     // visibility; light l's slab i is layer l * u_layers_per_light + i mod u_layers_per_light
uniform int u_layers_per_light;
uniform ivec2 u_swept;               // first slab that was swept, and the last
uniform vec3 u_to_light[4];          // from a plane to the next one towards the light, texture coordinates
uniform float u_path[4];             // length of the light's way through a slab over its thickness
uniform ivec2 u_shear[4];            // columns' shift per plane, 1/32768 texel, signed (sweep: shear)
uniform vec2 u_lattice_origin[4];    // lateral position (mm) of texel coordinate 0 at plane 0
uniform float u_texel;               // mm
uniform vec2 u_lattice_size;         // texels

#if NEAR > 0
// Light that what stands within NEAR slabs of t, a point where the volume has this value, lets through to it.
float near_field(int l, vec3 t, float value) {
    vec3 along = u_to_light[l];
    vec2 kept = kept_range(t, along, vec2(0.0, float(NEAR)));
    float depth = 0.0;
    for (int k = 0; k < NEAR; ++k) {
        float next = volume_value(t + along * float(k + 1));
        depth += classify_extinction(value, next) * max(min(kept.y, float(k + 1)) - max(kept.x, float(k)), 0.0);
        value = next;
    }
    return exp(-depth * u_step * u_path[l]);
}
#endif

// Visibility of light l at slab i. `lateral` (mm) and t are the sample's place on the plane where the light enters the slab.
float visibility(int l, int i, vec2 lateral, vec3 t, float value) {
    ivec2 moved = u_shear[l] * (i + u_rear[l]);
    vec2 carried = vec2(moved & 32767) / 32768.0;
    vec2 texel = (lateral - u_lattice_origin[l]) / u_texel + carried;
    float near = 1.0;
#if NEAR > 0
    // The lattice is as coarse as the voxels: what is close is looked for on the pixel's own way to the light, and the
    // lattice is asked a little nearer to the light, where its columns have not yet entered the surface themselves.
    near = near_field(l, t, value);
    // A column keeps its number from plane to plane, but not its texel.
    int at = u_rear[l] == 1 ? min(i + NEAR, u_swept.y) : max(i - NEAR, u_swept.x);
    ivec2 base = moved >> 15, base_at = (u_shear[l] * (at + u_rear[l])) >> 15;
    texel += vec2(base - base_at);
    i = at;
#endif
    int layer = i - (i / u_layers_per_light) * u_layers_per_light;
    return near * textureLod(u_layers, vec3(texel / u_lattice_size, float(l * u_layers_per_light + layer)), 0.0).r;
}

// Visibility of all lights at slab i, for what a view ray meets at its two planes.
void visibilities(int i, Meeting front, Meeting back, out float visible[4]) {
    for (int l = 0; l < LIGHTS; ++l) {
        bool rear = u_rear[l] == 1;
        visible[l] = visibility(l, i, rear ? back.lateral : front.lateral, rear ? back.t : front.t, rear ? back.value : front.value);
    }
}
