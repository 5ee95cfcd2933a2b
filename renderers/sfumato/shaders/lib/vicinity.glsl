// What geometry close by, as far as the picture shows it, takes of a lamp's light (Schott2012, Alg. 5).
//
// The paper counts what is nearer to the viewer within a disc, since its lamp is the viewer's. Here each point of the disc
// stands for a direction of the lamp's cone, and the picture's depths are asked on the way there: what lies before such a
// place by more than a bias, but not by more than the way is long, stands in the light. So the term leans and widens with
// the lamp, nothing shades itself, and what is far before a surface leaves no halo on it.

uniform int u_vicinity_samples;
uniform vec2 u_disc[118];            // Poisson disc of radius 1, turned from frame to frame
uniform float u_vicinity_way;        // mm
uniform float u_vicinity_bias;       // mm
uniform vec3 u_cone_axes[8];         // two unit vectors across each lamp's axis, world
uniform float u_cone_cosine[4];      // of each lamp's half angle
uniform float u_step_offset;         // 0 to 1, changes from frame to frame

const int VICINITY_STEPS = 4;

// Pixel of the surfaces' picture at which a world point is seen, and its depth in mm.
vec3 seen_at(vec3 p) {
    vec3 from_eye = p - u_eye;
    vec3 at = vec3(dot(from_eye, u_right), dot(from_eye, u_up), dot(from_eye, u_forward));
    vec2 ndc = at.xy / (u_parallel ? 1.0 : at.z) / u_half - u_center;
    return vec3((ndc + 1.0) * 0.5 * u_size - u_corner - u_pixel_jitter + float(u_margin), at.z);
}

bool blocked(vec3 p, vec3 direction, float way, float offset) {
    ivec2 size = textureSize(u_surface, 0);
    for (int m = 0; m < VICINITY_STEPS; ++m) {
        vec3 at = seen_at(p + direction * (way * (float(m) + offset) / float(VICINITY_STEPS)));
        ivec2 pixel = ivec2(floor(at.xy));
        if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) return false;
        float before = at.z - texelFetch(u_surface, pixel, 0).a;
        if (before > u_vicinity_bias && before < way) return true;
    }
    return false;
}

// Share of a lamp's cone that is free, seen from a surface point lifted by the bias; z is its depth in mm.
float vicinity(int l, vec3 p, vec3 towards, float z) {
    // No farther than the surfaces' picture reaches beyond the frame.
    float pixel = 2.0 * u_half.y * (u_parallel ? 1.0 : z) / u_size.y;
    float way = min(u_vicinity_way, float(u_margin) * pixel), free = 0.0;
    for (int k = 0; k < u_vicinity_samples; ++k) {
        vec2 q = u_disc[k];
        float r2 = dot(q, q), cosine = 1.0 - r2 * (1.0 - u_cone_cosine[l]);
        vec2 across = q * inversesqrt(max(r2, 1e-9)) * sqrt(max(1.0 - cosine * cosine, 0.0));
        vec3 direction = towards * cosine + u_cone_axes[2 * l] * across.x + u_cone_axes[2 * l + 1] * across.y;
        float offset = fract(u_step_offset + float(k) * 0.6180339887);
        free += blocked(p, direction, way, max(offset, 0.05)) ? 0.0 : 1.0;
    }
    return free / float(u_vicinity_samples);
}
