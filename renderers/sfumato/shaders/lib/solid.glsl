// Solid cut faces: matter on them looks, and stops light, as if it went on behind them. Needs volume, clip, transfer.
//
// SOLID      defined if there are such faces

#ifdef SOLID
uniform float u_solid;           // mm that matter on a cut face goes on for
uniform float u_solid_layer;     // mm below a face in which light is stopped
// Optical depth to which that is held: nothing more can be seen, and exponential functions stay finite.
const float SOLID_DEPTH = 12.0;

// Whether a way to a plane is the one by which a line came in: that was worked out before, elsewhere.
bool came_in(float way, float entry) { return way >= entry - 1e-5 * (abs(entry) + 1.0); }

// The cut face through which the line a + b * s came in at s = entry: its unit normal away from what is kept, world;
// zero where the volume itself begins there.
vec3 cut_face(vec3 a, vec3 b, float entry) {
    vec3 face = vec3(0.0);
    for (int k = 0; k < 3; ++k) {
        if (b[k] > 1e-20 && u_low[k] > 0.0 && came_in((u_low[k] - a[k]) / b[k], entry)) face[k] = -1.0;
        if (b[k] < -1e-20 && u_high[k] < 1.0 && came_in((u_high[k] - a[k]) / b[k], entry)) face[k] = 1.0;
    }
#if CLIPS
    for (int k = 0; k < u_clips; ++k) {
        float slope = dot(u_clip[k].xyz, b);
        if (slope > 1e-12 && came_in(-(dot(u_clip[k].xyz, a) + u_clip[k].w) / slope, entry)) face = -u_clip[k].xyz;
    }
#endif
    face = face * mat3(u_texture_from_world);
    return face / max(length(face), 1e-20);
}

// Optical depth of a cut face at a point of it.
float depth_of_face(vec3 t) {
    float value = volume_value(t);
    return min(extinction_around(value, value, t) * u_solid, SOLID_DEPTH);
}

// Optical depth of the cut faces that a way a + b * s, s from 0 to `end`, comes in or goes out through; `kept` is its
// part that is left, from kept_range.
float faces_passed(vec3 a, vec3 b, vec2 kept, float end) {
    float depth = 0.0;
    if (kept.x >= kept.y) return depth;
    if (kept.x > 0.0 && cut_face(a, b, kept.x) != vec3(0.0)) depth += depth_of_face(a + b * kept.x);
    if (kept.y < end && cut_face(a + b * end, -b, end - kept.y) != vec3(0.0)) depth += depth_of_face(a + b * kept.y);
    return depth;
}

// The nearest point of a cut face, as a way there in texture coordinates, and its distance in mm.
vec4 way_to_cut(vec3 t) {
    vec4 nearest = vec4(0.0, 0.0, 0.0, 1e9);
    mat3 to_texture = mat3(u_texture_from_world);
    #define NEARER(plane) { vec3 n = (plane).xyz * to_texture; float mm = (dot((plane).xyz, t) + (plane).w) / length(n); \
        if (mm < nearest.w) nearest = vec4(to_texture * (n * (-mm / length(n))), mm); }
    for (int k = 0; k < 3; ++k) {
        vec3 side = vec3(k == 0, k == 1, k == 2);
        if (u_low[k] > 0.0) NEARER(vec4(side, -u_low[k]))
        if (u_high[k] < 1.0) NEARER(vec4(-side, u_high[k]))
    }
#if CLIPS
    for (int k = 0; k < u_clips; ++k) NEARER(u_clip[k])
#endif
    return nearest;
}

// SOLIDIFIED: what stops light at a place where the matter has extinction tau (per mm), if faces reach so deep: what is on the face
// counts, not what is below it, or thin matter over a surface that grazes the face would darken it.
float solid_extinction(float tau, vec3 t, float layer) {
    vec4 way = way_to_cut(t);
    if (way.w >= layer) return tau;
    return max(tau, depth_of_face(t + way.xyz) / layer);
}
#define SOLIDIFIED(tau, t, least) solid_extinction(tau, t, max(u_solid_layer, least))
#define FACES_PASSED(a, b, kept, end) faces_passed(a, b, kept, end)
#else
#define SOLIDIFIED(tau, t, least) (tau)
#define FACES_PASSED(a, b, kept, end) 0.0
#endif
