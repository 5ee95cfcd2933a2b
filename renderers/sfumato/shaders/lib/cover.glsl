// Geometry in a sweep: how much of a texel it covers, slab by slab (combined/cover.py).
//
// SHEARED    columns move from slab to slab (the lattice of the view's slices)
//
// A surface that does not face the lamp squarely lies in several slabs, a part of each texel in each. Those parts lie side
// by side, so within three slabs coverage adds up, where independent things would multiply.

uniform sampler2D u_cover;
uniform ivec2 u_cover_at[3];         // corner of this slab's layer, and of the two that the light met before; negative: none
uniform float u_opacity;             // of geometry

#if SHEARED
uniform ivec2 u_cover_shift[3];      // texel here to that of the same column there
uniform ivec2 u_cover_extent;        // texels of a layer

float cover_in(int k, ivec2 texel) {
    ivec2 at = texel + u_cover_shift[k];
    bool outside = u_cover_at[k].x < 0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, u_cover_extent));
    return outside ? 0.0 : texelFetch(u_cover, max(u_cover_at[k], 0) + clamp(at, ivec2(0), u_cover_extent - 1), 0).r;
}
#else
float cover_in(int k, ivec2 texel) { return u_cover_at[k].x < 0 ? 0.0 : texelFetch(u_cover, u_cover_at[k] + texel, 0).r; }
#endif

// What geometry in this slab lets through of the light that the slabs before left (x), and how free of geometry this place is (y).
vec2 cover_passes(ivec2 texel) {
    float here = cover_in(0, texel), before = cover_in(1, texel), earlier = cover_in(2, texel);
    float left = max(1.0 - u_opacity * min(before + earlier, 1.0), 1e-3);
    float now = max(1.0 - u_opacity * min(here + before + earlier, 1.0), 0.0);
    return vec2(min(now / left, 1.0), 1.0 - min(here + before, 1.0));
}
