// Light of a layer of cells, carried on from open cells to those beside them that are filled with matter.
//
// A surface's light is what reaches it, not what is left of it within: cells count by how open they are. Without this,
// the cells that a surface runs through show as steps.
uniform sampler3D u_light;
uniform sampler3D u_matter;          // optical depth per cell: thin, dense
uniform sampler3D u_near;            // where light matters
uniform int u_layer;

layout(location = 0) out vec4 o_light;

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), u_layer), last = textureSize(u_light, 0) - 1;
    o_light = vec4(1.0);
    if (texelFetch(u_near, cell, 0).r == 0.0) return;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 27; ++i) {
        ivec3 offset = ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
        ivec3 at = clamp(cell + offset, ivec3(0), last);
        vec2 matter = texelFetch(u_matter, at, 0).rg;
        float open = exp(-2.0 * (matter.r + matter.g)) + 1e-4;
        open *= offset == ivec3(0) ? 4.0 : 1.0;
        sum += texelFetch(u_light, at, 0) * open;
        weights += open;
    }
    o_light = sum / weights;
}
