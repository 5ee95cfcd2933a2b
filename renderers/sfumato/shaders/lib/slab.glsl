// What a slab of the view-aligned stack returns of the light that reaches it.

uniform sampler2D u_slab_term;       // the light that a slab returns, one light a channel (methods.md, 3a)
uniform float u_slab_secant_max;     // secant at the table's upper edge

// Light returned by a slab of optical depth tau * thickness, per light; 1 for a solid one that faces the viewer.
vec4 slab_term(float depth, float secant) {
    vec2 at = vec2(1.0 - exp(-depth), u_slab_secant_max > 1.0 ? (secant - 1.0) / (u_slab_secant_max - 1.0) : 0.0);
    vec2 size = vec2(textureSize(u_slab_term, 0));
    return textureLod(u_slab_term, (at * (size - 1.0) + 0.5) / size, 0.0);
}
