// Empty space. A map over blocks of voxels tells how many blocks away (chessboard distance) something visible is.

uniform usampler3D u_distance;
uniform vec3 u_blocks;       // blocks per unit of texture coordinate

// How far a line a + b * s can go from s before it can meet anything; 0 where something is.
float empty_run(vec3 a, vec3 b, float s) {
    vec3 q = (a + b * s) * u_blocks, slope = b * u_blocks;
    ivec3 block = clamp(ivec3(floor(q)), ivec3(0), textureSize(u_distance, 0) - 1);
    float away = float(texelFetch(u_distance, block, 0).r);
    if (away == 0.0) return 0.0;
    vec3 inside = clamp(q - vec3(block), 0.0, 1.0);
    vec3 room = mix(inside, 1.0 - inside, greaterThan(slope, vec3(0.0))) + (away - 1.0);
    vec3 run = room / max(abs(slope), vec3(1e-20));
    return min(run.x, min(run.y, run.z));
}

// How far a line a + b * s can go from s before it leaves its block.
float block_run(vec3 a, vec3 b, float s) {
    vec3 q = (a + b * s) * u_blocks, slope = b * u_blocks;
    vec3 inside = q - floor(q);
    vec3 run = mix(inside, 1.0 - inside, greaterThan(slope, vec3(0.0))) / max(abs(slope), vec3(1e-20));
    return min(run.x, min(run.y, run.z));
}
