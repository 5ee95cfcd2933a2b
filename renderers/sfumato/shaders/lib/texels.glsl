// Texels of the packed texture: which block each belongs to, and where in the volume it lies. Needs volume, clip, transfer, solid.

uniform usampler3D u_bricks;     // reverse index: per brick of 16^3 texels its level, and where its blocks begin in the list
uniform usampler2D u_list;       // place (xyz) of each block in the volume; w = 0: no block
uniform int u_layer;

const int EDGE = 16, FINEST = 4, LIST_WIDTH = 1024;

struct Texel {
    bool there;
    int level;
    vec3 t;                      // its centre, texture coordinates
};

Texel texel_at(ivec3 at) {
    uvec2 brick = texelFetch(u_bricks, at / EDGE, 0).rg;
    if (brick.r == 255u) return Texel(false, 0, vec3(0.0));
    int level = int(brick.r), res = 1 << level, across = EDGE >> level;
    ivec3 local = at % EDGE, sub = local / res;
    int entry = int(brick.g) + sub.x + across * (sub.y + across * sub.z);
    uvec4 block = texelFetch(u_list, ivec2(entry % LIST_WIDTH, entry / LIST_WIDTH), 0);
    return Texel(block.w != 0u, level, (vec3(block.xyz) + (vec3(local % res) + 0.5) / float(res)) / u_blocks_per_unit);
}

// The value that rays see at a place; u_there is 0 where nothing is seen.
float seen_value(vec3 t, out float there) {
    there = kept_point(t);
#ifdef PACKED
    vec3 q = t * u_blocks_per_unit;
    uvec4 block = block_at(ivec3(floor(q)));
    there *= float(is_shown(block));
    return there == 0.0 ? 0.0 : textureLod(u_packed, packed_place(block, q - floor(q)), 0.0).r;
#else
    return there == 0.0 ? 0.0 : textureLod(u_volume, t, 0.0).r;
#endif
}

// Extinction per mm at a place.
float matter_at(vec3 t) {
    float there, value = seen_value(t, there);
    return there == 0.0 ? 0.0 : SOLIDIFIED(extinction_around(value, value, t), t, 0.0);
}
