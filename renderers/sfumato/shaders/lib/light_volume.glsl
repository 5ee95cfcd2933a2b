// Light from lamps' textures (the light prepass), and what a slab returns of it.
//
// LIGHTS     number of lights
// NEAR       samples on the way to a lamp's texture, in which the ray caster itself looks for what stands close by

uniform sampler3D u_light0, u_light1, u_light2, u_light3;    // visibility times openness, and openness; one lamp each
uniform mat4 u_light_from_texture[4];    // the volume's texture coordinates to the lamp's
uniform vec3 u_to_light[4];              // from a point to where its light is asked for, the volume's texture coordinates
uniform float u_near_length[4];          // mm of optical path that this way counts as
uniform float u_near_end[4 * NEAR];      // shares of this way at which the ray caster looks, lamp by lamp, the last is 1

// Light that what stands between t, where the volume has this value, and the place where the lamp's texture is asked lets through.
float near_field(int l, vec3 t, float value) {
    vec3 along = u_to_light[l];
    vec2 kept = kept_range(t, along, vec2(0.0, 1.0));
    float depth = 0.0, begin = 0.0;
    for (int k = 0; k < NEAR; ++k) {
        float end = u_near_end[l * NEAR + k], next = volume_value(t + along * end);
        depth += classify_extinction(value, next) * max(min(kept.y, end) - max(kept.x, begin), 0.0);
        value = next;
        begin = end;
    }
    return exp(-depth * u_near_length[l]);
}

// A lamp's visibility. Texels that stand in matter are dark by it; so they count less the less open they are, and a
// surface that light grazes is not striped by what lies below it.
float light_at(sampler3D light, vec3 at) {
    vec2 both = textureLod(light, at, 0.0).rg;
    return both.r / both.g;
}

float seen(sampler3D light, int l, Meeting front, Meeting back) {
    vec3 t = u_rear[l] == 1 ? back.t : front.t;
    vec3 at = (u_light_from_texture[l] * vec4(t + u_to_light[l], 1.0)).xyz;
    return near_field(l, t, u_rear[l] == 1 ? back.value : front.value) * light_at(light, at);
}

// Visibility of all lights at slab i, for what a view ray meets at its two planes.
void visibilities(int i, Meeting front, Meeting back, out float visible[4]) {
#if LIGHTS > 0
    visible[0] = seen(u_light0, 0, front, back);
#endif
#if LIGHTS > 1
    visible[1] = seen(u_light1, 1, front, back);
#endif
#if LIGHTS > 2
    visible[2] = seen(u_light2, 2, front, back);
#endif
#if LIGHTS > 3
    visible[3] = seen(u_light3, 3, front, back);
#endif
}
