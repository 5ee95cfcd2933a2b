// A layer of the volume with the light that reaches each voxel beside its value: the ray caster gets both by one look-up.
//
// LIGHTS     lamps with a visibility of their own
#include "volume"
#include "skip"
uniform vec3 u_light_color[4];       // linear RGB times intensity
#include "world_light"

flat in int v_layer;
uniform float u_light_scale;         // linear light that 1 stands for

layout(location = 0) out vec4 o_voxel;

void main() {
    ivec3 voxel = ivec3(ivec2(gl_FragCoord.xy), v_layer);
    vec3 t = (vec3(voxel) + 0.5) * u_voxel;
    ivec3 block = ivec3(min(t * u_blocks, vec3(textureSize(u_distance, 0)) - 0.5));
    o_voxel = vec4(texelFetch(u_volume, voxel, 0).r, 0.0, 0.0, 0.0);
    // Rays that leave a visible block reach at most the next one. A loop: software renderers leave it early, but not a branch.
    int near = texelFetch(u_distance, block, 0).r <= 1u ? 1 : 0;
    for (int k = 0; k < near; ++k) o_voxel.gba = world_light(t) / u_light_scale;
}
