// Where light matters: it is looked up in and around what is visible, up to two cells away, and carried on from one cell beyond.
#include "sums"

uniform int u_layer;

layout(location = 0) out float o_near;

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), u_layer);
    vec4 matter = box_sum(max(cell - 3, 0), min(cell + 4, u_cells));
    o_near = float(matter.r + matter.g > 0.0);
}
