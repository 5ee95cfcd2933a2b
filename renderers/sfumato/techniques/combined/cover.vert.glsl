#version 330 core
// Surfels (surfels.py) into the layers of a lamp's lattice, which lie side by side in one picture: a point each, two texels wide.

in vec3 a_p;                 // mm, from u_middle
in vec3 a_facing;            // sum of area times normal, mm^2
in vec3 a_diagonal;          // sum of area times normal normal^T: xx, yy, zz
in vec3 a_mixed;             // xy, xz, yz

uniform mat4 u_lattice_from_world;   // mm, from u_middle, to texels at plane 0 and slabs
uniform vec3 u_towards;              // unit vector towards the lamp
uniform bool u_closed;               // the mesh is closed: what turns away from the lamp hides behind what faces it
uniform vec2 u_lattice_size;         // texels
uniform float u_slabs;
uniform int u_columns;               // layers in a row of the picture
uniform vec2 u_picture;              // its texels
uniform float u_texel_area;          // mm^2
uniform ivec2 u_shear;               // columns' shift per plane, 1/32768 texel (sweep)
uniform int u_rear;                  // 1: light enters a slab at its back

flat out vec2 v_center;
flat out float v_share;

void main() {
    vec3 at = (u_lattice_from_world * vec4(a_p, 1.0)).xyz;
    float slab = floor(at.z);
    ivec2 moved = u_shear * (int(slab) + u_rear);
    // Columns move on within the slab too.
    at.xy += vec2(moved & 32767) / 32768.0 + vec2(u_shear) / 32768.0 * (at.z - slab - float(u_rear));
    vec3 l = u_towards;
    float squared = dot(a_diagonal, l * l) + 2.0 * (a_mixed.x * l.x * l.y + a_mixed.y * l.x * l.z + a_mixed.z * l.y * l.z);
    float both = sqrt(max(squared, 0.0) * (a_diagonal.x + a_diagonal.y + a_diagonal.z));
    float area = u_closed ? 0.5 * (both + dot(a_facing, l)) : both;
    v_share = max(area, 0.0) / u_texel_area;
    bool inside = slab >= 0.0 && slab < u_slabs && all(greaterThan(at.xy, vec2(1.0))) && all(lessThan(at.xy, u_lattice_size - 1.0));
    int layer = int(slab);
    v_center = at.xy + vec2(layer % u_columns, layer / u_columns) * u_lattice_size;
    gl_Position = inside && v_share > 0.0 ? vec4(v_center / u_picture * 2.0 - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
