// The volume. Texture coordinates span the volume with [0, 1]^3; values are normalised to [0, 1].
//
// PACKED     1: the volume itself is not there, but its blocks are
#include "blocks"

uniform sampler3D u_volume;
uniform mat4 u_texture_from_world;
uniform vec3 u_voxel;            // size of a voxel in texture coordinates

#ifdef PACKED
float volume_value(vec3 t) { return block_value(t); }
#else
float volume_value(vec3 t) { return textureLod(u_volume, t, 0.0).r; }
#endif

// Gradient of the normalised value, world space, per mm; central differences over two voxels.
vec3 volume_gradient(vec3 t) {
    vec3 e = u_voxel;
    vec3 g = vec3(
        volume_value(t + vec3(e.x, 0.0, 0.0)) - volume_value(t - vec3(e.x, 0.0, 0.0)),
        volume_value(t + vec3(0.0, e.y, 0.0)) - volume_value(t - vec3(0.0, e.y, 0.0)),
        volume_value(t + vec3(0.0, 0.0, e.z)) - volume_value(t - vec3(0.0, 0.0, e.z)));
    return transpose(mat3(u_texture_from_world)) * (g / (2.0 * e));
}
