// Light that reaches a slab of the view-aligned stack, and what the slab returns of it.

uniform sampler2DArray u_layers;     // visibility; light l's slab i is layer l * u_layers_per_light + i - u_first
uniform int u_layers_per_light;
uniform ivec2 u_shear[4];            // columns' shift per plane, 1/32768 texel, signed (sweep: shear)
uniform vec2 u_lattice_origin[4];    // lateral position (mm) of texel coordinate 0 at plane 0
uniform float u_texel;               // mm
uniform vec2 u_lattice_size;         // texels
uniform vec3 u_light_color[4];       // linear RGB times intensity
uniform vec3 u_towards[4];           // unit vector to the light, world
uniform int u_rear[4];               // 1: behind the subject, its light enters at the slab's back
uniform sampler2D u_slab_term;       // the light that a slab returns, one light a channel (methods.md, 3a)
uniform float u_slab_secant_max;     // secant at the table's upper edge

// Visibility of light l at slab i, at a lateral position (mm) on the slab's front (or back) plane.
float visibility(int l, int i, int first, vec2 lateral) {
    ivec2 moved = u_shear[l] * (i + u_rear[l]);
    vec2 carried = vec2(moved & 32767) / 32768.0;
    vec2 texel = (lateral - u_lattice_origin[l]) / u_texel + carried;
    return textureLod(u_layers, vec3(texel / u_lattice_size, float(l * u_layers_per_light + i - first)), 0.0).r;
}

// Light returned by a slab of optical depth tau * thickness, per light; 1 for a solid one that faces the viewer.
vec4 slab_term(float depth, float secant) {
    vec2 at = vec2(1.0 - exp(-depth), u_slab_secant_max > 1.0 ? (secant - 1.0) / (u_slab_secant_max - 1.0) : 0.0);
    vec2 size = vec2(textureSize(u_slab_term, 0));
    return textureLod(u_slab_term, (at * (size - 1.0) + 0.5) / size, 0.0);
}
