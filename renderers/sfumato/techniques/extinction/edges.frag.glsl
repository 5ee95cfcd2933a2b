// How much surface of dense matter there is in each cell of a layer, in faces of a cell.
uniform sampler3D u_source;          // b: share that is dense
flat in int v_layer;

layout(location = 0) out vec4 o_matter;

float share_at(ivec3 at) { return texelFetch(u_source, clamp(at, ivec3(0), textureSize(u_source, 0) - 1), 0).b; }

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), v_layer);
    vec4 matter = texelFetch(u_source, cell, 0);
    vec3 change;
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 next = ivec3(axis == 0, axis == 1, axis == 2);
        // Half to either side, so that a wall of a single cell has two faces.
        change[axis] = 0.5 * (abs(share_at(cell + next) - matter.b) + abs(matter.b - share_at(cell - next)));
    }
    o_matter = vec4(matter.rgb, length(change));
}
