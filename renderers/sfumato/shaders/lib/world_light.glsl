// Light that is kept in the volume's own space, whoever looks: from all around, and of lamps.
//
// LIGHTS     lamps with a visibility of their own, the first ones
// FACING     surfaces that turn away from a lamp are darker
// SPECULAR   surfaces have highlights

uniform sampler3D u_world_light;     // rgb: light from all around and of further lamps; a: visibility of lamp 0
uniform sampler3D u_world_lamps;     // rgb: visibilities of lamps 1 to 3
uniform vec3 u_world_scale;          // the volume's texture coordinates to these textures'
uniform vec3 u_world_offset;
uniform vec4 u_lamp_place[4];        // world: place of a lamp in mm (w = 1), or the unit vector towards it (w = 0)
uniform float u_world_lift;          // mm before a surface at which its light is looked up
uniform float u_facing;              // how much a surface's slope counts, 0 to 1

// All light at a place of the volume, linear RGB, as it is without slopes.
vec3 world_light(vec3 t) {
    vec4 light = textureLod(u_world_light, t * u_world_scale + u_world_offset, 0.0);
    vec3 sum = light.rgb;
#if LIGHTS > 0
    sum += u_light_color[0] * light.a;
#endif
#if LIGHTS > 1
    vec3 lamps = textureLod(u_world_lamps, t * u_world_scale + u_world_offset, 0.0).rgb;
    sum += u_light_color[1] * lamps.r + u_light_color[2] * lamps.g + u_light_color[3] * lamps.b;
#endif
    return sum;
}

#if defined(FACING) && (FACING || SPECULAR)
// Colour that a segment of opacity alpha sends to the eye; t and p_world are its middle.
vec3 world_lit(vec3 color, float alpha, vec3 t, vec3 p_world, vec3 view) {
    Slope slope = slope_at(t, view);
    // A surface gets the light that is just before it; within it are the steps of the cells.
    t += mat3(u_texture_from_world) * slope.normal * (u_world_lift * slope.surface);
    vec4 light = textureLod(u_world_light, t * u_world_scale + u_world_offset, 0.0);
    vec3 sum = light.rgb, shine = vec3(0.0);
#if LIGHTS > 0
    float visible[4];
    visible[0] = light.a;
#if LIGHTS > 1
    vec3 lamps = textureLod(u_world_lamps, t * u_world_scale + u_world_offset, 0.0).rgb;
    visible[1] = lamps.r;
    visible[2] = lamps.g;
    visible[3] = lamps.b;
#endif
    for (int l = 0; l < LIGHTS; ++l) {
        float factor = visible[l];
        vec3 towards = normalize(u_lamp_place[l].xyz - u_lamp_place[l].w * p_world);
        float facing = dot(slope.normal, towards);
#if SPECULAR
        float gleam = facing > 0.0 ? pow(max(dot(slope.normal, normalize(towards + view)), 0.0), u_shininess) : 0.0;
        shine += u_light_color[l] * (factor * u_specular * gleam * slope.surface);
#endif
#if FACING
        factor *= mix(1.0, max(facing, 0.0), u_facing * slope.surface);
#endif
        sum += u_light_color[l] * factor;
    }
#endif
    return alpha * (color * sum + shine);
}
#endif
