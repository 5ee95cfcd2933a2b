#version 330 core
// Tiles of a sheared lattice: runs of squares of columns, placed where the columns lie on a plane; six vertices each.

uniform isampler2D u_tiles;      // runs: tile index x, y, number of tiles
uniform int u_tiles_first;       // first run of this draw
uniform int u_tile_size;         // texels
uniform ivec2 u_base;            // column at texel (0, 0) of the plane
uniform ivec2 u_columns_low;     // column at tile (0, 0)
uniform ivec2 u_inner;           // first texel that may be drawn; the border stays clear
uniform ivec2 u_outer;           // one past the last
uniform vec2 u_extent;           // texels of the grid

void main() {
    const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(0, 1));
    int index = u_tiles_first + gl_VertexID / 6;
    int width = textureSize(u_tiles, 0).x;
    ivec3 run = texelFetch(u_tiles, ivec2(index % width, index / width), 0).xyz;
    ivec2 corner = (run.xy + corners[gl_VertexID % 6] * ivec2(run.z, 1)) * u_tile_size + u_columns_low - u_base;
    gl_Position = vec4(vec2(clamp(corner, u_inner, u_outer)) / u_extent * 2.0 - 1.0, 0.0, 1.0);
}
