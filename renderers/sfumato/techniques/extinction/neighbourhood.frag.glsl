// Ambient light that reaches a layer of cells, by a look at each cell around (Schlegel2011, Eq. 4): what the shells stand for.
//
// RADIUS     of the ball of cells that is looked at
// WEIGHED    1: light times openness, and openness, to be carried on; 0: light
flat in int v_layer;
uniform sampler3D u_source;          // rgb: what dims light of each colour, optical depth per cell
uniform sampler3D u_near;            // how open cells are; 0 where light does not matter
uniform float u_edge_mm;             // of a cell
uniform float u_strength;

layout(location = 0) out vec4 o_light;

const float PI = 3.14159265;

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), v_layer), last = textureSize(u_source, 0) - 1;
    float open = texelFetch(u_near, cell, 0).r;
    o_light = vec4(1.0);
#if WEIGHED
    o_light *= open;
#endif
    if (open == 0.0) return;
    vec3 depth = vec3(0.0);
    for (int z = max(-RADIUS, -cell.z); z <= min(RADIUS, last.z - cell.z); ++z) {
        for (int y = max(-RADIUS, -cell.y); y <= min(RADIUS, last.y - cell.y); ++y) {
            int left = RADIUS * RADIUS - z * z - y * y;
            if (left < 0) continue;
            int reach = int(sqrt(float(left)));
            for (int x = max(-reach, -cell.x); x <= min(reach, last.x - cell.x); ++x) {
                float square = float(x * x + y * y + z * z);
                // The cell itself takes no part. Extinction is the depth over the edge, a cell's volume the edge cubed.
                if (square > 0.0) depth += texelFetch(u_source, cell + ivec3(x, y, z), 0).rgb / square;
            }
        }
    }
    o_light *= vec4(exp(-u_strength / (4.0 * PI) * depth), 1.0);
}
