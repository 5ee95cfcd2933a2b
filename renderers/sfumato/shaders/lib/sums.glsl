// Sums over boxes of cells (Schlegel2011, 3.1), from a table that holds the sum over all cells up to each one.
//
// The table wraps around: a difference is exact as long as the box's own sum fits.

uniform usampler3D u_sums;
uniform ivec3 u_cells;               // cells of the table
uniform vec4 u_quantum;              // what a unit of the table stands for, per channel

uvec4 sum_below(ivec3 corner) {
    // Nothing lies below the first cell.
    uint inside = uint(min(corner.x, min(corner.y, corner.z)) > 0);
    return texelFetch(u_sums, max(corner - 1, 0), 0) * inside;
}

// Sum over the cells low <= c < high, both within 0..u_cells.
vec4 box_sum(ivec3 low, ivec3 high) {
    uvec4 sum = sum_below(high) - sum_below(ivec3(low.x, high.yz)) - sum_below(ivec3(high.x, low.y, high.z))
        - sum_below(ivec3(high.xy, low.z)) + sum_below(ivec3(low.xy, high.z)) + sum_below(ivec3(low.x, high.y, low.z))
        + sum_below(ivec3(high.x, low.yz)) - sum_below(low);
    return vec4(sum) * u_quantum;
}
