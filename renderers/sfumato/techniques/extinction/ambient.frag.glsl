// Ambient light that reaches a layer of cells, by cuboid shells (Schlegel2011, Eq. 4, 5 and 8; methods.md).
//
// SHELLS     number of shells
// PART       0: all shells. 1: those farther out, for each 2^3 cells, since they change little from cell to cell;
//            2: those close by, and what the farther ones dim
// WEIGHED    1: light times openness, and openness, to be carried on; 0: light
#include "sums"

flat in int v_layer;
uniform ivec3 u_half[SHELLS];        // half sizes of the shells' boxes in cells, ascending; beyond the cell itself (PART 1: from the middle of 2^3)
uniform float u_weight[SHELLS];      // optical depth per sum of extinction in a shell
#if PART == 1
uniform ivec3 u_inner;               // half size of the box that is close by
#else
uniform sampler3D u_near;            // how open cells are; 0 where light does not matter
uniform sampler3D u_means;           // the cells themselves, before they were added up
uniform float u_strength;
#endif
#if PART == 2
uniform sampler3D u_far;             // optical depth of the shells farther out
#endif

layout(location = 0) out vec4 o_light;   // PART 1: optical depth

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), v_layer);
    vec3 depth = vec3(0.0);
#if PART == 1
    ivec3 middle = 2 * cell + 1;
    vec3 inner = box_sum(max(middle - u_inner, 0), min(middle + u_inner, u_cells)).rgb;
    for (int k = 0; k < SHELLS; ++k) {
        vec3 outer = box_sum(max(middle - u_half[k], 0), min(middle + u_half[k], u_cells)).rgb;
        depth += max(outer - inner, 0.0) * u_weight[k];
        inner = outer;
    }
    o_light = vec4(depth, 0.0);
#else
    vec3 inner = texelFetch(u_means, cell, 0).rgb;
    for (int k = 0; k < SHELLS; ++k) {
        vec3 outer = box_sum(max(cell - u_half[k], 0), min(cell + u_half[k] + 1, u_cells)).rgb;
        depth += max(outer - inner, 0.0) * u_weight[k];
        inner = outer;
    }
#if PART == 2
    depth += textureLod(u_far, (vec3(cell) + 0.5) / vec3(u_cells), 0.0).rgb;
#endif
    o_light = vec4(exp(-u_strength * depth), 1.0);
#if WEIGHED
    o_light *= texelFetch(u_near, cell, 0).r;
#endif
#endif
}
