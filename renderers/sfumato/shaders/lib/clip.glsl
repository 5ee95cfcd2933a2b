// Clip planes and the crop box, both in texture coordinates: dot(plane.xyz, t) + plane.w >= 0 is kept.
// CLIPS      there are clip planes

uniform vec4 u_clip[6];
uniform int u_clips;
uniform vec3 u_low;      // crop box
uniform vec3 u_high;

// Narrow [range.x, range.y] to the part of the line a + b * s that is kept; empty if range.x >= range.y.
vec2 kept_range(vec3 a, vec3 b, vec2 range) {
    // A line parallel to a face divides by a tiny number instead of zero: +-huge, never NaN.
    vec3 safe = mix(b, vec3(1e-20), lessThan(abs(b), vec3(1e-20)));
    vec3 s0 = (u_low - a) / safe, s1 = (u_high - a) / safe;
    vec3 enter = min(s0, s1), leave = max(s0, s1);
    range.x = max(range.x, max(enter.x, max(enter.y, enter.z)));
    range.y = min(range.y, min(leave.x, min(leave.y, leave.z)));
#if CLIPS
    for (int k = 0; k < u_clips; ++k) {
        float at = dot(u_clip[k].xyz, a) + u_clip[k].w;
        float slope = dot(u_clip[k].xyz, b);
        if (abs(slope) < 1e-12) { if (at < 0.0) range.y = range.x - 1.0; }
        else if (slope > 0.0) range.x = max(range.x, -at / slope);
        else range.y = min(range.y, -at / slope);
    }
#endif
    return range;
}

// 1 where a point is kept, else 0.
float kept_point(vec3 t) {
    bool kept = all(greaterThanEqual(t, u_low)) && all(lessThanEqual(t, u_high));
#if CLIPS
    for (int k = 0; k < u_clips; ++k) kept = kept && dot(u_clip[k].xyz, t) + u_clip[k].w >= 0.0;
#endif
    return float(kept);
}
