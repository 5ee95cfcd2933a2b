#version 330 core
// Triangles as the camera sees them; the camera's uniforms are those of view rays (lib/ray).

in vec3 a_p;                 // mm, from u_middle
in vec4 a_normal;
in vec4 a_color;

uniform vec3 u_middle_from_eye;  // mm, along the camera's axes
uniform mat3 u_axes;             // rows: right, up, forward
uniform vec2 u_half;
uniform vec2 u_center;
uniform bool u_parallel;
uniform vec2 u_size;             // pixels of the whole picture
uniform vec2 u_corner;           // pixels from its lower left corner to that of this target
uniform vec2 u_pixel_jitter;
uniform vec2 u_target;           // pixels of this target
uniform vec2 u_depth_range;      // mm, nearest and farthest
uniform vec3 u_middle;

out vec3 v_world;
out vec3 v_normal;
out vec3 v_color;
out float v_depth;

void main() {
    vec3 at = u_axes * a_p + u_middle_from_eye;
    v_world = a_p + u_middle;
    v_normal = a_normal.xyz;
    v_color = a_color.rgb;
    v_depth = at.z;
    float w = u_parallel ? 1.0 : at.z;
    // Pixels times w, then to this target's clip space.
    vec2 whole = ((at.xy / u_half - u_center * w) + w) * 0.5 * u_size - (u_corner + u_pixel_jitter) * w;
    float near = u_depth_range.x, far = u_depth_range.y;
    float z = u_parallel ? 2.0 * (at.z - near) / (far - near) - 1.0
        : ((far + near) * at.z - 2.0 * far * near) / (far - near);
    gl_Position = vec4(whole / u_target * 2.0 - w, z, w);
}
