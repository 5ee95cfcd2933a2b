// The light that the ray caster looks up once a sample.
//
// AMBIENT    something dims the light from all around
// LAMPS      lamps with a visibility of their own, at most 4
flat in int v_layer;
uniform sampler3D u_ambient;
uniform vec3 u_ambient_light;        // linear RGB
uniform sampler3D u_lamp0, u_lamp1, u_lamp2, u_lamp3;

layout(location = 0) out vec4 o_world;
layout(location = 1) out vec4 o_lamps;

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), v_layer);
    o_world = vec4(u_ambient_light, 0.0);
    o_lamps = vec4(0.0);
#if AMBIENT
    o_world.rgb *= texelFetch(u_ambient, cell, 0).rgb;
#endif
#if LAMPS > 0
    o_world.a = texelFetch(u_lamp0, cell, 0).r;
#endif
#if LAMPS > 1
    o_lamps.r = texelFetch(u_lamp1, cell, 0).r;
#endif
#if LAMPS > 2
    o_lamps.g = texelFetch(u_lamp2, cell, 0).r;
#endif
#if LAMPS > 3
    o_lamps.b = texelFetch(u_lamp3, cell, 0).r;
#endif
}
