// Mean extinction of a layer of cells: what the summed-area tables add up. Optical depth per cell.
//
// SUB        samples along each edge of a cell
// AMBIENT    1: there is a second texture, of what takes away light from all around
#include "volume"
#include "clip"
#include "transfer"
#include "solid"
#include "skip"

uniform vec3 u_first;        // texture coordinates of the corner of cell 0
uniform vec3 u_cell;         // a cell's edges in texture coordinates
flat in int v_layer;
uniform float u_length;      // edge of a cell in mm
uniform float u_dense;       // extinction per mm from which matter counts as dense
uniform float u_limit;       // largest extinction per mm that counts for light from all around
uniform float u_bleeding;    // how much neighbours colour the light from all around

layout(location = 0) out vec4 o_matter;      // thin matter, dense matter, share that is dense
#if AMBIENT
layout(location = 1) out vec4 o_dimming;     // rgb: what dims light from all around, of each colour
#endif

void main() {
    o_matter = vec4(0.0);
#if AMBIENT
    o_dimming = vec4(0.0);
#endif
    vec3 corner = u_first + u_cell * vec3(floor(gl_FragCoord.xy), float(v_layer));
    ivec3 block = clamp(ivec3(floor((corner + 0.5 * u_cell) * u_blocks)), ivec3(0), textureSize(u_distance, 0) - 1);
    // A cell is not larger than a block: with a block between it and the next visible one, it is empty.
    if (texelFetch(u_distance, block, 0).r > 1u) return;
    vec3 matter = vec3(0.0), dimming = vec3(0.0);
    for (int i = 0; i < SUB * SUB * SUB; ++i) {
        vec3 share = (vec3(float(i % SUB), float((i / SUB) % SUB), float(i / (SUB * SUB))) + 0.5) / float(SUB);
        vec3 t = corner + u_cell * share;
        float value = volume_value(t), magnitude = steepness(value, value, t);
        vec4 here = classify(value, value, magnitude) * kept_point(t);
#ifdef SOLID
        here *= SOLIDIFIED(here.a, t, u_length) / max(here.a, 1e-20);
#endif
        float dense = float(here.a >= u_dense);
        matter += vec3(here.a * (1.0 - dense), here.a * dense, dense / u_length);
        dimming += min(here.a, u_limit) * max(1.0 - u_bleeding * here.rgb / max(here.a, 1e-20), 0.0);
    }
    o_matter = vec4(matter * (u_length / float(SUB * SUB * SUB)), 0.0);
#if AMBIENT
    o_dimming = vec4(dimming * (u_length / float(SUB * SUB * SUB)), 0.0);
#endif
}
