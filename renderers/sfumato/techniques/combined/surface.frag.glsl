// What a surface leaves at a pixel: colour; normal, turned to the viewer, and linear depth.
//
// CUT    clip planes and crop box cut it
#if CUT
#include "volume"
#include "clip"
#endif

uniform vec3 u_eye;
uniform vec3 u_forward;
uniform bool u_parallel;

in vec3 v_world;
in vec3 v_normal;
in vec3 v_color;
in float v_depth;

layout(location = 0) out vec4 o_color;
layout(location = 1) out vec4 o_shape;

void main() {
#if CUT
    if (kept_point((u_texture_from_world * vec4(v_world, 1.0)).xyz) < 0.5) discard;
#endif
    vec3 view = u_parallel ? -u_forward : normalize(u_eye - v_world);
    // The triangle's own normal says which side is seen: files do not always wind triangles one way.
    vec3 flat_normal = cross(dFdx(v_world), dFdy(v_world));
    if (dot(flat_normal, view) < 0.0) flat_normal = -flat_normal;
    vec3 normal = length(v_normal) > 1e-3 ? normalize(v_normal) : normalize(flat_normal);
    if (dot(normal, flat_normal) < 0.0) normal = -normal;
    o_color = vec4(v_color, 1.0);
    o_shape = vec4(normal, v_depth);
}
