// Where light matters: it is looked up in and around what is visible, and carried on from one cell beyond.
#include "sums"

flat in int v_layer;
uniform sampler3D u_matter;          // optical depth per cell: thin, dense
uniform int u_reach;                 // cells from what is visible

layout(location = 0) out float o_open;       // how open a cell is to light that is carried on; 0 where light does not matter

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), v_layer);
    vec4 around = box_sum(max(cell - u_reach, 0), min(cell + u_reach + 1, u_cells));
    vec2 matter = texelFetch(u_matter, cell, 0).rg;
    o_open = around.r + around.g > 0.0 ? exp(-2.0 * (matter.r + matter.g)) + 1e-4 : 0.0;
}
