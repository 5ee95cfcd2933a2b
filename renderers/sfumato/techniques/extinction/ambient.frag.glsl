// Ambient light that reaches a layer of cells, by cuboid shells (Schlegel2011, Eq. 4, 5 and 8; methods.md).
//
// SHELLS     number of shells
#include "sums"

uniform int u_layer;
uniform sampler3D u_near;            // where light matters
uniform sampler3D u_means;           // the cells themselves, before they were added up
uniform ivec3 u_half[SHELLS];        // half sizes of the shells' boxes beyond the cell itself, in cells, ascending
uniform float u_weight[SHELLS];      // optical depth per sum of extinction in a shell
uniform float u_strength;

layout(location = 0) out vec4 o_light;

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), u_layer);
    o_light = vec4(1.0);
    // No shells where light does not matter: software renderers leave a loop early, but not a branch.
    int shells = texelFetch(u_near, cell, 0).r > 0.0 ? SHELLS : 0;
    vec3 depth = vec3(0.0), inner = texelFetch(u_means, cell, 0).rgb;
    for (int k = 0; k < shells; ++k) {
        vec3 outer = box_sum(max(cell - u_half[k], 0), min(cell + u_half[k] + 1, u_cells)).rgb;
        depth += max(outer - inner, 0.0) * u_weight[k];
        inner = outer;
    }
    o_light = vec4(exp(-u_strength * depth), 1.0);
}
