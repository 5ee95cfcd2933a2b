// A surfel's share of the four texels around it.

flat in vec2 v_center;
flat in float v_share;

layout(location = 0) out float o_cover;

void main() {
    vec2 near = max(1.0 - abs(gl_FragCoord.xy - v_center), 0.0);
    o_cover = v_share * near.x * near.y;
}
