// The light of packed blocks as it is seen: joined between blocks, in cells of the volume's own space.
#define JOINED 1
#include "blocks"

uniform sampler3D u_map;         // sums over directions, see local_light.glsl
uniform ivec3 u_corner;          // first cell, in cells of the finest level from the volume's corner
uniform int u_layer;
uniform float u_scale;           // 1 / directions

layout(location = 0) out vec4 o_light;

const float FINEST_EDGE = 16.0;  // cells along a block's edge

void main() {
    vec3 cell = vec3(ivec3(ivec2(gl_FragCoord.xy), u_layer) + u_corner) + 0.5;
    vec4 sum = u_scale * packed_value(u_map, cell / (FINEST_EDGE * u_blocks_per_unit));
#if COLORED
    o_light = sum;
#else
    o_light = vec4(sum.ra, 0.0, 0.0);
#endif
}
