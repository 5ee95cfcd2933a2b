// Blocks of many resolutions in one packed texture, and the index that says where each one's texels are.
//
// JOINED     0: each block by itself, held constant from its outermost texels on; 1: interpolated between blocks

#ifndef JOINED
#define JOINED 0
#endif

uniform sampler3D u_packed;      // normalised values of all blocks
uniform usampler3D u_index;      // per block of the volume: first texel (xyz) in the packed texture, level and rim (w)
uniform vec3 u_blocks_per_unit;  // blocks per unit of the volume's texture coordinates
uniform vec3 u_packed_texel;     // a texel of the packed texture in its coordinates

const uint NO_BLOCK = 7u;        // level of what is not there

// The level of a block; 2^level texels along an edge.
uint level_of(uvec4 block) { return block.w & 7u; }

// Whether anything is visible in a block.
bool is_shown(uvec4 block) { return (block.w & 255u) < NO_BLOCK; }

// How far from its faces, in blocks, a block and its neighbours may have to be interpolated.
float rim_of(uvec4 block) { return 0.5 / float(1u << (block.w >> 8)); }

// Where in the packed texture a place within a block (0 to 1) lies.
vec3 packed_place(uvec4 block, vec3 within) {
    float res = float(1u << level_of(block));
    return (vec3(block.xyz) + clamp(within * res, 0.5, res - 0.5)) * u_packed_texel;
}

// The block at a place of the volume's grid; beyond it there is none.
uvec4 block_at(ivec3 block) {
    ivec3 last = textureSize(u_index, 0) - 1;
    bool beyond = any(lessThan(block, ivec3(0))) || any(greaterThan(block, last));
    return beyond ? uvec4(uvec3(0u), 0xffffu) : texelFetch(u_index, block, 0);
}

// A place in blocks; what is a little beyond the volume belongs to its outermost blocks.
vec3 place_in_blocks(vec3 t) { return clamp(t * u_blocks_per_unit, vec3(1e-4), vec3(textureSize(u_index, 0)) - 1e-4); }

// Interpolation between the up to eight blocks around the nearest corner (after Ljung2006): each is asked at the
// place nearest to q within its own outermost texels, and counts by how near q is along each axis.
vec4 joined_value(sampler3D texels, vec3 q) {
    ivec3 corner = ivec3(floor(q + 0.5));
    vec3 below = vec3(1e-6), above = vec3(1e-6);  // half a texel, at most, of the blocks on either side of the corner
    for (int k = 0; k < 8; ++k) {
        ivec3 side = ivec3(k & 1, (k >> 1) & 1, k >> 2);
        uvec4 block = block_at(corner - 1 + side);
        float half_texel = !is_shown(block) ? 0.0 : 0.5 / float(1u << level_of(block));
        below = mix(max(below, half_texel), below, vec3(side));
        above = mix(above, max(above, half_texel), vec3(side));
    }
    vec3 share = clamp((q - vec3(corner) + below) / (below + above), 0.0, 1.0);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int k = 0; k < 8; ++k) {
        ivec3 side = ivec3(k & 1, (k >> 1) & 1, k >> 2);
        uvec4 block = block_at(corner - 1 + side);
        vec3 part = mix(1.0 - share, share, vec3(side));
        // A little in any case: beside an empty block the others have to do.
        float weight = max(part.x * part.y * part.z, 1e-5) * float(is_shown(block));
        if (weight <= 0.0) continue;
        vec3 within = clamp(q - vec3(corner - 1 + side), 0.0, 1.0);
        sum += weight * textureLod(texels, packed_place(block, within), 0.0);
        total += weight;
    }
    return sum / max(total, 1e-6);
}

// What the packed texture holds at a place of the volume.
vec4 packed_value(sampler3D texels, vec3 t) {
    vec3 q = place_in_blocks(t);
    ivec3 at = ivec3(floor(q));
    uvec4 block = block_at(at);
    vec3 within = clamp(q - vec3(at), 0.0, 1.0);
    bool on_rim = JOINED == 1 && any(greaterThan(abs(within - 0.5), vec3(0.5 - rim_of(block))));
    // What is visible in an empty block belongs to its neighbours' outermost voxels.
    if (on_rim || !is_shown(block)) return joined_value(texels, q);
    return textureLod(texels, packed_place(block, within), 0.0);
}

// The volume's value from its blocks, where the volume itself is not there. Only the finest blocks are joined: between
// a fine block and a coarse one a surface would be smeared over half of the coarse one.
float block_value(vec3 t) {
    vec3 q = place_in_blocks(t);
    ivec3 at = ivec3(floor(q));
    uvec4 block = block_at(at);
    vec3 within = q - vec3(at);
    bool fine = level_of(block) == 4u && block.w >> 8 == 4u;
    if (fine && any(greaterThan(abs(within - 0.5), vec3(0.5 - rim_of(block))))) return joined_value(u_packed, q).r;
    return textureLod(u_packed, packed_place(block, within), 0.0).r;
}

// Samples that may be taken as one in the block at a place: as gathering's steps, longer where blocks are coarser.
int samples_as_one(vec3 t) {
    uint level = level_of(block_at(ivec3(floor(place_in_blocks(t)))));
    return level == NO_BLOCK ? 1 : (1 + (1 << (4 - int(level)))) / 2;
}
