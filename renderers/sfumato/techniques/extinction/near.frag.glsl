// Where light matters: it is looked up in and around what is visible, and carried on from one cell beyond.
#include "sums"

uniform int u_layer;
uniform int u_reach;                 // cells from what is visible

layout(location = 0) out float o_near;

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), u_layer);
    vec4 matter = box_sum(max(cell - u_reach, 0), min(cell + u_reach + 1, u_cells));
    o_near = float(matter.r + matter.g > 0.0);
}
