// Where the rays of each texel of a layer of the packed texture begin, and what its light counts for: see origins.py.
#include "volume"
#include "clip"
#include "transfer"
#include "solid"
#include "texels"

uniform float u_voxel_mm;

layout(location = 0) out vec4 o_origin;  // shift in voxels (xyz), weight (a)

const float SURFACE = 0.2;               // opacity of a voxel at which a surface begins
const float LEAST_SLOPE = 0.05;          // sum of opacities on one side less that on the other
const float LEAST_OPEN = 1e-3;
const float REACH = 1.25, DEEP = 2.0;    // how far from a texel surfaces are looked for: in its edge, and in voxels
const float STRIDE = 0.5, EXACT = 0.01;  // voxels

// Opacity of a voxel at a place.
float opaque(vec3 t) { return 1.0 - exp(-matter_at(t) * u_voxel_mm); }

// Sum over the corners of a cube around a place: towards where there is more matter.
vec3 slope_of_matter(vec3 t, float half_edge) {
    vec3 slope = vec3(0.0);
    for (int k = 0; k < 8; ++k) {
        vec3 side = vec3(k & 1, (k >> 1) & 1, k >> 2) * 2.0 - 1.0;
        slope += side * opaque(t + side * half_edge * u_voxel);
    }
    return slope;
}

// Distance along a line to the nearest surface that is left there, voxels; huge if there is none.
float nearest_surface(vec3 t, vec3 out_of, float reach) {
    const float NONE = 1e9;
    float best = NONE, before = opaque(t - out_of * reach);
    for (float u = STRIDE - reach; u < reach + STRIDE; u += STRIDE) {
        float now = opaque(t + out_of * u);
        if (before >= SURFACE && now < SURFACE && abs(u - 0.5 * STRIDE) < abs(best)) best = u - 0.5 * STRIDE;
        before = now;
    }
    if (best == NONE) return NONE;
    for (float half_step = 0.25 * STRIDE; half_step > EXACT; half_step *= 0.5) {
        best += opaque(t + out_of * best) >= SURFACE ? half_step : -half_step;
    }
    return best;
}

void main() {
    Texel texel = texel_at(ivec3(ivec2(gl_FragCoord.xy), u_layer));
    if (!texel.there) discard;
    // What stands in matter, and is not moved out of it, counts less between texels: it is dark.
    o_origin = vec4(0.0, 0.0, 0.0, max(1.0 - opaque(texel.t), LEAST_OPEN));
    float edge = float(EDGE >> texel.level);  // voxels
    vec3 slope = slope_of_matter(texel.t, 0.75 * edge + 0.5);
    if (length(slope) < LEAST_SLOPE) return;
    vec3 out_of = -normalize(slope);
    float shift = nearest_surface(texel.t, out_of * u_voxel, REACH * edge + DEEP);
    if (abs(shift) < 1e8) o_origin = vec4(out_of * shift, 1.0);
}
