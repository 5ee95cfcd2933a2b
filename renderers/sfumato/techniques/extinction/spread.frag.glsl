// Light of a layer of cells, carried on from open cells to those beside them that are filled with matter.
//
// A surface's light is what reaches it, not what is left of it within: cells count by how open they are. Without this,
// the cells that a surface runs through show as steps. Eight interpolated look-ups stand for 27 cells, by 8, 4, 2 and 1.
//
// COLORS     1: one channel, 3: red, green and blue
// LAST       1: what is drawn is light; 0: light times openness, and openness, for a next pass
uniform sampler3D u_light;           // light times openness, and openness
uniform sampler3D u_near;            // how open cells are; 0 where light does not matter
flat in int v_layer;

layout(location = 0) out vec4 o_light;

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), v_layer);
    float open = texelFetch(u_near, cell, 0).r;
    vec3 size = vec3(textureSize(u_light, 0)), middle = (vec3(cell) + 0.5) / size, aside = 0.5 / size;
    // No neighbours where light does not matter: software renderers leave a loop early, but not a branch.
    float last = open > 0.0 ? 1.0 : -2.0;
    vec4 sum = vec4(0.0);
    for (float z = -1.0; z <= last; z += 2.0) {
        for (int k = 0; k < 4; ++k) {
            vec3 side = vec3(float(2 * (k & 1) - 1), float((k & 2) - 1), z);
            sum += textureLod(u_light, middle + side * aside, 0.0);
        }
    }
#if COLORS == 1
    vec3 light = vec3(sum.r / max(sum.g, 1e-6));
#else
    vec3 light = sum.rgb / max(sum.a, 1e-6);
#endif
    if (open == 0.0) light = vec3(1.0);
#if LAST
    o_light = vec4(light, 1.0);
#elif COLORS == 1
    o_light = vec4(light.r * open, open, 0.0, 0.0);
#else
    o_light = vec4(light * open, open);
#endif
}
